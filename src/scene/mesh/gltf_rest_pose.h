// Meshes of glTF that joints and morph targets deform, as the file has them without an animation.
#pragma once

#include "scene/mesh/gltf_buffers.h"
#include "scene/mesh/gltf_json.h"
#include "scene/mesh/mesh_transform.h"

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

namespace tumble {

/// A node's own transform, in single precision like glTF's numbers.
Eigen::Matrix4f local_transform(const Json& node);

class GltfRestPose {
public:
    using Vectors = std::vector<std::array<float, 3>>;

    /// The document and its buffers must outlive it.
    GltfRestPose(const Json& document, GltfBuffers& buffers) : document_(document), buffers_(buffers) {}

    /// Adds the morph targets of a primitive, by the weights of the node or of its mesh.
    void add_targets(const Json& node, const Json& primitive, Vectors& positions, Vectors& normals);

    /// Moves the vertices by the joints of the node's skin, into the frame of the scene: the node's own transform does
    /// not count then (glTF 2.0, 3.7.3.3). False, without a change, for a node without a skin.
    bool skin(const Json& node, const Json& primitive, Vectors& positions, Vectors& normals);

private:
    const std::vector<Eigen::Matrix4f>& joints_of(std::uint64_t skin);
    void find_worlds();

    const Json& document_;
    GltfBuffers& buffers_;
    std::map<std::uint64_t, std::vector<Eigen::Matrix4f>> joints_;  // by skin: of its vertices
    std::vector<Eigen::Matrix4f> worlds_;                           // of nodes, in the frame of the scene
};

}  // namespace tumble
