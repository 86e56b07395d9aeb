// A mesh on the graphics side, drawn many times at once with one Instance each.
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
    std::span<const std::uint32_t> probe_of_vertex;  // may be empty: only the scene's own meshes have probes
    std::span<const std::array<float, 2>> texels;    // likewise: those with charts
    bool closed = true;
};

class MeshBuffer {
public:
    MeshBuffer(const GlFunctions& gl, const MeshData& data);

    /// A closed mesh hides its back faces.
    bool closed() const { return closed_; }

    /// Draws `count` instances from the buffer `instances`, beginning with number `first`.
    void draw(GLuint instances, std::size_t first, std::size_t count) const;

private:
    const GlFunctions* gl_;
    GlObject array_, vertices_, indices_, probes_, texels_;
    GLsizei index_count_;
    mutable GLuint instances_ = 0;   // the buffer that the array points to
    bool closed_;
};

}  // namespace tumble
