// The joints of a batch in the soft kernel (soft_joint_rows.h): from the joints to lanes and back.
//
// Momentum: the impulses of a joint act at one point, in each substep at its present place. Bodies get the sum of the
// impulses F and of their moments M about A's center; B's exceed A's by C = sum (x_A - x_B) x f over the bodies'
// displacements since the start of the step. In the steps' own order, displacements and impulses, the sum of
// L + x x P is kept; the bodies are moved at the end of the step, and their displacements x P make up for C.
#pragma once

#include "sim/contact/model/contact_constraint.h"
#include "sim/contact/soft/aligned_floats.h"
#include "sim/contact/soft/soft_joint_rows.h"
#include "sim/contact/soft/soft_layout.h"
#include "sim/contact/soft/soft_turns.h"

#include <cstdint>
#include <span>
#include <vector>

namespace tumble {

struct Joint;

class SoftJoints {
public:
    struct Units {
        std::size_t lanes = 1;
        int substeps = 1;
        double mass = 1.0;     // kg, of the kernel's numbers
        double substep = 0.0;  // s
    };
    /// `joints`: of the batch, indices into JointSet::joints(). Layout and joints must outlive the other calls. `again`: they
    /// were swept in the last step too, and have no state of flights left.
    void open(const SoftLayout& layout, std::span<const std::uint32_t> joints, const Units& units, bool again);
    std::size_t size() const { return joints_.size(); }
    soft::JointGroups groups() {
        return {rows_.data(),     lane_bodies_.data(), lane_moved_.data(),
                layout_->kinds(), turn_rows_.data(),   layout_->turn_places()};
    }

    /// Each group by one thread.
    void pack(const ContactProblem& problem, std::size_t group);
    /// Gives the impulses to the momenta; `reached`: by slot. Writes the moments C into `carried`, by joint.
    void unpack(const ContactProblem& problem, std::size_t group, std::vector<std::uint8_t>& reached,
                std::vector<Vec3>& carried);
    /// Adds the step's work to the joints' accounts, once the bodies have their new velocities.
    void account(const ContactProblem& problem, std::size_t group) const;

private:
    soft::JointLane lane(std::size_t group, std::size_t l) {
        return {rows_.data() + (group * soft::joint_rows * units_.lanes + l), units_.lanes};
    }
    soft::TurnLane turn_lane(std::size_t group, std::size_t l) {
        return {turn_rows_.data() + (layout_->turn_places()[group] * soft::turn_rows * units_.lanes + l), units_.lanes};
    }
    TurnUnits turn_units() const { return {1.0 / (units_.substeps * units_.mass), units_.substep, units_.mass}; }
    void unpack_torque(std::size_t group, std::size_t l, std::uint32_t place, Joint& joint);
    void fetch_next(const ContactProblem& problem, std::size_t group) const;
    template <class Visit>
    void each_lane(std::size_t group, Visit&& visit) const;
    Joint& joint(const ContactProblem& problem, std::uint32_t place) const;

    struct Place {
        Vec3 center_a, center_b;         // m, world: that moments are about
        Vec3 point;                      // m, world: B's anchor
        Mat3 axes;                       // of A's joint frame, world: of all but distance joints
        Vec3 torque, damping, friction;  // N m s, on B over the step: all, and the parts of dampers and of friction
    };

    Units units_;
    bool again_ = false;
    const SoftLayout* bodies_ = nullptr;
    const JointLayout* layout_ = nullptr;
    std::span<const std::uint32_t> joints_;
    std::vector<Place> places_;        // at the start of the step
    std::vector<TurnAxes> turn_axes_;  // the same, of joints that turn
    AlignedFloats rows_, turn_rows_;
    std::vector<std::uint32_t> lane_bodies_;
    std::vector<std::uint16_t> lane_moved_;
};

}  // namespace tumble
