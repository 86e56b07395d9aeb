// Contact areas of several manifolds: faces of the same two bodies that meet in one plane, as with tiles, of the
// parts of a compound, or of the triangles of a mesh. Bodies that stand count as one.
//
// How such faces share the load is indeterminate, and a solver's choice would turn a sliding body aside. So their
// friction acts as that of one face: pressure is even over all of them.
#pragma once

#include "sim/contact/model/contact_islands.h"
#include "sim/geometry/manifold.h"

#include <cstdint>
#include <span>
#include <vector>

namespace tumble {

struct SharedArea {
    Vec3 centroid = Vec3::Zero();  // world
    // m: mean distance of the area from its centroid, and that of the farthest point
    double mean_distance = 0.0, radius = 0.0;
    std::uint32_t first = 0, count = 0;  // range in ContactAreas::members()

    /// Torsional friction holds `levers` (N s m) times mu for a load (N s) whose center lies `aside` from the centroid:
    /// that of an even pressure, and where the center of the load is elsewhere, enough for the moment of friction
    /// there.
    double levers(double load, double moment) const {
        return mean_distance * load + (1.0 - mean_distance / radius) * moment;
    }
};

class ContactAreas {
public:
    static constexpr std::uint32_t none = UINT32_MAX;

    /// `repeated`: ContactIslands::repeated() of the manifolds.
    void find(std::span<const ContactIslands::Repeated> repeated, const std::vector<Manifold>& manifolds,
              const std::vector<Body>& bodies);

    bool empty() const { return areas_.empty(); }
    const std::vector<SharedArea>& areas() const { return areas_; }
    /// Manifolds of an area, ascending.
    std::span<const std::uint32_t> members(const SharedArea& area) const {
        return std::span(members_).subspan(area.first, area.count);
    }
    /// Number of the members of all areas.
    std::size_t size() const { return members_.size(); }
    /// Index of the area that a manifold is part of.
    std::uint32_t area_of(std::uint32_t manifold) const { return area_of_[manifold]; }
    bool holds(std::uint32_t manifold) const { return !empty() && area_of_[manifold] != none; }

private:
    void add_areas(std::span<const ContactIslands::Repeated> group, const std::vector<Manifold>& manifolds,
                   const std::vector<Body>& bodies);
    void keep_touching(const std::vector<Manifold>& manifolds, const std::vector<Body>& bodies);
    void add_area(const std::vector<Manifold>& manifolds, const std::vector<Body>& bodies);

    std::vector<SharedArea> areas_;
    std::vector<std::uint32_t> members_;
    std::vector<std::uint32_t> area_of_;          // by manifold; set where there are areas
    std::vector<std::uint32_t> flat_, together_;  // working space
};

}  // namespace tumble
