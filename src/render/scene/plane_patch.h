// The visible part of an infinite plane. In pixels, n . ray(x, y) is linear in x and y, and the plane is visible where
// it is negative (from its open side): the rectangle of the screen cut by one line, the horizon. The reciprocal of the
// depth is linear as well, so a flat polygon in clip space carries the exact depth out to infinity.
#pragma once

#include "core/vector.h"
#include "render/camera/camera.h"
#include "render/scene/render_scene.h"
#include "scene/description/looks.h"
#include "sim/snapshot/snapshot.h"

#include <glm/vec3.hpp>
#include <glm/vec4.hpp>

#include <vector>

namespace tumble {

struct PlanePatch {
    std::vector<glm::vec3> corners;  // clip space (w = 1), a convex polygon
    Vec3 normal;                     // unit, world axes
    double height;                   // of the eye above the plane, m, > 0
    glm::vec4 u, v;                  // axes in the plane over the cell size; w: the eye's coordinates, in cells
    std::size_t body;
};

/// The planes that are visible from their open side; from behind, a plane is transparent.
std::vector<PlanePatch> make_plane_patches(const RenderScene& scene, const Snapshot& snapshot, const Camera& view,
                                           double near_distance);

/// The part of the screen without planes (enlarged by two pixels across each horizon), in clip space.
std::vector<glm::vec3> sky_polygon(const std::vector<PlanePatch>& planes, const Camera& view);

/// A round length (1, 2 or 5 times a power of ten) near a fifteenth of the reference distance: 1 m at 15 m.
double pattern_cell(double viewing_distance);

/// The plane in the world: unit normal and offset (points p with normal . p = offset).
PlaneShape plane_in_world(const RenderBody& proxy, const BodyState& state);

/// True if one of the planes (world frame) is seen from its open side and hides all of a body, whose bounds have this
/// center: it is not seen, and casts no visible shadow.
bool hidden_behind(const std::vector<PlaneShape>& planes, const Vec3& eye, const RenderBody& proxy, const Vec3& center,
                   const Quat& rotation);

}  // namespace tumble
