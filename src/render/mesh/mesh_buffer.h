// A mesh in GPU memory, drawn with many instances at once.
#pragma once

#include "render/gl/gl_object.h"
#include "render/mesh/instance.h"
#include "scene/description/description.h"

#include <array>
#include <cstdint>
#include <span>

namespace tumble {

struct MeshData {
    std::span<const MeshAsset::Vertex> vertices;
    std::span<const std::uint32_t> indices;
    std::span<const std::uint32_t> sample_of_vertex;  // may be empty: only meshes of the scene have samples
    std::span<const std::array<float, 2>> texels;     // may be empty: only meshes with charts have texels
    bool closed = true;
};

class MeshBuffer {
public:
    MeshBuffer(const GlFunctions& gl, const MeshData& data);

    /// Back faces of a closed mesh are not visible.
    bool closed() const { return closed_; }

    /// Draws `count` instances from the buffer `instances`, starting at index `first`.
    void draw(GLuint instances, std::size_t first, std::size_t count) const;

private:
    const GlFunctions* gl_;
    GlObject array_, vertices_, indices_, samples_, texels_;
    GLsizei index_count_;
    mutable GLuint instances_ = 0;  // the buffer that the vertex array refers to
    bool closed_;
};

}  // namespace tumble
