// Groups of joined bodies at an impact: their locked coordinates as equalities over mass-weighted velocities.
//
// Each locked coordinate is a unit form g: its rate is length (g . y + offset), and an impact leaves it as it is. With
// G the forms of a group, the change of velocities lies in the null space of G, so a contact's form w acts as P w, with
// the projection P = 1 - G^T (G G^T)^+ G. In the dual active set method (Goldfarb and Idnani 1983, section 3) this is
// the equalities taken in first and never let go: all that follows works on contacts alone, by their forms P w.
//
// P is found by the augmented Lagrangian: with a compliance R, (1 + G^T G / R) z = G^T c / R and f = (c - G z) / R
// remove the rates -c but for a share R / (R + s^2) along a singular value s of G, and are repeated. The matrix has a
// 6 x 6 block for each body and each joined pair and is factored without fill for trees, so a projection costs a time
// linear in the links. Redundant rows need no treatment.
//
// The armature a of a joint is a rotor with a place of its own in y: its first number is sqrt(a) times the rate of the
// coordinate, which is a lock.
#pragma once

#include "sim/impact/mass_root.h"
#include "sim/impact/velocity_row.h"
#include "sim/joints/joint_impulse.h"
#include "sim/math/block_cholesky.h"

#include <cstdint>
#include <span>
#include <vector>

namespace tumble {

class JoinedGroups {
public:
    /// A limit that the joint is at: its rate must not fall below zero.
    struct Limit {
        std::size_t joint;  // index in the list of joints
        Vec3 direction;     // world, of the rate of B relative to A; points into the allowed range
        bool turns;         // otherwise it moves
        double size;        // m, that makes a rate of turning a speed
        VelocityRow form;   // of the bodies alone; m/s
        double offset;      // m/s, by bodies that are not dynamic
        double restitution;
    };

    /// `bodies`: ascending, with all dynamic bodies of the joints. `joints`: that hold.
    /// `all_joints`: of the set, by the numbers that gears name.
    JoinedGroups(std::span<const std::uint32_t> bodies, const std::vector<Joint*>& joints,
                 std::span<const Joint> all_joints, const std::vector<Body>& all);

    /// Places of the bodies in y: each group's are consecutive. In the order of the list of bodies.
    const std::vector<std::uint32_t>& places() const { return places_; }
    /// Number of places: of bodies and rotors.
    std::size_t size() const { return group_of_.size(); }
    /// Sets y of the rotors from that of the bodies.
    void turn_rotors(Eigen::VectorXd& y) const;

    /// Reads the joints at the bodies' present poses. `roots`: by index in the group.
    void linearize(const std::vector<Body>& all, const std::vector<MassRoot>& roots);

    /// Makes y fit: G y = 0.
    void project(Eigen::VectorXd& y);
    /// y of least length with the rates that moving carriers ask for; empty where none moves.
    const Eigen::VectorXd& carried() const { return carried_; }
    const std::vector<Limit>& limits() const { return limits_; }

    /// P w of a form over two bodies; `own` is its index in the caller's list.
    JoinedRow project(const VelocityRow& form, std::uint32_t own, VelocityRow& row);
    bool joined(std::uint32_t place) const { return group_of_[place] != VelocityRow::none; }

    /// Makes a change of y fit the joints, and returns their impulses: by joint, then of gears on their second
    /// joints; without the work.
    std::vector<JointImpulse> joint_impulses(Eigen::VectorXd& change);

private:
    /// A locked coordinate, or the relation of a gear: a sum of two coordinates, of up to four bodies.
    struct Lock {
        std::size_t joint;  // index in joints_
        Vec3 direction;     // world
        bool turns;
        double length, offset;                // of the rate; offset over the length
        VelocityRow form;                     // with `other`: unit
        VelocityRow other = {};               // of a gear: of its second joint
        Vec3 other_direction = Vec3::Zero();  // world, times the ratio
        bool other_turns = false;
        bool rotor = false;  // `other` is the rotor's

        bool gear() const { return other.a != VelocityRow::none || other.b != VelocityRow::none; }
        double dot(const Eigen::VectorXd& y) const { return form.dot(y) + (gear() ? other.dot(y) : 0.0); }
        void add_to(Eigen::VectorXd& y, double amount) const {
            form.add_to(y, amount);
            if (gear()) other.add_to(y, amount);
        }
    };
    struct Group {
        std::uint32_t first = 0, bodies = 0;  // places
        std::size_t first_lock = 0, locks = 0;
        std::vector<std::size_t> joints;  // indices in joints_
        BlockCholesky matrix;
    };
    /// Rate of B's point relative to A's along a direction, or of turning about it.
    struct Rate {
        VelocityRow form;
        double offset = 0.0;  // by bodies that are not dynamic
    };
    Rate rate_of(const Joint& joint, const Vec3& point, const Vec3& direction, bool turns, const std::vector<Body>& all,
                 const std::vector<MassRoot>& roots) const;
    void add_rotor(Group& group, std::size_t index, Lock lock);
    void linearize_joint(Group& group, std::size_t index, const std::vector<Body>& all,
                         const std::vector<MassRoot>& roots);
    void load_gear(Group& group, std::size_t index, const std::vector<Body>& all, const std::vector<MassRoot>& roots);
    void factor(Group& group);
    void fit(Group& group, Eigen::VectorXd& y, bool carriers);

    std::vector<std::uint32_t> bodies_, places_, group_of_;  // ascending; by body; by index
    std::vector<Joint*> joints_;
    std::span<const Joint> all_joints_;
    std::vector<Group> groups_;
    std::vector<Lock> locks_;
    std::vector<std::uint32_t> rotors_;  // by joint: place
    std::vector<Vec3> points_;           // by joint: m, world
    std::vector<Vec3> other_points_;     // by joint, of a gear: of its second joint
    std::vector<Limit> limits_;
    std::vector<double> given_, asked_, z_;  // by lock: impulses along the forms, rates to remove; work space
    Eigen::VectorXd carried_, work_;
};

}  // namespace tumble
