#include "sim/collision/carry_over.h"

#include <algorithm>

namespace tumble {

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
}

}  // namespace tumble
