// The joints of a batch in the soft kernel (soft_joint_rows.h): from the joints to lanes and back.
//
// Momentum: the impulses of a joint act at one point, in each substep at its present position. Bodies get the sum of
// the impulses F and of their moments M about A's center; B's exceed A's by C = sum (x_A - x_B) x f over the bodies'
// displacements since the start of the step. In the steps' own order, displacements and impulses, the sum of
// L + x x P is kept; the bodies are moved at the end of the step, and their displacements x P make up for C.
#pragma once

#include "sim/contact/model/contact_constraint.h"
#include "sim/contact/soft/aligned_floats.h"
#include "sim/contact/soft/soft_joint_rows.h"
#include "sim/contact/soft/soft_layout.h"
#include "sim/joints/joint.h"

#include <array>
#include <cstdint>
#include <span>
#include <vector>

namespace tumble {

// The turns of a joint in the soft kernel (AngularRows in soft_joint_rows.h): its axes, limits, dampers and friction,
// from the joint to a lane and back.

/// Kind of a joint that sweeps know (known_to_sweeps).
soft::JointKind kind_in_sweeps(const Joint& joint);

/// The axes of a joint's turns, one for each of the coordinates 3 to 5, of the poses at the start of a step.
struct AngularAxes {
    std::array<Vec3, 3> axis;           // unit, world
    std::array<double, 3> scale;        // rate of the coordinate over that of the turn about the axis
    std::array<double, 3> least, most;  // rad, about the axis
    std::array<bool, 3> locked{};
    Vec3 bend = Vec3::Zero();  // as in soft::AngularRows
    double circle = 0.0, twist = 0.0;
    bool round = false;  // of a round cone
    double limit = 0.0;  // rad, its half angle
    Vec3 twist_a, twist_b;
};
AngularAxes angular_axes(const Joint& joint, const JointGeometry& g);

struct AngularUnits {
    double share;    // of a step's impulse in a substep, over the unit of mass
    double substep;  // s
    double mass;     // kg, of the kernel's numbers
};
void pack_angular(const Joint& joint, const JointGeometry& g, const AngularAxes& axes, const AngularUnits& units,
                  const soft::AngularLane& lane, bool driven);

/// The impulses about the axes, for the next step: into Joint::impulse.
void unpack_angular(const AngularAxes& axes, const Mat3& frame, const AngularUnits& units,
                    const soft::AngularLane& lane, Joint& joint, bool driven);

struct Joint;

class SoftJoints {
public:
    struct Units {
        std::size_t lanes = 1;
        int substeps = 1;
        double mass = 1.0;     // kg, of the kernel's numbers
        double substep = 0.0;  // s
    };
    /// `joints`: of the batch, indices into JointSet::joints(). Layout and joints must outlive the other calls.
    /// `again`: they were swept in the last step too, and have no state of flights left.
    void open(const SoftLayout& layout, std::span<const std::uint32_t> joints, const Units& units, bool again);
    std::size_t size() const { return joints_.size(); }
    soft::JointGroups groups() {
        return {rows_.data(),     lane_bodies_.data(),  lane_moved_.data(),
                layout_->kinds(), angular_rows_.data(), layout_->angular_indices()};
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
    soft::AngularLane angular_lane(std::size_t group, std::size_t l) {
        return {angular_rows_.data() + (layout_->angular_indices()[group] * soft::angular_rows * units_.lanes + l),
                units_.lanes};
    }
    AngularUnits angular_units() const { return {1.0 / (units_.substeps * units_.mass), units_.substep, units_.mass}; }
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
    std::vector<Place> places_;              // at the start of the step
    std::vector<AngularAxes> angular_axes_;  // the same, of joints that turn
    AlignedFloats rows_, angular_rows_;
    std::vector<std::uint32_t> lane_bodies_;
    std::vector<std::uint16_t> lane_moved_;
};

}  // namespace tumble
