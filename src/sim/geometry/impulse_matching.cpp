#include "sim/geometry/impulse_matching.h"

#include <algorithm>

namespace tumble {
namespace {

constexpr double same_side = 0.9;  // cosine of the angle between the normals of two steps: 26 degrees

// The load must not be lost where the points have changed: remaining impulses go to the nearest points.
void hand_over(const Manifold& old, const bool (&taken)[Manifold::capacity], Manifold& m) {
    if (old.normal.dot(m.normal) < same_side) return;
    for (int k = 0; k < old.count; ++k) {
        const ContactPoint& before = old.points[std::size_t(k)];
        if (taken[k] || before.impulse == 0.0) continue;
        const auto distance = [&](const ContactPoint& p) { return (p.position - before.position).squaredNorm(); };
        const auto nearest =
            std::min_element(m.points.begin(), m.points.begin() + m.count,
                             [&](const ContactPoint& l, const ContactPoint& r) { return distance(l) < distance(r); });
        nearest->impulse += before.impulse;
    }
}

}  // namespace

void carry_over(const Manifold& old, double reach, Manifold& m) {
    m.tangent = old.tangent;
    std::copy_n(old.friction, 2, m.friction);
    m.twist = old.twist;
    m.solved_directly = old.solved_directly;
    bool taken[Manifold::capacity] = {}, found[Manifold::capacity] = {};
    for (int i = 0; i < m.count; ++i) {
        ContactPoint& point = m.points[std::size_t(i)];
        for (int k = 0; k < old.count; ++k) {
            const ContactPoint& before = old.points[std::size_t(k)];
            if (taken[k] || before.feature != point.feature) continue;
            point.impulse = before.impulse;
            taken[k] = found[i] = true;
            break;
        }
    }
    for (int i = 0; i < m.count; ++i) {
        if (found[i]) continue;
        ContactPoint& point = m.points[std::size_t(i)];
        double nearest = reach * reach;
        int best = -1;
        for (int k = 0; k < old.count; ++k) {
            const double square = (old.points[std::size_t(k)].position - point.position).squaredNorm();
            if (taken[k] || square >= nearest) continue;
            nearest = square;
            best = k;
        }
        if (best < 0) continue;
        point.impulse = old.points[std::size_t(best)].impulse;
        taken[best] = true;
    }
    hand_over(old, taken, m);
}

void hand_over(const Manifold& old, Manifold& m) { hand_over(old, {}, m); }

}  // namespace tumble
