#include "sim/collision/manifold.h"

#include <algorithm>

namespace tumble {
namespace {

// Two candidates nearly as good as each other must not swap places from step to step: a later one must be better
// by this factor.
constexpr double clearly = 1.02;

}  // namespace

void keep_best_points(const std::vector<ContactPoint>& candidates, Manifold& manifold) {
    if (candidates.size() <= Manifold::capacity) {
        manifold.count = int(candidates.size());
        std::copy(candidates.begin(), candidates.end(), manifold.points.begin());
        return;
    }
    Bounds box;
    for (const ContactPoint& p : candidates) box.add(p.position);
    const double size = box.extent().norm();

    std::array<std::size_t, 4> chosen{};
    for (std::size_t i = 1; i < candidates.size(); ++i)
        if (candidates[i].separation < candidates[chosen[0]].separation - 1e-3 * size) chosen[0] = i;
    const Vec3 p0 = candidates[chosen[0]].position;

    double best = 0.0;
    for (std::size_t i = 0; i < candidates.size(); ++i) {
        const double d = (candidates[i].position - p0).squaredNorm();
        if (d > clearly * best) {
            best = d;
            chosen[1] = i;
        }
    }
    // Farthest to either side of the line p0 p1.
    const Vec3 along = candidates[chosen[1]].position - p0;
    double most[2] = {0.0, 0.0};
    bool found[2] = {false, false};
    for (std::size_t i = 0; i < candidates.size(); ++i) {
        const double area = manifold.normal.dot(along.cross(candidates[i].position - p0));
        const int side = area < 0.0;
        if (std::abs(area) > clearly * most[side] && std::abs(area) > 1e-6 * size * size) {
            most[side] = std::abs(area);
            chosen[2 + std::size_t(side)] = i;
            found[side] = true;
        }
    }
    manifold.count = 0;
    for (std::size_t i = 0; i < 4; ++i)
        if (i < 2 || found[i - 2]) manifold.points[std::size_t(manifold.count++)] = candidates[chosen[i]];
}

}  // namespace tumble
