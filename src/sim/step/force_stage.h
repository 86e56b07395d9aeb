// External forces in a step: their effect on the momenta, which shows what contact has added to it, and which is taken
// back in part if the body is clamped (ccd_clamp.h).
#pragma once

#include "sim/dynamics/forces.h"
#include "sim/dynamics/integrators/rigid_state.h"
#include "sim/geometry/manifold.h"
#include "sim/step/body_set.h"

#include <vector>

namespace tumble {

struct StepContext;

class ForceStage {
public:
    ForceStage(const SceneDescription& scene, const BodySet& set);

    const ForceField& field() const { return field_; }

    /// See PairForces::break_up().
    void break_pairs(std::span<const BodyInPieces> broken) { field_.break_pairs(broken); }
    /// See ForceField::reshape().
    void reshape(std::size_t index, const Body& body) { field_.reshape(index, body); }
    /// See ForceField::move_points().
    void move_points(std::size_t from, const std::function<std::uint32_t(const Vec3& point)>& to) {
        field_.move_points(from, to);
    }

    /// Begins the explosions of the step.
    void begin(const StepContext& step);
    /// Wakes bodies on which a force begins or ends in the step.
    void wake(const StepContext& step) const;

    /// Before apply(), where the forces between bodies decide that a contact holds a body.
    void hold_pairs(const StepContext& step);
    /// Before apply(), in water: bodies near others and bodies in joints do not move freely.
    void list_held(const std::vector<Manifold>& manifolds, const std::vector<Body>& bodies);
    /// The forces that apply() gives to the body.
    Wrench wrench(std::uint32_t i, const Body& body, double from, double to) const {
        return field_.throughout(i, body, from, to, flies(i));
    }

    /// Which derived quantities of the awake bodies are out of date when the forces are applied.
    enum class OutOfDate { none, velocities, all };
    /// F and tau at t_n change P and L; the velocities before it are kept in BodySet.
    void apply(const StepContext& step, OutOfDate derived);

    /// Forces at points for the fraction of the step in which they act. Call it after the bounces, which keep their
    /// speed against the forces that act throughout: a bounce must not cancel a brief force.
    void apply_brief(const StepContext& step);

    /// Logs the forces of `span` s on a sleeping body: its contacts carry them.
    void log_asleep(const StepContext& step, std::uint32_t i, double span, const Vec3& place) const;

    /// Regards the body's present momenta as the momenta that the forces alone would have given it.
    void accept(std::uint32_t body, const BodySet& set);
    /// Sets the body back to its momenta before the forces: the start of an integrator of higher order.
    void set_back(std::uint32_t i, Body& body) const;
    /// The same as a state.
    RigidState start_of(std::uint32_t i, const Body& body) const {
        return {body.position, body.orientation, effects_[i].before.momentum, effects_[i].before.angular_momentum};
    }

    /// True if contact has added anything to the effect of the step's forces.
    bool touched(std::uint32_t i, const Body& body) const {
        return effects_[i].after != Momenta{body.momentum, body.angular_momentum} ||
               !body.correction_velocity.isZero(0.0) || !body.correction_angular_velocity.isZero(0.0);
    }

    /// Removes the effect of the lost part of a step from a clamped body that moved for the fraction `share` of it. In
    /// contact the work of the forces along the lost displacement is removed; otherwise the forces have acted for as
    /// long as it moved. Forces at points that end at some time give all of their impulse.
    void lose_time(std::uint32_t i, Body& body, double share, bool in_contact) const;

    /// For checkpoints: see sim/checkpoint/archive.h.
    template <class Archive, class Self>
    static void visit(Archive& archive, Self& self) {
        auto& [field, effects, ending, held] = self;
        archive.rebuilt(field);
        archive.scratch(effects, ending, held);
    }

private:
    struct Momenta {
        Vec3 momentum = Vec3::Zero(), angular_momentum = Vec3::Zero();
        bool operator==(const Momenta&) const = default;
    };
    struct alignas(64) Effect {
        Momenta before, after;
    };

    void log_forces(const StepContext& step, std::uint32_t i, const Wrench& wrench, const Wrench& of_water) const;
    bool flies(std::uint32_t i) const { return !held_.empty() && held_[i] == 0; }

    ForceField field_;
    std::vector<Effect> effects_;  // by body
    std::vector<Impulse> ending_;  // by body: of forces that end at some time; empty without forces at points
    std::vector<char> held_;       // by body; empty without water
};

}  // namespace tumble
