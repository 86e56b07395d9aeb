// What drawing needs to know of each body, worked out once for a scene.
#pragma once

#include "core/vector.h"
#include "render/camera/camera.h"
#include "render/lightmap/occlusion_lightmap.h"
#include "render/lightmap/chart_unwrap.h"
#include "scene/description/description.h"
#include "sim/snapshot/snapshot.h"

#include <glm/vec3.hpp>

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

namespace tumble {

enum class DrawKind { hidden, plane, box, ball, mesh };

struct RenderBody {
    DrawKind kind = DrawKind::hidden;
    std::size_t mesh = 0;              // index into RenderScene::meshes
    Vec3 half_size = Vec3::Ones();     // scale of the unit box or ball, m; 1 for meshes
    Vec3 bound_center = Vec3::Zero();  // of a ball around the body, body frame from its origin, m
    double bound_radius = 0.0;         // m
    double reach = 0.0;                // how far it darkens its neighbors, and they it, m
    double bevel = 0.0;                // m
    double pattern_cell = 1.0;         // m; a plane's follows the view instead
    PlaneShape plane;                  // planes only
    glm::vec3 color{1.0f};             // linear
    float roughness = 0.6f, metallic = 0.0f;
    Pattern pattern = Pattern::plain;
    bool ground = false;               // see grounds.h
    bool fixed = false;                // never moves
    bool undarkened = false;           // too large for the values that it has room for: better none than wrong ones
    std::ptrdiff_t fine_surface = -1;  // of RenderScene::fine_surfaces; -1: none. A mesh that has one has charts
};

/// A box inside a mesh that stands for it where neighbors are darkened; body frame.
struct OccluderBox {
    Vec3 center;     // m
    Vec3 half_size;  // m
};

/// A place on a mesh where its own sky light is worked out; body frame.
struct VertexSample {
    Vec3 position;  // m
    Vec3 normal;    // unit
};

struct RenderMesh {
    const MeshAsset* asset = nullptr;
    bool closed = true;   // and facing outward: else both of its sides are seen
    Vec3 bound_center = Vec3::Zero(), half_extent = Vec3::Zero();  // m
    std::vector<OccluderBox> occluders;
    std::vector<VertexSample> probes;
    std::vector<std::uint32_t> probe_of_vertex;
    std::vector<VertexSample> coarse_probes;          // for meshes that are small in the picture
    std::vector<std::uint32_t> coarse_of_probe;
    std::optional<ChartedMesh> charts;              // drawn by these, and darkened as its fine surface says
};

struct RenderScene {
    std::vector<RenderBody> bodies;  // in scene order
    std::vector<RenderMesh> meshes;  // each once, in order of first use
    std::vector<OcclusionLightmap> fine_surfaces;
    std::vector<std::size_t> planes;   // which bodies are planes
    double typical_reach = 1.0;    // m, the median of the bodies', without grounds
    std::size_t mesh_triangles = 0;    // of all bodies together
    double window_cell = 0.25;     // m, of the texels that planes are darkened by; a power of two
};

/// From so many bodies on, small ones are looked at pixel by pixel and darkened coarsely; with fewer it would gain little.
inline constexpr std::size_t crowd = 2000;

/// Shapes, bounds, colors, large receivers and the typical reach: all but the data of ambient occlusion, which
/// make_render_scene() of render_scene_builder.h adds.
RenderScene describe_bodies(const SceneDescription& scene);

/// The ball around a body, relative to the eye.
struct BoundingBall {
    Vec3 center;
    double radius;
};
BoundingBall bounding_ball(const RenderBody& look, const BodyState& state, const Camera& view);

/// A pattern as the shaders count them.
float pattern_number(Pattern pattern);

}  // namespace tumble
