// Render proxies of the bodies, computed once for a scene.
#pragma once

#include "render/camera/camera.h"
#include "render/lightmap/occlusion_lightmap.h"
#include "render/shapes/render_body.h"
#include "sim/snapshot/snapshot.h"

#include <cstddef>
#include <optional>
#include <vector>

namespace tumble {

struct RenderScene {
    LightDescription light;
    std::vector<LampDescription> lamps;  // empty: the light alone
    std::optional<EnvironmentDescription> environment;
    std::optional<WaterDescription> water;
    WaterSurface surface;       // of the water
    std::optional<double> cut;  // m, y, below which bodies are not drawn
    double exposure = 0.0;      // stops
    ToneCurve tone = ToneCurve::filmic;
    int shadow_alpha = 0;                           // of ground shadows, see TRANSPARENT of shaders/plane.frag
    bool sun_up = true;                             // false disables sunlight, see sun_is_up()
    std::vector<RenderBody> bodies;                 // in scene order
    std::vector<RenderMesh> meshes;                 // without repetition, in order of first use
    std::vector<SurfaceLook> looks{SurfaceLook{}};  // the first: the look of the shape or of its mesh file
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

/// The plane that mirrors bodies: the first fixed one that is visible and reflects. Its index, or none.
std::optional<std::size_t> mirror_of(const SceneDescription& description);

/// Bounding ball of a body, m, relative to the eye.
struct BoundingBall {
    Vec3 center;
    double radius;
};
BoundingBall bounding_ball(const RenderBody& proxy, const BodyState& state, const Camera& view);

/// A pattern as the index that shaders use.
float pattern_number(Pattern pattern);

}  // namespace tumble
