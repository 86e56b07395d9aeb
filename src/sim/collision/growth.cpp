#include "sim/collision/growth.h"

#include "sim/tuning.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace tumble {
namespace {

// Which faces meet (feature_contact.cpp): what is left of a feature without its vertex, edge and side.
std::uint64_t faces_of(const Manifold& m) { return m.points[0].feature >> 42; }

// Of shapes with many corners there may be no room: then for the one that hangs highest.
void add(const ContactPoint& p, Manifold& first, Manifold& more) {
    Manifold& to = first.count < Manifold::capacity ? first : more;
    if (to.count < Manifold::capacity) {
        to.points[std::size_t(to.count++)] = p;
        return;
    }
    const auto higher = [](const ContactPoint& l, const ContactPoint& r) { return l.separation < r.separation; };
    ContactPoint* highest[2];
    for (Manifold* m : {&first, &more}) highest[m == &more] = std::max_element(m->points.begin(), m->points.end(), higher);
    *(higher(*highest[0], *highest[1]) ? highest[1] : highest[0]) = p;
}

}  // namespace

bool sank(double left_out, double deepest, double radius) {
    const double overlap = tuning::sunk_overlap * radius;
    return left_out < -overlap && left_out < deepest - std::max(overlap, tuning::sunk_share * std::abs(deepest));
}

Manifold grow(std::span<const Manifold> before, double radius, Manifold& found, std::vector<ContactPoint>& left_out) {
    Manifold first = found, more = found;
    first.count = more.count = 0;
    more.more = true;
    if (found.left_out == 0 || faces_of(found) != faces_of(before[0])) return more;
    std::vector<ContactPoint> candidates(found.points.begin(), found.points.begin() + found.count);
    candidates.insert(candidates.end(), left_out.begin() + found.first_left_out, left_out.begin() + found.first_left_out + found.left_out);
    double deepest = std::numeric_limits<double>::infinity();
    for (const ContactPoint& p : candidates)
        for (std::size_t k = 0; k < std::min<std::size_t>(before.size(), 2); ++k) {
            Manifold& to = k == 0 ? first : more;
            if (!before[k].has(p.feature) || to.count == Manifold::capacity) continue;
            to.points[std::size_t(to.count++)] = p;
            deepest = std::min(deepest, p.separation);
        }
    const auto kept = [&](const ContactPoint& p) { return first.has(p.feature) || more.has(p.feature); };
    for (const ContactPoint& p : candidates)
        if (!kept(p) && sank(p.separation, deepest, radius)) add(p, first, more);
    for (const ContactPoint& p : candidates)   // those of `found` come first
        if (!kept(p) && first.count < found.count) add(p, first, more);
    if (first.count == 0) {   // all that is left of the first has gone
        std::swap(first.points, more.points);
        std::swap(first.count, more.count);
    }
    std::erase_if(candidates, kept);
    first.first_left_out = std::uint32_t(left_out.size());
    first.left_out = std::uint32_t(candidates.size());
    left_out.insert(left_out.end(), candidates.begin(), candidates.end());
    found = first;
    return more;
}

}  // namespace tumble
