// Forces of a tree's joints over a step, and their work. The impulse of a joint is the change of momentum of all bodies
// behind it, less that by their forces: so the momenta in the tables balance to rounding. A joint's mean torque is the
// moment that they leave about its point, with the force along the step by Simpson's rule.
#pragma once

#include "sim/articulation/forward_dynamics.h"
#include "sim/articulation/tree_step.h"

#include <span>
#include <vector>

namespace tumble {

/// Impulse, moment and work of the forces on a body that are not gravity.
struct AppliedImpulse {
    Vec3 impulse = Vec3::Zero();  // N s
    Vec3 moment = Vec3::Zero();   // N m s, about the origin of the falling frame
    double work = 0.0;            // J
};

class TreeAccount {
public:
    TreeAccount(const JointTree& tree, const FallingFrame& frame) : tree_(tree), frame_(frame) {}

    /// From the present states of the bodies on.
    void begin(const TreeStep& step);

    /// Impulses at time t (s, in the step), as the forces of sample(): before its first call, and between two at this
    /// time.
    void strike(const ForwardDynamics& dynamics, double t, std::span<const Wrench> impulses);
    /// Forces at time t (s, in the step), after ForwardDynamics::accelerate(). `momenta` (N s) of the bodies and
    /// positions of the joints are in the falling frame; `pushed`: since the start of the step, by body, or none. Again
    /// at the same time where the forces change.
    void sample(const ForwardDynamics& dynamics, double t, std::span<const Wrench> wrenches,
                std::span<const AppliedImpulse> pushed);
    /// Instead of sample() for a stage of Verlet's method of `h` s (negative in some stages of compositions) about
    /// time t, after ForwardDynamics::accelerate() or respond() in its middle.
    void add_stage(const ForwardDynamics& dynamics, double t, double h);
    /// Load of a joint (index among the island's) over its strength, after ForwardDynamics::accelerate().
    double load_of(const ForwardDynamics& dynamics, int joint, std::span<const Wrench> wrenches);
    /// Fastest rate (rad/s) at which a link would swing about its joints under the forces of the last sample.
    double pendulum_rate();
    /// The same in a stage of `h` s, with the impulses at both of its ends.
    void begin_stage() {
        struck_.assign(samples_.size(), Vec3::Zero());
        torques_before_ = torques_;
        carried_before_ = carried_;
    }
    /// Forgets add_stage() since begin_stage().
    void restart_stage() {
        torques_ = torques_before_;
        carried_ = carried_before_;
    }
    double pendulum_rate(double h);

    /// The pose at the end of a body with a prescribed motion.
    void carry(std::uint32_t body, const JointSide& end) {
        carrier_ = body;
        carrier_end_ = end;
    }
    /// Gives the joints their forces, impulses and accounts, from the states of the bodies at both ends. Returns false
    /// where a limit is violated or a joint is loaded well beyond its strength.
    bool finish(std::span<const AppliedImpulse> pushed);
    /// Then, once the joints have the work of their laws: their work on both bodies, and that of a carrier.
    void give_work();

private:
    struct Sample {
        Vec3 force = Vec3::Zero(), torque = Vec3::Zero();  // on the joint's second body
        Vec3 point = Vec3::Zero(), rate = Vec3::Zero();    // m, m/s
    };
    struct Behind {  // the bodies behind a joint
        Vec3 momentum = Vec3::Zero(), moment = Vec3::Zero();
        double work = 0.0;
    };
    struct Start {  // of a body
        Vec3 position, momentum, angular_momentum;
        double energy;  // J, kinetic
    };
    Sample joint_sample(const ForwardDynamics& dynamics, int joint, double t) const;
    void add_mean_forces(std::span<const Vec3> momenta, std::span<const Vec3> applied, std::span<const Sample> ends,
                         double t);
    JointSide side(std::uint32_t body) const;
    bool settle(Joint& joint, int index, const Behind& behind) const;
    void keep_impulses(Joint& joint, const JointGeometry& g, const Sample& end) const;

    const JointTree& tree_;
    const TreeStep* step_ = nullptr;
    std::uint32_t carrier_ = Joint::world;
    JointSide carrier_end_;
    const FallingFrame& frame_;
    double time_ = 0.0;  // s, of the last sample
    bool sampled_ = false;
    bool staged_ = false;                 // by add_stage()
    std::vector<Start> starts_;           // by body
    std::vector<Sample> samples_;         // by joint
    std::vector<Vec3> momenta_, pushes_;  // N s, by body: of the last sample
    std::vector<Vec3> moments_,
        carried_;                // N m s, by joint: integrals of point x force, and of the frame's position x force
    std::vector<Vec3> torques_;  // N m s, by joint: of stages
    std::vector<Vec3> torques_before_, carried_before_;
    std::vector<Vec3> struck_;          // N s, by joint: at both ends of a stage
    std::vector<Behind> behind_;        // by body
    std::vector<double> sums_;          // by body
    std::vector<double> rotors_;        // J, by joint, at the start
    std::vector<SpatialForce> forces_;  // by node
};

}  // namespace tumble
