#include "sim/collision/manifold.h"

#include <algorithm>
#include <cmath>

namespace tumble {
namespace {

// Two candidates nearly as good as each other must not swap places from step to step: a later one must be better
// by this factor.
constexpr double clearly = 1.02;

// What spans the area may lie over what touches: the upper corners of a thin plate over its lower ones. Then the lower one
// counts: nearer along the normal by more than twice what it is aside.
constexpr double steep = 0.5;

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
        const Vec3 way = candidates[i].position - p0;
        const double d = way.squaredNorm() - std::pow(manifold.normal.dot(way), 2);
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
    // All on one side of the line, as where it runs along the edge of a long face: then what is farthest outside the
    // triangle's other two sides.
    if (found[0] != found[1]) {
        const int there = found[0] ? 0 : 1;
        const double sign = found[0] ? 1.0 : -1.0;
        const std::size_t third = chosen[2 + std::size_t(there)];
        const Vec3 p1 = candidates[chosen[1]].position, p2 = candidates[third].position;
        double outside = 1e-6 * size * size;
        for (std::size_t i = 0; i < candidates.size(); ++i) {
            const Vec3& p = candidates[i].position;
            const double area = std::max(-sign * manifold.normal.dot((p2 - p1).cross(p - p1)), -sign * manifold.normal.dot((p0 - p2).cross(p - p2)));
            if (area > clearly * outside) {
                outside = area;
                chosen[2 + std::size_t(1 - there)] = i;
                found[1 - there] = true;
            }
        }
    }
    for (std::size_t i = 0; i < 4; ++i) {
        if (i >= 2 && !found[i - 2]) continue;
        for (std::size_t k = 0; k < candidates.size(); ++k) {
            if (std::find(chosen.begin(), chosen.end(), k) != chosen.end()) continue;
            const ContactPoint &upper = candidates[chosen[i]], &lower = candidates[k];
            const double nearer = upper.separation - lower.separation;
            if (nearer < 1e-6 * size) continue;
            const Vec3 way = lower.position - upper.position;
            if ((way - manifold.normal.dot(way) * manifold.normal).norm() < steep * nearer) chosen[i] = k;
        }
    }
    manifold.count = 0;
    for (std::size_t i = 0; i < 4; ++i)
        if (i < 2 || found[i - 2]) manifold.points[std::size_t(manifold.count++)] = candidates[chosen[i]];
}

}  // namespace tumble
