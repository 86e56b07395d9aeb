// Flight of joined bodies that form a tree, in joint coordinates: gaps are zero by construction. The state stays that
// of the bodies: coordinates and speeds are found at the start of a step, and the bodies placed at its end.
//
// By extrapolation with as many results and steps as the error demands (integrator = "exact"), by the method of Runge
// and Kutta ("rk4"), or by Verlet's method: to second order, or composed ("splitting"). A free tree is computed in a
// frame that falls with its center of mass; its momentum and angular momentum at the end are set to those at the start
// by a rigid motion of the whole.
#pragma once

#include "sim/articulation/tree_account.h"
#include "sim/articulation/tree_closures.h"
#include "sim/articulation/tree_friction.h"
#include "sim/articulation/tree_limits.h"
#include "sim/articulation/tree_springs.h"
#include "sim/joints/joint_way.h"

#include <optional>
#include <span>
#include <vector>

namespace tumble {

/// How a tree is integrated: by extrapolation, by the method of Runge and Kutta, or otherwise by Verlet's method,
/// composed to the given order.
struct TreeMethod {
    IntegratorKind kind = IntegratorKind::symplectic_euler;
    int order = 2;

    bool verlet() const { return !fine_integrator(kind); }
};

/// Method of bodies that are joined.
inline TreeMethod tree_method(const std::vector<Body>& bodies, std::span<const std::uint32_t> joined) {
    const IntegratorKind kind = joined_integrator(bodies, joined);
    return {kind, kind == IntegratorKind::exact ? 8 : kind == IntegratorKind::symplectic_euler ? 2 : 4};
}

class TreeFlight {
public:
    TreeFlight() = default;
    TreeFlight(const TreeFlight&) = delete;  // the dynamics refer to the tree
    TreeFlight& operator=(const TreeFlight&) = delete;

    enum class Outcome {
        flown,
        declined,  // no tree, its joints have come apart, or a spring or friction along no coordinate
        stopped,   // a limit is violated, or a joint loaded beyond its strength: a step for the solver of contacts
    };
    /// Moves the bodies over the step from their present state, that of the start without the step's forces. Changes
    /// bodies and joints, and leaves them in any state where they have not flown.
    ///
    /// Parts of the step end where a limit is met or left, where the friction of a joint changes, and where a joint
    /// breaks: the pieces then fly on.
    ///
    /// Verlet's method and its compositions (tree_verlet.cpp) take `substeps`, a power of two, and more where links
    /// under tension swing fast or the velocities do not settle; `substeps` is then the number for the next step. They
    /// stop where a limit is violated at the end.
    Outcome advance(const TreeStep& step, TreeMethod method, int& substeps);
    Outcome advance(const TreeStep& step, IntegratorKind method) {
        int substeps = 1;
        return advance(step, {method, 2}, substeps);
    }

    /// True if the joints of the last step have a spanning tree.
    bool is_tree() const { return tree_.found(); }
    /// Evaluations of the dynamics in the last step.
    int evaluations() const { return evaluations_; }
    /// Largest phase (rad) of a link's swing in a substep of the last step, at least joint_easy_phase where the next
    /// one should have no fewer.
    double phase() const { return phase_; }
    /// True if half the substeps would not have kept the energy of the last step.
    bool strains_energy() const { return strains_energy_; }

private:
    using Vector = Eigen::VectorXd;
    struct Totals {                                                     // of a free tree
        Vec3 momentum = Vec3::Zero(), angular_momentum = Vec3::Zero();  // about the center of mass
        Vec3 center = Vec3::Zero();                                     // m, from the tree's origin
        double mass = 0.0;
    };

    struct Part {  // of the step from the present state
        const Vector& first;
        double scale;
        IntegratorKind method;
    };
    // Changes that end a part of the step: those of friction, by coordinate, then the limits, then the breaks, by
    // joint.
    static constexpr std::size_t none = std::size_t(-1);

    bool start(double stage);
    void carry(double time, bool impulse = false);
    bool jolted() const;
    double next_change(double now) const;
    const KeyframeTrack* track() const {
        return tree_.carrier() == Joint::world ? nullptr : step_->bodies[tree_.carrier()].track.get();
    }
    Outcome advance_tree(const TreeStep& step, TreeMethod method, int& substeps);
    Outcome fly(const TreeStep& step, TreeMethod method, int substeps);
    Outcome advance_pieces(const TreeStep& step, TreeMethod method, int& substeps, int broken);
    bool fits();
    void fit();
    Totals totals() const;
    double kinetic_energy() const;
    bool keeps_energy();
    Vector rate(const Vector& y);
    void add_pushes(const Vector& y, Vector& dy, double ahead = 0.0);
    bool integrate(double until, IntegratorKind method);
    bool integrate_verlet(double until, int substeps);
    bool compose(Vector& y, double h, bool counts);
    bool stage(Vector& y, double h, double time, bool counts);
    bool closed_stage(Vector& y, double h, double time, bool counts);
    void move_still(const Vector& y);
    void give_impulses(const Vector& at, Vector& y, const std::vector<double>& impulses, const Vector& mean,
                       double time);
    void linearize_closures(const Vector& y);
    double most_energy(double h) const;
    double fit_closures(Vector& y, double time, bool counts);
    bool close(double time);
    double fastest_turn(const Vector& y) const;
    void drift(double* coordinates, const double* speeds, double h) const;
    double take_pass(const double* speeds, double h);
    double extrapolate(const Vector& first, double h, double scale, Vector& change);
    bool begin_laws();
    bool settle();
    bool change_law();
    bool strike(std::size_t limit);
    bool strike_all();
    bool shorten_to_event(const Part& part, double& size, Vector& change);
    bool events_possible() const { return events() > 0; }
    std::size_t first_weak() const { return friction_.count() + limits_.count(); }
    void find_weak();
    std::size_t events() const { return first_weak() + weak_.size(); }
    double load_of(int joint);
    double excess(std::size_t event, const Vector& y);
    double excess_at(std::size_t event, const Vector& y);
    double unit_of(std::size_t event) const;
    Vector go(const Part& part, double s);
    std::size_t first_event(const Part& part, double& size, Vector& change);
    std::size_t event_within(const Part& part, const Vector& end, const Vector& end_rate, double& size, Vector& change);
    bool locate(const Part& part, std::size_t event, double& size, Vector& change);
    double error_of(const Vector& difference, double scale) const;
    double fastest(const Vector& y, const Vector& dy) const;
    void normalize();
    void sample();
    void place();
    void count_turns();
    std::vector<AppliedImpulse> applied_impulses() const;

    std::optional<TreeStep> own_;  // the step, up to a break
    const TreeStep* step_ = nullptr;
    JointTree tree_;
    ForwardDynamics dynamics_{tree_};
    TreeSprings springs_;
    TreeFriction friction_;
    TreeLimits limits_;
    TreeClosures closures_, at_start_;  // now, and at the start of a stage of Verlet's method
    std::vector<int> weak_;             // joints that can break, and carry less than their strength at the start
    std::size_t event_ = none;          // at the end of this part
    double needed_ = 0.0;               // N m, N: net effort of a held coordinate there
    int changes_ = 0;                   // of friction and limits in this step
    FallingFrame frame_;
    Totals start_;
    double energy_ = 0.0;      // J, kinetic, at the start
    double last_error_ = 0.0;  // J, with half the substeps
    std::optional<TreeAccount> account_;
    // Coordinates, speeds, heats of dampers, works of motors, the time and sums of closures; where other forces than
    // gravity act also the time, by body their impulse, moment and work, and the moment about the center of mass and
    // the displacement of the whole.
    Vector y_;
    Vector fitted_;  // coordinates of the closures' matrices; empty: others
    int coordinates_ = 0, heats_ = 0, works_ = 0, closed_ = 0, extras_ = 0;  // number of coordinates; indices in y
    bool pushed_ = false;
    double lost_ = 0.0;                   // J, where the velocities did not fit the joints at the start
    double time_ = 0.0, law_time_ = 0.0;  // s, in the step; absolute, at which forces are looked up
    std::vector<Wrench> pushes_;          // by body
    int evaluations_ = 0;
    // Verlet's method: stages of its composition, as shares of a part; the middle of a stage, its rates and the speeds
    // at its end.
    std::vector<double> stages_;
    int order_ = 0;
    Vector middle_, rates_, after_, mean_;
    double phase_ = 0.0;
    bool coarse_ = false, strains_energy_ = false;
    std::vector<SpatialMotion> velocities_;  // by body
    std::vector<Sym3> inertias_;             // kg m^2, by body
};

}  // namespace tumble
