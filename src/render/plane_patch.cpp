#include "render/plane_patch.h"

#include "render/glm_conversion.h"

#include <cmath>

namespace tumble {
namespace {

// The axes' coordinates are kept small by dropping whole periods of the pattern (2 cells for a checker).
constexpr double period = 2.0;   // cells

glm::vec4 axis(const Vec3& direction, const Vec3& eye_from_origin, double cell) {
    const double cells = direction.dot(eye_from_origin) / cell;
    return to_glm(direction / cell, cells - period * std::floor(cells / period));
}

}  // namespace

PlaneShape plane_in_world(const BodyLook& look, const BodyState& state) {
    const Vec3 normal = state.orientation * look.plane.normal;
    return {normal, look.plane.offset + normal.dot(state.origin)};
}

double pattern_cell(double viewing_distance) {
    const double wanted = viewing_distance / 15.0;
    double power = 1.0;
    while (power > wanted) power /= 10.0;
    while (power * 10.0 <= wanted) power *= 10.0;
    const double digits = wanted / power;   // 1 .. 10; the borders are the geometric means of 1, 2, 5, 10
    return power * (digits < std::sqrt(2.0) ? 1.0 : digits < std::sqrt(10.0) ? 2.0 : digits < std::sqrt(50.0) ? 5.0 : 10.0);
}

std::optional<PlanePatch> make_plane_patch(const BodyLook& look, const BodyState& state, std::size_t body,
                                           const CameraView& view, double near_distance, double cell) {
    const PlaneShape plane = plane_in_world(look, state);
    PlanePatch patch;
    patch.normal = plane.normal;
    patch.height = plane.normal.dot(view.eye()) - plane.offset;
    patch.body = body;
    if (!(patch.height > 0.0)) return std::nullopt;

    // The screen's corners in clip space with their fall = -n . ray; kept where positive.
    struct Corner { double x, y, fall; };
    const auto corner = [&](double x, double y) {
        return Corner{x, y, -plane.normal.dot(view.ray(0.5 * (x + 1.0) * view.width(), 0.5 * (y + 1.0) * view.height()))};
    };
    const Corner screen[4] = {corner(-1, -1), corner(1, -1), corner(1, 1), corner(-1, 1)};
    for (int i = 0; i < 4; ++i) {
        const Corner &a = screen[i], &b = screen[(i + 1) % 4];
        // z = 1 - 2 near / depth, and 1 / depth = fall / height
        const auto add = [&](const Corner& c) {
            patch.corners.emplace_back(float(c.x), float(c.y), float(1.0 - 2.0 * near_distance * c.fall / patch.height));
        };
        if (a.fall > 0.0) add(a);
        if ((a.fall > 0.0) != (b.fall > 0.0)) {
            const double t = a.fall / (a.fall - b.fall);
            add({a.x + t * (b.x - a.x), a.y + t * (b.y - a.y), 0.0});
        }
    }
    if (patch.corners.size() < 3) return std::nullopt;

    // The pattern's axes: the body's own, so that it turns and moves with the body.
    const Vec3& n = look.plane.normal;
    const Vec3 across = std::abs(n.x()) < 0.9 ? Vec3::UnitX() : Vec3::UnitY();
    const Vec3 u = (across - n * n.dot(across)).normalized(), v = n.cross(u);
    const Vec3 from_origin = view.relative(state.origin) * -1.0;
    patch.u = axis(state.orientation * u, from_origin, cell);
    patch.v = axis(state.orientation * v, from_origin, cell);
    return patch;
}

}  // namespace tumble
