// Resting contact and friction of one island to the last digit, for islands that sweeps converge too slowly on: tall
// stacks, heavy on light, and the few bodies of a simple scene.
//
// With u the velocities at the step's end, u* those with the forces alone, and M the masses, contact asks for
//   M (u - u*) = J^T f,   0 <= f_n  perp  J_n u >= b,   friction against the slip within mu f_n
// (torsional friction: soft_solver.h), b = -s/h for points s > 0 apart, 0 at the surface. Solved as an augmented
// Lagrangian: with an estimate e of the impulses and a compliance R, u is the minimum of the convex function
//   (u - u*)^T M (u - u*)/2 + sum R/2 [e + (b - J u)/R]^2  over the contacts where the bracket is positive
// with, for friction, the bracket's distance kept inside the limit; f = bracket is the next estimate, and friction's
// limits follow f_n from round to round (Alart and Curnier 1991). Each minimum is found by Newton's method with line
// search (semismooth; its matrix M + J^T J/R over the active rows is factored by block_cholesky.h). The estimates of
// the last step make most solves of a resting island one evaluation.
//
// Rolling and spinning friction have rows of their own, with limits that follow f_n too (direct_resistance.cpp).
//
// Joints add rows of their own (joint_rows.h). Their errors at the end of the step are closed to rounding: in each
// round the poses there are predicted, and the targets of the rows moved by the errors (constrained symplectic Euler:
// Hairer, Lubich and Wanner, Geometric Numerical Integration, section VII.1).
//
// Lengths are measured in the island's mean radius, so that rotation and translation have equal weight.
#pragma once

#include "sim/contact/direct/contact_rows.h"
#include "sim/contact/direct/joint_rows.h"
#include "sim/dynamics/integrators/rigid_state.h"
#include "sim/math/block_cholesky.h"

#include <cstdint>
#include <span>
#include <utility>
#include <vector>

namespace tumble {

class DirectSolver {
public:
    /// Solves the island and changes bodies, manifolds and joints as ContactProblem specifies. `joints`: indices into
    /// JointSet::active(). Returns false, and changes nothing, when no solution was found; an island with joints takes
    /// the nearest velocities then.
    bool solve(const ContactProblem& problem, std::span<const std::uint32_t> bodies,
               std::span<const std::uint32_t> manifolds, std::span<const std::uint32_t> joints = {});

    /// Closes the joints at the present poses by the least displacements in the metric of the masses, and makes the
    /// velocities fit them. Momenta stay, and so does the center of mass of a free island. Joints that are wide open,
    /// as those whose anchors were placed apart, stay so.
    void close_poses(const ContactProblem& problem, std::span<const std::uint32_t> bodies,
                     std::span<const std::uint32_t> joints);

    /// Block operations of a factorization for this island.
    std::size_t factor_work(const ContactProblem& problem, std::span<const std::uint32_t> bodies,
                            std::span<const std::uint32_t> manifolds);
    /// Factorizations of the last solve.
    int factorizations() const { return factorizations_; }

private:
    static constexpr int none = contact_rows::none;
    using Row = contact_rows::Row;
    using ConstraintRows = contact_rows::ConstraintRows;
    struct Weights {                                 // second derivatives of a constraint's terms
        double normal[4] = {}, friction[3][3] = {};  // friction: both directions and the torsional row
    };

    void read_bodies(const ContactProblem& problem, std::span<const std::uint32_t> bodies);
    void linearize_constraints(const ContactProblem& problem, std::span<const std::uint32_t> bodies,
                               std::span<const std::uint32_t> manifolds);
    void add_resistance(int constraint, const ContactProblem& problem);
    void set_resistance_limits();
    void evaluate_resistance(double along, bool weigh);
    Vec3 resistance_of(const ConstraintRows& constraint) const;
    /// Visits the rows of all contacts with their constraints.
    template <class Visit>
    void each_contact_row(Visit&& visit) {
        for (ConstraintRows& constraint : constraints_)
            contact_rows::each_row(constraint, [&](Row& row) { visit(constraint, row); });
        for (contact_rows::ResistanceRows& resistance : resistances_)
            for (int i = 0; i < 3; ++i) visit(constraints_[std::size_t(resistance.constraint)], resistance.row(i));
    }
    void join_area(ConstraintRows& constraint, const ContactProblem& problem);
    std::pair<double, double> shared_load(const ConstraintRows& first, double Row::*impulse) const;
    void sum_area_loads();
    struct Rubbing {              // impulses on B
        double along_1, along_2;  // N s, along both tangents
        double torsion;           // N m s
    };
    Rubbing rubbing(const ConstraintRows& constraint) const;
    void structure(const ContactProblem& problem, std::span<const std::uint32_t> bodies,
                   std::span<const std::uint32_t> manifolds);
    void start();
    void set_limits(ConstraintRows& constraint);
    bool minimize(int most_steps, int steps_without_ties = 0);
    void evaluate_speeds();
    void evaluate(ConstraintRows& constraint, double along, Weights* weights) const;
    double gradient(std::vector<double>& g);
    double slope(double along, double mass_slope, double mass_curvature);
    double line_search(double slope_0, double mass_slope, double mass_curvature);
    bool factor(bool correcting);
    bool factor_weights(bool correcting);
    Weights correction_weights(const ConstraintRows& constraint) const;
    void set_masses(bool correcting);
    void follow_limits(int time);
    bool solve_rounds();
    bool solve_with_joints(const ContactProblem& problem, std::span<const std::uint32_t> bodies,
                           std::span<const std::uint32_t> manifolds, std::span<const std::uint32_t> joints);
    bool solve_jointed_step(const JointIsland& island, std::span<const std::uint32_t> manifolds, int substeps);
    enum class Fitting { solved, unsolved, rebounds };  // with the rows' impulses or without; rebounds alone
    bool solve_part(const JointIsland& part, std::span<const std::uint32_t> manifolds, int substeps, bool first);
    void linearize_joints(const JointIsland& island, std::span<const std::uint32_t> manifolds);
    void load_part(const JointIsland& part, std::span<const std::uint32_t> manifolds, bool first);
    void give_back_part(const JointIsland& part);
    bool kicks() const { return cut_ && constraints_.empty(); }
    /// True if the impulses are loads and estimates of the next ones: where contacts and joints jam they have no limit.
    bool estimates() const { return settled_ || constraints_.empty(); }
    double force_share(const JointIsland& part) const;
    void kick(const JointIsland& part);
    void strike(const JointIsland& part, double ahead, Fitting fitting);
    enum class Closing { closed, open, stuck };  // open: passes do not converge; stuck: Newton's steps do not
    Closing close_joints(const JointIsland& island, bool moving);
    void fit_start(const JointIsland& island);
    double close_contacts(const JointIsland& island);
    bool moves_no_body() const;
    bool comes_to_rest(const JointIsland& island) const;
    void move_contact(ConstraintRows& constraint, const ContactProblem& problem);
    void move(const JointIsland& island);
    void move_to_end(const JointIsland& island, bool moved);
    double aim_at_gaps(const JointIsland& island);
    int next_substeps(int substeps) const;
    void apply_solution(const JointIsland& island);
    void set_friction_compliance(double compliance);
    bool moves_freely(const JointIsland& island);
    void predict_ends(const JointIsland& island, bool moved);
    std::pair<double, double> next_round();
    bool factored();
    bool step_linear();
    int landing_substeps(const ContactProblem& problem, std::span<const std::uint32_t> bodies) const;
    bool solve_in_substeps(const ContactProblem& problem, std::uint32_t body, int substeps);
    double objective(const std::vector<double>& u);
    double kinetic_energy(const std::vector<double>& u) const;
    void mass_times(const std::vector<double>& u, std::vector<double>& result) const;
    bool within_cones() const;
    bool admissible() const;
    bool correct_overlaps(double h);
    void apply_contacts(const ContactProblem& problem, std::vector<bool>& reached);
    void store_contacts(const ContactProblem& problem);
    void store(const ContactProblem& problem, std::span<const std::uint32_t> bodies, bool pushed);
    bool correct_joined(const JointIsland& island, bool moved);
    void fit_velocities(const JointIsland& island, JointRows::Booking booking, double ahead, Fitting fitting);
    void fit_rows(const JointIsland& island, JointRows::Booking booking, double ahead, bool solved, bool struck);

    struct Mass {
        double mass = 0.0;                                            // kg
        Mat3 inertia = Mat3::Zero(), inverse_inertia = Mat3::Zero();  // kg, over the squared length
    };
    double length_ = 1.0, total_mass_ = 0.0, speed_scale_ = 0.0, fastest_ = 0.0;  // m, kg, m/s, m/s
    double lightest_ = 0.0;                                                       // kg, mass of the lightest body
    double compliance_ = 0.0, friction_compliance_ = 0.0;                         // 1/kg: R
    bool driven_ = false;  // touches a prescribed motion: energy may enter
    int factorizations_ = 0;
    std::vector<Mass> masses_;
    std::vector<double> free_, velocity_, step_, gradient_, scratch_, correction_,
        kept_;                          // u*, u, du, ...; six numbers per body
    std::vector<double> displacement_;  // m, displacement in the step of a body that is solved in substeps
    std::vector<ConstraintRows> constraints_;
    std::vector<contact_rows::ResistanceRows> resistances_;  // ascending by constraint
    std::vector<int> area_firsts_;                           // indices of the first constraints of shared areas
    std::vector<Weights> weights_;                           // by constraint, of the last factorization
    JointRows joints_;
    std::vector<JointSide> ends_;                   // poses at the end of the step
    struct Start {                                  // of a body in a jointed step
        Vec3 position, momentum, angular_momentum;  // after the forces
        Quat orientation;
        Mat3 rotation;
        Vec3 impulse, angular_impulse;  // N s, N m s: by the forces of the step
    };
    std::vector<Start> starts_;
    std::vector<Impulse> part_starts_;     // momenta
    bool cut_ = false;                     // the step is cut where limits with restitution are met
    bool loops_ = false;                   // without contacts: may pass a singular position, which substeps do not help
    bool in_parts_ = false;                // it is solved in substeps, or cut
    bool kicked_ = false;                  // forces have acted since the rows have kept the velocities
    double estimated_for_ = 0.0;           // s: of the estimates of contacts
    double phase_ = 0.0;                   // rad, largest phase of a swing in a substep
    double gap_left_ = 0.0;                // largest error of the last pass, in sizes of the joint
    bool consistent_ = true;               // the impulses fit the velocities
    bool settled_ = true;                  // the rounds have ended with impulses that no longer change
    bool joint_friction_softens_ = false;  // the friction of joints is as soft as that of contacts
    bool ties_ = true;                     // contacts about to open or close count as closed in the second derivatives
    bool near_rest_ = false;               // see comes_to_rest()
    bool limits_held_ = false;             // friction's limits no longer follow the loads: the rounds did not settle
    bool factored_ = false;                // the matrix is that of the rows' weights
    std::vector<BlockCholesky::Pair> pairs_;
    BlockCholesky matrix_;
    BlockCholesky::Blocks base_;  // of the masses and the rows without bounds
    bool base_kept_ = false;      // it is that of this substep
};

}  // namespace tumble
