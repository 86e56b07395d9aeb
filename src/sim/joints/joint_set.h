// All joints of a world: built from the scene, switched on and off by time, broken by load.
#pragma once

#include "sim/geometry/body_pair.h"
#include "sim/joints/joint.h"
#include "sim/snapshot/joint_state.h"

#include <cstdint>
#include <span>
#include <type_traits>
#include <vector>

namespace tumble {

class JointSet {
public:
    /// `scene_index`: by body, its index in the scene; `origin` (m, world): of the bodies' coordinates.
    JointSet(const SceneDescription& scene, const std::vector<Body>& bodies, std::span<const std::uint32_t> scene_index,
             const Vec3& origin);

    bool empty() const { return joints_.empty(); }
    std::vector<Joint>& joints() { return joints_; }
    const std::vector<Joint>& joints() const { return joints_; }
    /// The bodies of each joint that holds in this step, in the order of active(); of a gear, one of each of its
    /// joints.
    const std::vector<BodyPair>& pairs() const { return pairs_; }
    /// Indices of the joints that hold, ascending.
    const std::vector<std::uint32_t>& active() const { return active_; }
    /// Increases whenever a joint begins or ends to hold.
    std::uint64_t changes() const { return changes_; }

    /// Which joints hold in the step [from, to), s. Bodies whose joint has begun or ended to hold, or is driven, must
    /// be awake: they are appended to `woken`.
    void begin_step(double from, double to, const std::vector<Body>& bodies, std::vector<std::uint32_t>& woken);

    double from() const { return from_; }  // s, of this step
    double to() const { return to_; }
    /// Joints have other bodies.
    void exchange(std::vector<Body>& bodies);
    /// Sets Body::jointed of all bodies.
    void mark(std::vector<Body>& bodies) const;

    /// Pairs of bodies that do not collide, ascending: of active joints without `collide`.
    std::vector<BodyPair> apart() const;

    /// True if the joint's motor follows a path in the step: its bodies must not sleep.
    static bool driven(const Joint& joint, double from, double to);

    /// The accounts of all joints begin now.
    void start_account(const std::vector<Body>& bodies);
    void begin_frame();
    /// After the solve of a step, and after the last of the `steps` of a frame, each of `h` s.
    void end_step();
    /// After the impacts of a step, and flights between them: adds them to the loads and accounts.
    void take_events();
    void end_frame(int steps, double h, const std::vector<Body>& bodies);
    /// Energies of the joints at the present poses, and since the start of the accounts.
    JointEnergies energies(const std::vector<Body>& bodies) const;
    /// Energy in the springs of all joints, or of one, J.
    double elastic(const std::vector<Body>& bodies) const;
    static double potential(const Joint& joint, const std::vector<Body>& bodies);
    static double stored(const Joint& joint, const std::vector<Body>& bodies);
    /// Kinetic energy of the armature of one joint, or of all, J.
    static double rotor_energy(const Joint& joint, const std::vector<Body>& bodies);
    double rotor_energy(const std::vector<Body>& bodies) const;

    /// States for the output: of the present poses and velocities, with the loads of the last step.
    std::vector<JointState> states(const std::vector<Body>& bodies) const;

    /// For checkpoints: see sim/checkpoint/archive.h.
    template <class Archive, class Self>
    static void visit(Archive& archive, Self& self) {
        auto& [joints, active, pairs, changes, from, to] = self;
        archive.keep_each(joints);
        archive.keep(from, to);
        archive.rebuilt(changes);
        archive.scratch(active, pairs);  // follow from the joints
        if constexpr (!std::is_const_v<Self>) self.list();
    }

private:
    void fetch_spans(std::size_t k) const;
    void list();

    std::vector<Joint> joints_;  // in the order of the scene
    std::vector<std::uint32_t> active_;
    std::vector<BodyPair> pairs_;
    std::uint64_t changes_ = 0;
    double from_ = 0.0, to_ = 0.0;  // s, of this step
};

/// Pose of a joint's side.
JointSide side_of(const std::vector<Body>& bodies, std::uint32_t body);

/// An impact changes the velocities, then the momenta.
enum class RotorTime { now, before_impact };
/// Rate of the coordinate that has the armature: rad/s of a hinge, m/s of a slider.
double rotor_speed(const Joint& joint, const std::vector<Body>& bodies, RotorTime time = RotorTime::now);

/// J M^-1 J^T of one coordinate, of bodies without their other joints: 1/kg, or 1/(kg m^2) of an angle.
double compliance_along(const std::vector<Body>& bodies, const Joint& joint, const JointGeometry& g, std::size_t k);

}  // namespace tumble
