// A joint in motion: its two frames, the laws of its coordinates, and the impulses of the last step.
//
// The six coordinates locate the second frame in the first: displacements along its x, y and z, then angles about
// them. A distance joint has the first alone, the distance of its anchors. A gear has none (see gear.h).
#pragma once

#include "scene/description/joint.h"
#include "sim/dynamics/body.h"
#include "sim/joints/joint_account.h"
#include "sim/joints/settings.h"

#include <array>
#include <cstdint>

namespace tumble {

/// The coordinates that are locked.
struct JointLocks {
    std::uint8_t coordinates = 0;  // bit k: coordinate k
    bool distance = false;         // of a distance joint, whose one coordinate is locked at
    double length = 0.0;           // m

    bool has(std::size_t coordinate) const { return (coordinates >> coordinate & 1) != 0; }
};

struct Joint {
    static constexpr std::uint32_t world = UINT32_MAX;  // instead of a body
    static constexpr std::size_t coordinates = 6;
    static constexpr std::size_t gear_constant = 0;  // index of a gear's constant in `value`
    /// Laws of a coordinate, each a row of the solver; `cone`: swing of a ball.
    enum Law : std::uint8_t { lock, lower, upper, spring, motor, friction, cone };
    static constexpr std::size_t laws = 7;

    std::uint32_t a = world, b = world;  // indices of the bodies; of a gear: one of each of its joints
    JointDescription description;
    // Frames in the body frame, from the center of mass; in world coordinates for the world.
    Vec3 anchor_a = Vec3::Zero(), anchor_b = Vec3::Zero();        // m
    Quat frame_a = Quat::Identity(), frame_b = Quat::Identity();  // joint frame to body frame
    double size = 0.0;                                            // m, of its smaller body: unit of tolerances
    std::array<JointSpring, coordinates> springs;                 // with stiffness and damping in physical units
    bool soft = false;    // has springs, motors, friction or limits: forces that depend on its motion
    bool steady = false;  // holds at all times: no start or end, motors, strengths or gears
    JointLocks locks;

    // State.
    int substeps = 1;     // of its island in the next step, a power of two
    int wait = 0;         // steps of flight before fewer are tried
    bool jammed = false;  // the impulses of its last step by rows did not settle: they are no estimate of the next ones
    bool active = true;   // holds in this step
    bool broken = false;
    double broken_at = 0.0;                   // s
    std::array<double, coordinates> value{};  // m and rad, with whole turns counted; at the end of the last step
    std::array<std::array<double, laws>, coordinates> impulse{};  // N s and N m s, by law, of the last step
    std::array<double, coordinates>
        curving{};  // m/s^2 and rad/s^2: speed that closed a locked coordinate, over the step
    Vec3 force = Vec3::Zero(), torque = Vec3::Zero();  // N and N m, on B at `point`, mean over the last step
    Vec3 point = Vec3::Zero();                         // m, world: where the force acts
    JointAccount account;

    bool distance() const { return description.type == JointType::distance; }
    bool gear() const { return description.type == JointType::gear; }
    const JointAxis& axis(std::size_t coordinate) const {
        return coordinate < 3 ? description.move[coordinate] : description.turn[coordinate - 3];
    }
    bool locked(std::size_t coordinate) const { return locks.has(coordinate); }
    /// Takes the description over.
    void describe(const JointDescription& joint);
    /// A ball, whose spring and friction act about all axes alike.
    bool turns_alike() const { return description.type == JointType::ball && !locked(3) && !locked(4) && !locked(5); }
    /// Inertia along the coordinate alone, kg m^2 or kg.
    double armature(std::size_t coordinate) const {
        return description.armature && coordinate == (description.type == JointType::slider ? 0 : 3)
                   ? *description.armature
                   : 0.0;
    }
    /// Number of coordinates: the others do not exist.
    std::size_t count() const { return distance() ? 1 : gear() ? 0 : coordinates; }

    template <class Archive, class Self>
    static void visit(Archive& archive, Self& self) {
        auto& [a, b, description, anchor_a, anchor_b, frame_a, frame_b, size, springs, soft, steady, locks, substeps,
               wait, jammed, active, broken, broken_at, value, impulse, curving, force, torque, point, account] = self;
        archive.rebuilt(a, b, description, anchor_a, anchor_b, frame_a, frame_b, size, springs, soft, steady, locks);
        archive.between(1, substeps, 2 * tuning::joint_phase_substeps);
        archive.between(0, wait, tuning::joint_wait);
        archive.keep(jammed, active, broken, broken_at, value, impulse, curving, force, torque, point, account);
    }
};

/// Pose of one side: center of mass and orientation of a body; the world has the identity.
struct JointSide {
    Vec3 position = Vec3::Zero();
    Quat orientation = Quat::Identity();
};

/// A coordinate at one pose, and its rate as a form of the velocities: direction . (velocity of B relative to A), of
/// the points of both bodies at JointGeometry::point, or of the angular velocities.
struct JointCoordinate {
    Vec3 direction = Vec3::Zero();  // world
    double value = 0.0;             // m, or rad; of a locked coordinate: its error
};

struct JointGeometry {
    Vec3 point = Vec3::Zero();  // m, world: B's anchor, where both bodies get the forces
    std::array<JointCoordinate, Joint::coordinates> coordinates;
    // Ball: axes of A's frame, the rotation vector (rad) of B's frame along them, and the swing out of the cone.
    Mat3 axes = Mat3::Identity();
    Vec3 rotation = Vec3::Zero();
    JointCoordinate swing;
    double swing_limit = 0.0;  // rad, half angle of the cone in the direction of the swing
};

/// Where the two frames of a joint are, world.
struct JointFrames {
    Vec3 anchor_a = Vec3::Zero(), anchor_b = Vec3::Zero();  // m
    Mat3 a = Mat3::Identity(), b = Mat3::Identity();        // columns: axes of the frames
    // the same; of joints that lock all turns, otherwise unused
    Quat turn_a = Quat::Identity(), turn_b = Quat::Identity();
};

/// Sets the locked coordinates, and leaves the others alone.
void measure_locks(const JointLocks& locks, const JointFrames& frames,
                   std::array<JointCoordinate, Joint::coordinates>& coordinates);

/// Whole turns are counted from Joint::value.
JointGeometry measure(const Joint& joint, const JointSide& a, const JointSide& b);

/// Twist of a ball: its coordinate 3.
double twist_of(const Joint& joint, const JointSide& a, const JointSide& b);

/// True if any coordinate or swing has limits; true if a coordinate was at one at the end of the last step.
bool limited(const Joint& joint);
bool at_limit(const Joint& joint);
/// True if a limit is violated by more than `tolerance`, in rad and sizes of the joint.
bool beyond_limit(const Joint& joint, const JointGeometry& g, double tolerance = 0.0);

// The target of a motor: constant, or through keyframes as a kinematic body moves through its own (keyframe_track.h).

/// m or rad. Precondition: the motor has targets.
double motor_target(const JointMotor& motor, double time);

}  // namespace tumble
