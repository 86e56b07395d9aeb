// The locked coordinates of an island's joints in flight: the rows of the Jacobian J that RATTLE needs, as directions and
// arms, and the bodies' states beside them, all close together in memory. Long chains are as fast as memory is: the methods
// take one joint each, so that callers visit it once for several of them.
//
// The row of a displacement along n at the point p is n . (v_b + w_b x r_b - v_a - w_a x r_a), r = p - x; that of an angle
// about n is n . (w_b - w_a). As in joint_rows.h, rows of angles are scaled by the island's length: all are in m/s and N s.
#pragma once

#include "sim/contact/direct/joint_rows.h"
#include "sim/dynamics/integrators/rigid_state.h"
#include "sim/math/block_cholesky.h"

#include <cstdint>
#include <span>
#include <vector>

namespace tumble {

/// A body in flight; world frame.
struct FlightBody {
    RigidState state, start;                            // now, and at the start of the drift
    RigidMass inertia;                                  // constant
    double mass = 0.0;                                  // kg
    Mat3 inertia_body = Mat3::Zero();                   // kg m^2, body frame
    bool spherical_top = false;                         // the same inertia in every frame
    double least_inertia = 0.0;                         // kg m^2, smallest principal moment
    Mat3 rotation = Mat3::Identity();                   // of `state`, body to world
    Mat3 inverse_inertia = Mat3::Zero();                // 1/(kg m^2), world
    Vec3 velocity = Vec3::Zero(), spin = Vec3::Zero();  // m/s, rad/s: of `state`

    /// Of the present rotation.
    void derive_inertia() {
        if (!spherical_top) inverse_inertia = rotation * inertia.inverse_inertia * rotation.transpose();
    }
    void derive_velocities() {
        velocity = inertia.inverse_mass * state.momentum;
        spin = inverse_inertia * state.angular_momentum;
    }
};

class FlightLocks {
public:
    struct Lock {
        Vec3 direction = Vec3::Zero();    // world, unit vector
        double asked = 0.0, given = 0.0;  // m/s: change of J u that is asked for; N s: impulse
        std::uint8_t coordinate = 0;
        bool turns = false;  // is an angle
    };
    /// Joint::constraint_force of a lock, N or N m, and its rates.
    struct LockForce {
        double force = 0.0;
        ConstraintRates rates;
    };
    struct FlightJoint {
        std::uint32_t a = 0, b = 0;                       // indices of FlightBody
        std::uint32_t pair = 0;                           // index in the matrix
        std::uint32_t first = 0, count = 0;               // of its locks
        std::uint32_t moves = 0;                          // number of locked displacements, which come first
        double size = 1.0;                                // m, unit of tolerances
        Vec3 point = Vec3::Zero();                        // m, world: where the impulses act
        Vec3 arm_a = Vec3::Zero(), arm_b = Vec3::Zero();  // m, from the centers of mass to it
        // Of the flight so far: impulses, of springs too; their work on both bodies, and that of the locks alone, J.
        JointLoad load;
        double work_a = 0.0, work_b = 0.0, lock_work = 0.0;
        double springs = 0.0;  // J, of the springs at the start
    };
    /// The constants of a joint.
    struct JointFrame {
        Joint* joint = nullptr;
        std::uint32_t index = 0;                                      // in the JointSet
        JointLocks locks;                                             // Joint::locks
        Vec3 anchor_a = Vec3::Zero(), anchor_b = Vec3::Zero();        // m, body frame, from the center of mass
        Mat3 frame_a = Mat3::Identity(), frame_b = Mat3::Identity();  // joint frame to body frame
    };

    /// The island's joints and bodies in their present states. Bodies that stand still come after those of the island.
    /// Returns whether they are others than those of the last call.
    bool load(const JointIsland& island);
    /// The states of the flight to the bodies of the island.
    void give_back(const JointIsland& island) const;

    std::span<FlightBody> bodies() { return std::span(bodies_).first(moving_); }  // those of the island, in its order
    const FlightBody& body(std::uint32_t place) const { return bodies_[place]; }
    bool moves(std::uint32_t place) const { return place < moving_; }
    FlightBody& body(std::uint32_t place) { return bodies_[place]; }
    std::span<FlightJoint> joints() { return joints_; }
    Joint& joint(const FlightJoint& j) { return *frame_of(j).joint; }
    std::span<const LockForce> forces(const FlightJoint& j) const {
        return std::span(forces_).subspan(j.first, j.count);
    }
    std::span<Lock> locks() { return locks_; }
    std::span<Lock> locks(const FlightJoint& j) { return std::span(locks_).subspan(j.first, j.count); }
    double unit(const Lock& lock) const { return lock.turns ? length_ : 1.0; }  // m, or 1
    bool tree() const { return tree_; }        // the joints form no loop: their impulses are unique
    double length() const { return length_; }  // m, of the island
    double total_mass() const { return total_mass_; }
    double fastest_turn() const;  // rad/s, of two joined bodies against each other
    /// Rounding of the coordinates, in sizes of the joint.
    double place_rounding() const;
    JointSide side(std::uint32_t place) const {
        return {bodies_[place].state.position, bodies_[place].state.orientation};
    }

    /// Directions and arms of a joint at the present poses. Returns its largest error, in sizes of the joint.
    double look(FlightJoint& j);
    /// Sets the matrix M + J^T J / compliance (1/kg) of the last look().
    void fill(BlockCholesky& matrix, double compliance) const;
    /// Errors of a joint at the present poses: returns the largest, in sizes of the joint, and asks for the changes of
    /// speed that would have closed them in a time of `h` s.
    double ask_to_close(const FlightJoint& j, double h);
    /// Asks for the changes that make the velocities fit a joint. Returns the largest, m/s.
    double ask_to_fit(const FlightJoint& j);
    /// g = J^T asked / compliance.
    void add_asked(double compliance, std::vector<double>& g) const;
    /// Gives the bodies the impulses f = (asked - J change) / compliance. Returns false if one is not finite.
    bool take(const std::vector<double>& change, double compliance);
    /// First estimate of the impulses of a time of `h` s, from the forces of the last flights; zero where they are not unique.
    void estimate(const FlightJoint& j, double h, ConstraintRate ConstraintRates::*rate);
    /// Keeps the forces of the impulses given, and their rate, for the next estimate.
    void learn(const FlightJoint& j, double h, ConstraintRate ConstraintRates::*rate);
    void clear_given();
    /// Momenta with impulses of a joint, N s and N m s: equal and opposite, about one point.
    void give(const FlightJoint& j, const Vec3& force, const Vec3& torque);
    /// The impulses of a joint on B, about its point, N s and N m s.
    JointLoad load_of(const FlightJoint& j) const;
    /// Fastest rate (rad/s) at which a body would swing about its joints under the impulses of a time `h` (s). See
    /// JointRows::swing_rate(). add_swing() returns an upper bound of its square for the bodies of the joints so far.
    void begin_swing() { swing_.assign(moving_, 0.0); }
    double add_swing(const FlightJoint& j, const JointLoad& load, double h);
    double swing_rate(double h);

private:
    void list(const JointIsland& island);
    std::uint32_t add_still(const JointIsland& island, std::uint32_t body);
    using Coordinates = std::array<JointCoordinate, Joint::coordinates>;
    Vec3 measure_at(const FlightJoint& j, Coordinates& coordinates) const;
    const JointFrame& frame_of(const FlightJoint& j) const { return frames_[std::size_t(&j - joints_.data())]; }

    // Of the list: joints that hold, as indices in the JointSet, and bodies; joints of the present call.
    std::vector<std::uint32_t> listed_, listed_bodies_, asked_for_;
    std::vector<FlightBody> bodies_;
    std::vector<FlightJoint> joints_;
    std::vector<JointFrame> frames_;  // by joint
    std::vector<Lock> locks_;
    std::vector<LockForce> forces_;  // by lock
    std::vector<double> swing_;      // 1/s^2, by body
    std::size_t moving_ = 0;
    double length_ = 1.0, total_mass_ = 0.0;
    bool tree_ = true;
};

}  // namespace tumble
