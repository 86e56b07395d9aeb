#include "sim/collision/growth.h"

#include "sim/tuning.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace tumble {
namespace {

// Which faces meet (feature_contact.cpp): what is left of a feature without its vertex, edge and side.
std::uint64_t faces_of(const Manifold& m) { return m.points[0].feature >> 42; }

void add(const ContactPoint& p, Manifold& first, Manifold& more) {
    Manifold& to = first.count < Manifold::capacity ? first : more;
    if (to.count < Manifold::capacity) to.points[std::size_t(to.count++)] = p;
}

}  // namespace

bool sank(double left_out, double deepest, double radius) {
    const double overlap = tuning::sunk_overlap * radius;
    return left_out < -overlap && left_out < deepest - std::max(overlap, tuning::sunk_share * std::abs(deepest));
}

Manifold grow(std::span<const ContactPoint> left_out, std::span<const Manifold> before, double radius, Manifold& found) {
    Manifold first = found, more = found;
    first.count = more.count = 0;
    more.more = true;
    if (left_out.empty() || faces_of(found) != faces_of(before[0])) return more;
    double deepest = std::numeric_limits<double>::infinity();
    const auto keep = [&](const ContactPoint& p) {
        for (std::size_t k = 0; k < before.size(); ++k) {
            if (!before[k].has(p.feature)) continue;
            Manifold& to = k == 0 ? first : more;
            to.points[std::size_t(to.count++)] = p;
            deepest = std::min(deepest, p.separation);
        }
    };
    const auto had = [&](const ContactPoint& p) { return first.has(p.feature) || more.has(p.feature); };
    std::for_each(found.points.begin(), found.points.begin() + found.count, keep);
    std::for_each(left_out.begin(), left_out.end(), keep);
    for (const ContactPoint& p : left_out)
        if (!had(p) && sank(p.separation, deepest, radius)) add(p, first, more);
    for (int i = 0; i < found.count && first.count < Manifold::capacity; ++i)
        if (!had(found.points[std::size_t(i)])) add(found.points[std::size_t(i)], first, more);
    found = first;
    return more;
}

}  // namespace tumble
