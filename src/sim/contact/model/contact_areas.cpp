#include "sim/contact/model/contact_areas.h"

#include "sim/contact/model/contact_constraint.h"
#include "sim/contact/model/settings.h"
#include "sim/geometry/contact_area.h"

#include <algorithm>
#include <cmath>

namespace tumble {
namespace {

double size_of(const Manifold& m, const std::vector<Body>& bodies) {
    return std::min(bodies[m.a].radius, bodies[m.b].radius);
}

// True if two faces meet there.
bool face_contact(const Manifold& m) { return !m.more && m.count >= 3 && m.area > 0.0f; }

std::span<const ContactPoint> points_of(const Manifold& m) { return std::span(m.points).first(std::size_t(m.count)); }
double lowest(const Manifold& m) {
    double least = m.points[0].separation;
    for (const ContactPoint& p : points_of(m)) least = std::min(least, p.separation);
    return least;
}
double highest(const Manifold& m) {
    double most = m.points[0].separation;
    for (const ContactPoint& p : points_of(m)) most = std::max(most, p.separation);
    return most;
}

// Centroid of the area, on the surface that impulses act on.
Vec3 acting_centroid(const Manifold& m, const std::vector<Body>& bodies) {
    double separation = 0.0;
    for (const ContactPoint& p : points_of(m)) separation += p.separation / m.count;
    return acting_point(contact_area(m).centroid, separation, m.normal, bodies[m.a].dynamic(), bodies[m.b].dynamic());
}

// True if two bodies that contacts do not move act as one.
bool move_alike(const Body& a, const Body& b) { return &a == &b || (!a.moves() && !b.moves()); }

// True if the faces of two manifolds with one common body lie in one plane.
bool coplanar(const Manifold& m, const Manifold& other, const std::vector<Body>& bodies) {
    // The common body may be A of one and B of the other.
    const bool turned = m.a == other.b || m.b == other.a;
    const std::uint32_t a = turned ? other.b : other.a, b = turned ? other.a : other.b;
    if (!move_alike(bodies[m.a], bodies[a]) || !move_alike(bodies[m.b], bodies[b])) return false;
    const Vec3 normal = turned ? Vec3(-other.normal) : other.normal;
    const double tolerance = tuning::friction_near, near = tolerance * size_of(m, bodies);
    if ((m.normal - normal).squaredNorm() > tolerance * tolerance) return false;
    const auto points = points_of(other);
    return std::all_of(points.begin(), points.end(), [&](const ContactPoint& p) {
        return std::abs(m.normal.dot(p.position - m.points[0].position)) < near;
    });
}

}  // namespace

void ContactAreas::find(std::span<const ContactIslands::Repeated> repeated, const std::vector<Manifold>& manifolds,
                        const std::vector<Body>& bodies) {
    areas_.clear();
    members_.clear();
    for (std::size_t first = 0, end = 0; first < repeated.size(); first = end) {
        const auto same = [&](const ContactIslands::Repeated& r) {
            return r.first == repeated[first].first && r.second == repeated[first].second;
        };
        while (end < repeated.size() && same(repeated[end])) ++end;
        add_areas(repeated.subspan(first, end - first), manifolds, bodies);
    }
    if (areas_.empty()) return;
    area_of_.assign(manifolds.size(), none);
    for (std::uint32_t k = 0; k < areas_.size(); ++k)
        for (const std::uint32_t m : members(areas_[k])) area_of_[m] = k;
}

// The areas of one pair of bodies: planes in the order of their first manifolds.
void ContactAreas::add_areas(std::span<const ContactIslands::Repeated> group, const std::vector<Manifold>& manifolds,
                             const std::vector<Body>& bodies) {
    flat_.clear();
    for (const ContactIslands::Repeated& r : group)
        if (face_contact(manifolds[r.manifold])) flat_.push_back(r.manifold);
    while (flat_.size() > 1) {
        together_.clear();
        const Manifold& first = manifolds[flat_.front()];
        std::erase_if(flat_, [&](std::uint32_t k) {
            const bool takes = &manifolds[k] == &first || coplanar(first, manifolds[k], bodies);
            if (takes) together_.push_back(k);
            return takes;
        });
        keep_touching(manifolds, bodies);
        if (together_.size() > 1) add_area(manifolds, bodies);
    }
}

// Keeps the faces that touch, or nearly do, with all their corners; in a landing, faces that will meet first.
void ContactAreas::keep_touching(const std::vector<Manifold>& manifolds, const std::vector<Body>& bodies) {
    double least = infinity;
    for (const std::uint32_t k : together_) least = std::min(least, lowest(manifolds[k]));
    std::erase_if(together_, [&](std::uint32_t k) {
        const double near = tuning::friction_near * size_of(manifolds[k], bodies);
        return !(highest(manifolds[k]) < std::max(0.0, least) + near);
    });
}

// Each face weighs by its area and its coefficient of friction.
void ContactAreas::add_area(const std::vector<Manifold>& manifolds, const std::vector<Body>& bodies) {
    const auto weight = [&](const Manifold& m) { return double(m.area) * pair_friction(bodies[m.a], bodies[m.b]); };
    const Vec3 origin = manifolds[together_.front()].points[0].position;  // keeps digits far from the world's
    SharedArea area;
    double weights = 0.0;
    for (const std::uint32_t k : together_) {
        area.centroid += weight(manifolds[k]) * (acting_centroid(manifolds[k], bodies) - origin);
        weights += weight(manifolds[k]);
    }
    if (!(weights > 0.0)) return;  // without friction
    area.centroid = origin + area.centroid / weights;
    for (const std::uint32_t k : together_) {
        const Manifold& m = manifolds[k];
        area.mean_distance += weight(m) / weights * mean_distance(m, area.centroid);
        for (int i = 0; i < m.count; ++i)
            area.radius = std::max(area.radius, (m.points[std::size_t(i)].position - area.centroid).norm());
    }
    area.first = std::uint32_t(members_.size());
    for (const std::uint32_t k : together_) {
        members_.push_back(k);
        const bool more = k + 1 < manifolds.size() && manifolds[k + 1].more && manifolds[k + 1].a == manifolds[k].a &&
                          manifolds[k + 1].b == manifolds[k].b;
        if (more) members_.push_back(k + 1);
    }
    area.count = std::uint32_t(members_.size()) - area.first;
    areas_.push_back(area);
}

}  // namespace tumble
