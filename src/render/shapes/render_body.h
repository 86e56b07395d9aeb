// Render proxies of bodies and meshes.
#pragma once

#include "core/vector.h"
#include "render/lightmap/chart_unwrap.h"
#include "scene/description/description.h"

#include <glm/vec3.hpp>
#include <glm/vec4.hpp>

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

namespace tumble {

/// The ways of drawing: planes, boxes and balls have shaders of their own, all other shapes are drawn as meshes.
enum class DrawKind { hidden, plane, box, ball, mesh };

struct RenderBody {
    DrawKind kind = DrawKind::hidden;
    std::size_t mesh = 0;              // index into RenderScene::meshes
    Vec3 half_size = Vec3::Ones();     // scale of the unit box or ball, m; 1 for meshes
    Vec3 half_extent = Vec3::Ones();   // m, of the bounding box about bound_center
    Vec3 bound_center = Vec3::Zero();  // of the bounding ball, body frame from its origin, m
    double bound_radius = 0.0;         // m
    double ao_radius = 0.0;            // AO radius, for occluding and being occluded, m
    double bevel = 0.0;                // m
    double pattern_cell = 0.0;         // m; 0 of a plane: it follows the reference distance
    PlaneShape plane;                  // planes only
    glm::vec3 color{1.0f};             // linear light
    float roughness = 0.6f, metallic = 0.0f;
    float reflection = 0.0f;                 // of the plane that mirrors bodies
    Pattern pattern = Pattern::panel;        // or a grid or a checker that darkens; others are looks
    std::size_t look = 0;                    // index into RenderScene::looks
    glm::vec4 paint{0.0f};                   // Instance::paint
    glm::vec4 glow{0.0f, 0.0f, 0.0f, 1.0f};  // Instance::glow
    bool large_receiver = false;             // a large receiver, see large_receivers.h
    static constexpr std::size_t no_whole = SIZE_MAX;
    std::size_t whole = no_whole;    // the body that it is a piece of
    bool fixed = false;              // never moves
    bool buried = false;             // and a fixed plane hides it: nothing is fitted to it
    bool without_occlusion = false;  // without AO: too large for its number of texels, which would give wrong values
    std::ptrdiff_t lightmap = -1;    // index into RenderScene::lightmaps; -1: none. A mesh with a lightmap has charts

    /// False for planes, which have no bounds and no inside, and for bodies that are not drawn.
    bool solid() const { return kind != DrawKind::hidden && kind != DrawKind::plane; }
    bool translucent() const { return glow.w < 1.0f; }
    bool glows() const { return glow.x > 0.0f || glow.y > 0.0f || glow.z > 0.0f; }
};

/// A box inside a mesh, which stands for it as an occluder; body frame.
struct OccluderBox {
    Vec3 center;     // m
    Vec3 half_size;  // m
};

/// A point of a mesh at which its sky visibility is computed; body frame.
struct VertexSample {
    Vec3 position;  // m
    Vec3 normal;    // unit
};

/// A pattern of two colors, a plain surface, or an image: surfaces with shaders of their own.
struct SurfaceLook {
    Pattern pattern = Pattern::panel;
    MeshMaterial image = {};  // without a texture and maps: a pattern

    bool has_image() const { return image.texture || image.maps.bits() != 0; }
};

struct RenderMesh {
    std::shared_ptr<const MeshAsset> asset;
    const MeshPaint* paint = nullptr;  // of the asset: the colors of its file; null: the color of the body
    std::shared_ptr<const MeshPaint> own_paint = nullptr;  // paint of a shape with a texture, whose asset has none
    bool closed = true;                                    // and facing outward; otherwise both sides are visible
    Vec3 bound_center = Vec3::Zero(), half_extent = Vec3::Zero();  // m
    std::vector<OccluderBox> occluders;
    std::vector<VertexSample> vertex_samples;
    std::vector<std::uint32_t> sample_of_vertex;
    std::vector<VertexSample> coarse_samples;  // for meshes that are small on the screen
    std::vector<std::uint32_t> coarse_of_sample;
    std::optional<ChartedMesh> charts;  // drawn with these and shaded with its lightmap
};

}  // namespace tumble
