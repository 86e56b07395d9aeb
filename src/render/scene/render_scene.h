// Render proxies of the bodies, computed once for a scene.
#pragma once

#include "core/vector.h"
#include "render/camera/camera.h"
#include "render/lightmap/chart_unwrap.h"
#include "render/lightmap/occlusion_lightmap.h"
#include "scene/description/description.h"
#include "sim/snapshot/snapshot.h"

#include <glm/vec3.hpp>

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

namespace tumble {

enum class DrawKind { hidden, plane, box, ball, mesh };

struct RenderBody {
    DrawKind kind = DrawKind::hidden;
    std::size_t mesh = 0;              // index into RenderScene::meshes
    Vec3 half_size = Vec3::Ones();     // scale of the unit box or ball, m; 1 for meshes
    Vec3 bound_center = Vec3::Zero();  // of the bounding ball, body frame from its origin, m
    double bound_radius = 0.0;         // m
    double ao_radius = 0.0;            // AO radius, for occluding and being occluded, m
    double bevel = 0.0;                // m
    double pattern_cell = 1.0;         // m; a plane's follows the reference distance instead
    PlaneShape plane;                  // planes only
    glm::vec3 color{1.0f};             // linear light
    float roughness = 0.6f, metallic = 0.0f;
    Pattern pattern = Pattern::plain;
    bool large_receiver = false;     // a large receiver, see large_receivers.h
    bool fixed = false;              // never moves
    bool without_occlusion = false;  // without AO: too large for its number of texels, which would give wrong values
    std::ptrdiff_t lightmap = -1;    // index into RenderScene::lightmaps; -1: none. A mesh with a lightmap has charts
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

struct RenderMesh {
    std::shared_ptr<const MeshAsset> asset;
    bool closed = true;  // and facing outward; otherwise both sides are visible
    Vec3 bound_center = Vec3::Zero(), half_extent = Vec3::Zero();  // m
    std::vector<OccluderBox> occluders;
    std::vector<VertexSample> vertex_samples;
    std::vector<std::uint32_t> sample_of_vertex;
    std::vector<VertexSample> coarse_samples;  // for meshes that are small on the screen
    std::vector<std::uint32_t> coarse_of_sample;
    std::optional<ChartedMesh> charts;  // drawn with these and shaded with its lightmap
};

struct RenderScene {
    LightDescription light;
    bool sun_up = true;              // false disables sunlight, see sun_is_up()
    std::vector<RenderBody> bodies;  // in scene order
    std::vector<RenderMesh> meshes;  // without repetition, in order of first use
    std::vector<OcclusionLightmap> lightmaps;
    std::vector<CordDescription> cords;
    std::vector<std::size_t> planes;  // indices of the planes
    double typical_ao_radius = 1.0;   // m, median AO radius of the bodies without large receivers
    std::size_t mesh_triangles = 0;   // of all bodies together
    double plane_cell = 0.25;         // m, texel size of plane tiles; a power of two
};

/// From this number of bodies on, small ones are culled per pixel and get coarse AO; with fewer bodies this saves
/// little.
inline constexpr std::size_t large_scene = 2000;

/// Shapes, bounds, colors, large receivers and the typical ao_radius: all but the data of ambient occlusion, which
/// make_render_scene() of render_scene_builder.h adds.
RenderScene describe_bodies(const SceneDescription& description);

/// False if the sun is below a fixed plane that bodies can rest on. Planes cast no shadows: a plane is the surface of a
/// half-space, which would block either all sunlight or none.
bool sun_is_up(const SceneDescription& description);

/// Bounding ball of a body, m, relative to the eye.
struct BoundingBall {
    Vec3 center;
    double radius;
};
BoundingBall bounding_ball(const RenderBody& proxy, const BodyState& state, const Camera& view);

/// A pattern as the index that shaders use.
float pattern_number(Pattern pattern);

}  // namespace tumble
