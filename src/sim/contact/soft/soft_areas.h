// Friction of contact areas that several manifolds share (contact_areas.h) in the soft kernel. Such an area has a lane
// of its own, like that of a manifold with a single point: the center of the load of all its manifolds, whose own lanes
// are without friction.
#pragma once

#include "sim/contact/model/contact_areas.h"
#include "sim/contact/model/contact_constraint.h"
#include "sim/contact/soft/aligned_floats.h"
#include "sim/contact/soft/soft_kernel.h"
#include "sim/contact/soft/soft_layout.h"

#include <cstdint>
#include <vector>

namespace tumble {

class SoftAreas {
public:
    /// The lanes of the manifolds.
    struct Lanes {
        std::size_t width = 1;
        float* rows = nullptr;
        const std::uint32_t* bodies = nullptr;
        const std::uint16_t* moved = nullptr;
        double impulse_unit = 1.0;  // N s over the step, of the kernel's impulses in a substep
        double mass_unit = 1.0;     // kg
    };
    /// By one thread: finds the batch's areas and colors them. slot: as in the layout.
    void open(const ContactProblem& problem, const IslandBatch& batch, const SoftLayout& layout,
              const std::vector<std::uint32_t>& slot, const Lanes& lanes);
    bool empty() const { return places_.empty(); }
    const JointLayout& layout() const { return layout_; }

    /// Where a manifold of an area lies, with the number of its points. `swapped`: the lane's A is the manifold's B.
    void put(const ContactProblem& problem, std::uint32_t manifold, std::size_t lane, std::size_t points, bool swapped);

    /// Each group by one thread, after all manifolds are packed. pack() comes before the kernel's prepare(), finish()
    /// after it, and gather() before each rub().
    void pack(const ContactProblem& problem, std::size_t group);
    void finish(const ContactProblem& problem, std::size_t group);
    void gather(std::size_t group);
    /// Gives the impulses to the momenta and, in proportion to their loads, to the manifolds; `reached`: by slot. After
    /// the manifolds are unpacked.
    void unpack(const ContactProblem& problem, std::size_t group, std::vector<std::uint8_t>& reached);

    /// For prepare() and rub(), and for warm_start() and sum(), which take the friction alone.
    soft::Groups groups() { return {rows_.data(), bodies_.data(), moved_.data(), one_point_.data()}; }
    soft::Groups friction() { return {rows_.data(), bodies_.data(), moved_.data(), no_points_.data()}; }

private:
    static constexpr std::uint32_t none = UINT32_MAX;
    struct Member {  // of ContactAreas::members()
        std::uint32_t lane = none;
        std::uint8_t points = 0;
        bool swapped = false;
        float friction = 0.0f;  // coefficient
    };
    soft::ManifoldLane lane_of(const Member& member) const {
        return {lanes_.rows + member.lane / lanes_.width * soft::group_rows * lanes_.width + member.lane % lanes_.width,
                lanes_.width};
    }
    soft::ManifoldLane area_lane(std::size_t group, std::size_t l) {
        return {rows_.data() + group * soft::group_rows * lanes_.width + l, lanes_.width};
    }
    /// Visits the lanes of a group with their areas.
    template <class Visit>
    void each_area(std::size_t group, Visit&& visit) const;
    /// Visits the members of an area that have lanes, with their manifolds.
    template <class Visit>
    void each_member(const SharedArea& area, Visit&& visit) const;

    const ContactAreas* areas_ = nullptr;
    Lanes lanes_;
    std::vector<std::uint32_t> found_;  // areas of the batch: indices
    std::vector<JointLayout::Place> places_;
    JointLayout layout_;
    std::vector<Member> members_;
    AlignedFloats rows_;
    std::vector<std::uint32_t> bodies_;
    std::vector<std::uint16_t> moved_;
    std::vector<std::uint8_t> one_point_, no_points_;
};

}  // namespace tumble
