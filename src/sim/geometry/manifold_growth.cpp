#include "sim/geometry/manifold_growth.h"

#include "sim/geometry/contact_area.h"
#include "sim/geometry/settings.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace tumble {
namespace {

// Id of the faces that meet (feature_contact.cpp): a feature without its vertex, edge and side.
std::uint64_t faces_of(const Manifold& m) { return m.points[0].feature >> 42; }

// Shapes with many corners may have no room for a point. Then, of the two points nearest each other along the normal,
// the higher one is removed. Removing the highest of all would gather the points where the body is deepest: it would
// tip over to the other side and back without end. And so it would if a point that touches made room for one that does
// not: only points farther off than `touch` (m) give way, as long as there are any.
void add(const ContactPoint& p, double touch, Manifold& first, Manifold& more) {
    Manifold& to = first.count < Manifold::capacity ? first : more;
    if (to.count < Manifold::capacity) {
        to.points[std::size_t(to.count++)] = p;
        return;
    }
    std::array<ContactPoint, 2 * Manifold::capacity + 1> all;
    std::copy(more.points.begin(), more.points.end(), std::copy(first.points.begin(), first.points.end(), all.begin()));
    all.back() = p;
    const auto off = [&](const ContactPoint& point) { return point.separation > touch; };
    const bool any_off = std::any_of(all.begin(), all.end(), off);
    double nearest = std::numeric_limits<double>::infinity();
    std::size_t leaves = all.size() - 1;
    for (std::size_t i = 0; i < all.size(); ++i)
        for (std::size_t k = 0; k < i; ++k) {
            const double apart = first.normal.cross(all[i].position - all[k].position).squaredNorm();
            const std::size_t higher = all[i].separation > all[k].separation ? i : k;
            if (!(apart < nearest) || (any_off && !off(all[higher]))) continue;
            nearest = apart;
            leaves = higher;
        }
    if (leaves < Manifold::capacity)
        first.points[leaves] = p;
    else if (leaves + 1 < all.size())
        more.points[leaves - Manifold::capacity] = p;
}

}  // namespace

bool sank(double reduced, double deepest, double radius) {
    const double overlap = tuning::sunk_overlap * radius;
    return reduced < -overlap && reduced < deepest - std::max(overlap, tuning::sunk_share * std::abs(deepest));
}

bool missed(std::span<const Manifold> before, const Manifold& found, std::span<const ContactPoint> reduced,
            double radius) {
    double deepest = std::numeric_limits<double>::infinity(), deepest_known = deepest;
    const auto extend = [&](const ContactPoint& p) {
        deepest = std::min(deepest, p.separation);
        for (const Manifold& m : before)
            if (m.part == found.part && m.has(p.feature)) deepest_known = std::min(deepest_known, p.separation);
    };
    std::for_each(found.points.begin(), found.points.begin() + found.count, extend);
    std::for_each(reduced.begin(), reduced.end(), extend);
    return std::isfinite(deepest_known) && sank(deepest, deepest_known, radius);
}

Manifold grow(std::span<const Manifold> before, double radius, Manifold& found, std::vector<ContactPoint>& reduced) {
    Manifold first = found, more = found;
    first.count = more.count = 0;
    more.more = true;
    if (found.reduced == 0 || faces_of(found) != faces_of(before[0])) return more;
    std::vector<ContactPoint> candidates(found.points.begin(), found.points.begin() + found.count);
    candidates.insert(candidates.end(), reduced.begin() + found.first_reduced,
                      reduced.begin() + found.first_reduced + found.reduced);
    double deepest = std::numeric_limits<double>::infinity();
    for (const ContactPoint& p : candidates)
        for (std::size_t k = 0; k < std::min<std::size_t>(before.size(), 2); ++k) {
            Manifold& to = k == 0 ? first : more;
            if (!before[k].has(p.feature) || to.count == Manifold::capacity) continue;
            to.points[std::size_t(to.count++)] = p;
            deepest = std::min(deepest, p.separation);
        }
    const auto kept = [&](const ContactPoint& p) { return first.has(p.feature) || more.has(p.feature); };
    const double touch = tuning::touch * radius;
    for (const ContactPoint& p : candidates)
        if (!kept(p) && sank(p.separation, deepest, radius)) add(p, touch, first, more);
    // Points of `found` come first. Shapes with many corners change them all the time as they roll: these points are
    // always kept.
    const std::size_t always = candidates.size() > 2 * Manifold::capacity ? std::size_t(found.count) : 0;
    for (std::size_t i = 0; i < candidates.size(); ++i)
        if (!kept(candidates[i]) && (first.count < found.count || i < always)) add(candidates[i], touch, first, more);
    if (first.count == 0) {  // all points of the first have gone
        std::swap(first.points, more.points);
        std::swap(first.count, more.count);
    }
    std::erase_if(candidates, kept);
    first.first_reduced = std::uint32_t(reduced.size());
    first.reduced = std::uint32_t(candidates.size());
    reduced.insert(reduced.end(), candidates.begin(), candidates.end());
    const ContactArea area = contact_area(found);
    spread_pressure(area, first);
    spread_pressure(area, more);
    found = first;
    return more;
}

}  // namespace tumble
