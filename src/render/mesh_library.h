// All meshes of a scene on the graphics side, by the numbers of draw_list.h.
#pragma once

#include "render/mesh_buffer.h"

#include <span>
#include <vector>

namespace tumble {

class MeshLibrary {
public:
    MeshLibrary(const GlFunctions& gl, const SceneLooks& looks);

    const MeshBuffer& operator[](std::size_t mesh) const { return meshes_[mesh]; }

    /// Sends the frame's instances; the batches drawn next refer to them.
    void upload(std::span<const Instance> instances);

    /// Draws a batch; back faces of closed meshes are left out.
    void draw(const Batch& batch) const;

private:
    const GlFunctions* gl_;
    std::vector<MeshBuffer> meshes_;
    GlObject instances_;
};

}  // namespace tumble
