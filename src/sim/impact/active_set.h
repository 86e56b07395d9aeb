// The least change d of the velocities that makes a set of contacts stop approaching:
//
//   minimize |d|^2   subject to   w_i . d + s_i >= 0   for i in the set,   w_i unit rows, s_i their present values.
//
// Its solution is d = sum of lambda_i w_i with lambda_i >= 0 (no contact pulls) and lambda_i > 0 only where the contact
// is just stopped: the impulses. Solved by the dual active set method of Goldfarb and Idnani 1983, "A numerically
// stable dual method for solving strictly convex quadratic programs":
// - the most violated row is added;
// - a row whose impulse would become negative is removed;
// - no row is added that depends on the held rows (the four corners of a flat box have rank three).
// The held rows are kept as W = Q R, orthogonalized twice where it matters, so the result is exact to rounding. Where
// rows depend on each other d is unique and the multipliers are not: they are then spread evenly.
//
// Contacts that no body connects are independent: each connected component of the set is solved by itself. Components
// of more than tuning::projection_contacts are solved approximately, by projected Gauss-Seidel.
#pragma once

#include "core/disjoint_sets.h"
#include "sim/impact/settings.h"
#include "sim/impact/velocity_row.h"

#include <cstdint>
#include <vector>

namespace tumble {

/// An upper bound of the length of the velocities after the projection, and the velocities before it.
struct VelocityBound {
    const Eigen::VectorXd* velocity = nullptr;  // null: no bound
    double longest = 0.0;
};

class ActiveSet {
public:
    /// `rows` of unit length over `bodies` bodies; kept by reference. Components of up to `exact` demands are solved
    /// exactly.
    ActiveSet(const std::vector<VelocityRow>& rows, std::size_t bodies,
              std::size_t exact = tuning::projection_contacts);

    struct Demand {
        std::uint32_t row;
        double value;      // s_i
        double tolerance;  // a row is satisfied from -tolerance on
    };

    /// Finds `multipliers`, one for each demand. Returns false when not all demands can be met together within the
    /// bound, if there is one (or, exceptionally, when the iterations ran out); the multipliers are then those of the
    /// rows that can.
    bool solve(const std::vector<Demand>& demands, std::vector<double>& multipliers, const VelocityBound& bound = {});
    /// Cost of the last solve: sum over its components of the squared number of demands.
    double work() const { return work_; }

private:
    using Index = Eigen::Index;

    void find_components(const std::vector<Demand>& demands);
    bool solve_component(const std::vector<Demand>& demands, std::vector<double>& multipliers);
    void place_bodies();
    bool active_set();
    bool sweeps();
    bool take_in(std::size_t i);
    bool split(const VelocityRow& row);
    void back_substitute();
    void forward_substitute(std::vector<double>& v) const;
    void hold(std::size_t i);
    void release_row(std::size_t k);
    void spread();
    void refine();
    double value(std::size_t i) const { return (*demands_)[i].value + local_[i].dot(change_); }
    double* column(std::size_t k) { return triangle_.data() + k * (k + 1) / 2; }
    const double* column(std::size_t k) const { return triangle_.data() + k * (k + 1) / 2; }
    Eigen::Map<Eigen::VectorXd> basis(std::size_t k) { return {basis_.data() + k * std::size_t(size_), size_}; }

    const std::vector<VelocityRow>& rows_;
    std::size_t exact_;
    double work_ = 0.0;
    DisjointSets joined_;  // bodies of the cluster, by the demands
    std::vector<std::vector<std::uint32_t>>
        components_;  // demands of the components; the first component_count_ of them are in use
    std::size_t component_count_ = 0;
    std::vector<Demand> component_demands_;
    std::vector<double> component_multipliers_;
    std::vector<std::uint32_t> place_;  // index of a cluster body in the component
    const std::vector<Demand>* demands_ = nullptr;
    std::vector<double>* multipliers_ = nullptr;
    std::vector<VelocityRow> local_;  // the set's rows, over the bodies that they touch
    Index size_ = 0;
    VelocityBound bound_;
    Eigen::VectorXd start_;                  // velocities of these bodies before the projection
    std::vector<std::size_t> held_, tight_;  // held rows, W = Q R; rows met with equality without being held
    std::vector<char> out_;                  // held, or given up
    std::vector<double> basis_, triangle_;   // Q by columns; R packed by columns
    Eigen::VectorXd change_, remainder_;     // d; remainder of a row after projection on Q
    std::vector<double> along_, weights_;    // Q^T w; R^-1 Q^T w
    std::vector<double> sines_, cosines_;
};

}  // namespace tumble
