#include "render/scene/plane_patch.h"

#include "render/gl/glm_conversion.h"
#include "render/shapes/drawing_style.h"

#include <algorithm>
#include <cmath>
#include <optional>

namespace tumble {
namespace {

// Coordinates along the axes are kept small by subtracting whole periods of the pattern, in cells. Noise has none: it
// is other noise from half of this distance on.
constexpr double checker_period = 2.0, noise_period = 65536.0;

using Polygon = std::vector<Eigen::Vector2d>;  // clip space x and y

Polygon whole_screen() { return {{-1.0, -1.0}, {1.0, -1.0}, {1.0, 1.0}, {-1.0, 1.0}}; }

// Slope towards a plane of the ray through a point of clip space: linear in the point.
double fall_at(const Vec3& normal, const Eigen::Vector2d& at, const Camera& view) {
    return -normal.dot(view.ray(0.5 * (at.x() + 1.0) * view.width(), 0.5 * (at.y() + 1.0) * view.height()));
}

// The part of a convex polygon where a linear function is positive (Sutherland and Hodgman 1974).
template <class Function>
Polygon clipped(const Polygon& polygon, Function function) {
    Polygon result;
    for (std::size_t i = 0; i < polygon.size(); ++i) {
        const Eigen::Vector2d &a = polygon[i], &b = polygon[(i + 1) % polygon.size()];
        const double at_a = function(a), at_b = function(b);
        if (at_a > 0.0) result.push_back(a);
        if ((at_a > 0.0) != (at_b > 0.0)) result.push_back(a + (b - a) * (at_a / (at_a - at_b)));
    }
    return result;
}

glm::vec4 axis(const Vec3& direction, const Vec3& eye_from_origin, double cell, double period) {
    const double cells = direction.dot(eye_from_origin) / cell;
    const double periods = period == noise_period ? std::round(cells / period) : std::floor(cells / period);
    return to_glm(direction / cell, cells - period * periods);
}

}  // namespace

PlaneShape plane_in_world(const RenderBody& proxy, const BodyState& state) {
    const Vec3 normal = state.orientation * proxy.plane.normal;
    return {normal, proxy.plane.offset + normal.dot(state.origin)};
}

double pattern_cell(double viewing_distance) {
    const double target = viewing_distance / style::ground_cells;
    double power = 1.0;
    while (power > target) power /= 10.0;
    while (power * 10.0 <= target) power *= 10.0;
    const double digits = target / power;  // 1 .. 10; the borders are the geometric means of 1, 2, 5, 10
    return power * (digits < std::sqrt(2.0)    ? 1.0
                    : digits < std::sqrt(10.0) ? 2.0
                    : digits < std::sqrt(50.0) ? 5.0
                                               : 10.0);
}

namespace {

std::optional<PlanePatch> make_plane_patch(const RenderBody& proxy, const BodyState& state, std::size_t body,
                                           const Camera& view, double near_distance, double cell, double period) {
    const PlaneShape plane = plane_in_world(proxy, state);
    PlanePatch patch;
    patch.normal = plane.normal;
    patch.height = plane.normal.dot(view.eye()) - plane.offset;
    patch.body = body;
    if (!(patch.height > 0.0)) return std::nullopt;

    // fall = -n . ray is positive where the plane is visible; z = 1 - 2 near / depth, and 1 / depth = fall / height.
    const auto fall = [&](const Eigen::Vector2d& at) { return fall_at(patch.normal, at, view); };
    for (const Eigen::Vector2d& corner : clipped(whole_screen(), fall))
        patch.corners.emplace_back(float(corner.x()), float(corner.y()),
                                   float(1.0 - 2.0 * near_distance * std::max(fall(corner), 0.0) / patch.height));
    if (patch.corners.size() < 3) return std::nullopt;

    // The pattern's axes are the body's, so that it moves with the body.
    const PlaneAxes axes = plane_axes(proxy.plane.normal);
    const Vec3 from_origin = view.eye() - state.origin;
    patch.u = axis(state.orientation * axes.u, from_origin, cell, period);
    patch.v = axis(state.orientation * axes.v, from_origin, cell, period);
    return patch;
}

}  // namespace

std::vector<PlanePatch> make_plane_patches(const RenderScene& scene, const Snapshot& snapshot, const Camera& view,
                                           double near_distance) {
    const double cell = pattern_cell(view.viewing_distance());
    std::vector<PlanePatch> patches;
    for (std::size_t i = 0; i < scene.bodies.size(); ++i) {
        const RenderBody& proxy = scene.bodies[i];
        if (proxy.kind != DrawKind::plane) continue;
        const Pattern pattern = scene.looks[proxy.look].pattern;
        const bool noise = pattern == Pattern::noise || pattern == Pattern::wood || pattern == Pattern::marble;
        if (auto patch = make_plane_patch(proxy, snapshot.bodies[i], i, view, near_distance,
                                          proxy.pattern_cell > 0.0 ? proxy.pattern_cell : cell,
                                          noise ? noise_period : checker_period))
            patches.push_back(std::move(*patch));
    }
    return patches;
}

std::vector<glm::vec3> sky_polygon(const std::vector<PlanePatch>& planes, const Camera& view) {
    Polygon polygon = whole_screen();
    for (const PlanePatch& plane : planes) {
        const double overlap = 2.0 * view.pixel_size();  // largest change of the slope over two pixels
        polygon =
            clipped(polygon, [&](const Eigen::Vector2d& at) { return overlap - fall_at(plane.normal, at, view); });
    }
    std::vector<glm::vec3> corners;
    for (const Eigen::Vector2d& corner : polygon) corners.emplace_back(float(corner.x()), float(corner.y()), 1.0f);
    return corners;
}

bool hidden_behind(const std::vector<PlaneShape>& planes, const Vec3& eye, const RenderBody& proxy, const Vec3& center,
                   const Quat& rotation) {
    return std::any_of(planes.begin(), planes.end(), [&](const PlaneShape& plane) {
        const Vec3 normal = rotation.conjugate() * plane.normal;
        const double reach = std::min(normal.cwiseAbs().dot(proxy.half_extent), proxy.bound_radius);
        constexpr double rounding = 1e-6;  // of the size: a face may lie in the plane
        return plane.normal.dot(eye) > plane.offset &&
               plane.normal.dot(center) + reach <= plane.offset + rounding * proxy.bound_radius;
    });
}

}  // namespace tumble
