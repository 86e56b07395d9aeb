// A mesh in GPU memory, drawn with many instances at once.
#pragma once

#include "render/gl/gl_object.h"
#include "render/mesh/texture_cache.h"
#include "scene/description/description.h"
#include "scene/description/painted_mesh.h"

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>

#include <array>
#include <cstdint>
#include <span>
#include <vector>

namespace tumble {

/// One drawn body (or one face of a box); eight vec4 attributes, as in shaders/instance.glsl.
struct Instance {
    glm::vec3 position;     // of the body's origin, m, relative to the eye
    float bevel;            // m
    glm::vec4 orientation;  // x, y, z, w
    glm::vec3 scale;        // of the mesh
    float pattern_cell;     // m
    glm::vec3 color;        // linear
    float roughness;
    float metallic, pattern;  // pattern: see pattern_number()
    glm::vec2 atlas_place;    // in the AO atlas, texels
    float tile_size;          // edge of its AO tiles, texels; 0: none
    float face;               // of a box, as in BodyOcclusion; 1 for an open mesh
    float surface_id;         // as alpha
    float near_shadows;       // 1: uses the near shadow map, 0: the far one
    // Second color of a pattern, linear; of a texture images around and along a ball; w: m that an image covers, or 0.
    glm::vec4 paint;
    glm::vec4 glow{0.0f, 0.0f, 0.0f, 1.0f};  // emission, linear; w: opacity
};
static_assert(sizeof(Instance) == 8 * sizeof(glm::vec4));

/// Consecutive indices that are drawn with a texture.
struct TextureRange {
    TextureNames textures;
    bool translucent;
    std::size_t first, count;
};

/// Part of a mesh's triangles, by their material.
enum class MeshPart : std::uint8_t { whole, opaque, translucent };

struct MeshData {
    std::span<const MeshAsset::Vertex> vertices;
    std::span<const std::uint32_t> indices;
    std::span<const std::uint32_t> sample_of_vertex;  // may be empty: only meshes of the scene have samples
    std::span<const std::array<float, 2>> texels;     // may be empty: only meshes with charts have texels
    bool closed = true;
    std::span<const VertexPaint> paint = {};  // may be empty: only meshes with the colors of their file have it
    std::vector<TextureRange> ranges = {};    // of the indices; empty: all, without a texture
};

class MeshBuffer {
public:
    MeshBuffer(const GlFunctions& gl, const MeshData& data);

    /// Back faces of a closed mesh are not visible.
    bool closed() const { return closed_; }

    /// Draws `count` instances from the buffer `instances`, starting at index `first`.
    void draw(GLuint instances, std::size_t first, std::size_t count, MeshPart part = MeshPart::whole) const;

private:
    const GlFunctions* gl_;
    GlObject array_, vertices_, indices_, samples_, texels_, paint_;
    std::vector<TextureRange> ranges_;
    mutable GLuint instances_ = 0;  // the buffer that the vertex array refers to
    bool closed_;
};

}  // namespace tumble
