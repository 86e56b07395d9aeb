#include "sim/impact/active_set.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

namespace tumble {
namespace {

/// Impulses are distributed over contacts whose rows are dependent to the first value (rounding of lever arms of
/// some hundred meters), or clearly independent by the second. In between, rounding would decide the distribution.
/// Related test: ActiveSet.SpreadsOverDependentRows.
constexpr double projection_spread_dependent = 1e-12;
constexpr double projection_spread_independent = 1e-3;

/// Most rows over which impulses are distributed with the least sum of squares among rows that only push, with the most
/// Newton steps, the relative error of their sum, and the least second derivative. Beyond, the distribution stops short
/// of that. Limits the cost; not fitted: rounding.
constexpr std::size_t projection_even_rows = 128;
constexpr int projection_even_steps = 30;
constexpr double projection_even_rounding = 1e-14;
constexpr double projection_even_least = 1e-10;

/// A row whose multiplier falls slower than this, relative to the rising one, does not block it: rounding. Not
/// fitted: rounding.
constexpr double projection_weight = 1e-13;

/// Sweeps of projected Gauss-Seidel, and the relative change at which it has converged. Related test:
/// ActiveSet.SweepsApproximateTheExactSolution.
constexpr int projection_sweeps = 400;
constexpr double projection_sweep_tolerance = 1e-14;

// x = A^-1 x by Cholesky, A is overwritten; returns false when A is not positive definite. Eigen's solver splits into
// blocks by the size of the processor's cache, which would change the last digits.
bool solve_symmetric(Eigen::MatrixXd& a, Eigen::VectorXd& x) {
    const Eigen::Index n = a.rows();
    for (Eigen::Index j = 0; j < n; ++j) {
        for (Eigen::Index i = j; i < n; ++i)
            for (Eigen::Index k = 0; k < j; ++k) a(i, j) -= a(i, k) * a(j, k);
        if (!(a(j, j) > 0.0)) return false;
        const double pivot = std::sqrt(a(j, j));
        for (Eigen::Index i = j; i < n; ++i) a(i, j) /= pivot;
    }
    for (Eigen::Index i = 0; i < n; ++i) {
        for (Eigen::Index k = 0; k < i; ++k) x[i] -= a(i, k) * x[k];
        x[i] /= a(i, i);
    }
    for (Eigen::Index i = n; i-- > 0;) {
        for (Eigen::Index k = i + 1; k < n; ++k) x[i] -= a(k, i) * x[k];
        x[i] /= a(i, i);
    }
    return true;
}

// The numbers (b c)+ of the least sum of squares for which b^T (b c)+ is `sum`: c minimizes |(b c)+|^2 / 2 - c . sum,
// by Newton's method from the given c. Returns false where that does not converge.
bool spread_evenly(const Eigen::MatrixXd& b, const Eigen::VectorXd& sum, Eigen::VectorXd c, Eigen::VectorXd& even) {
    const auto value = [&](const Eigen::VectorXd& at) {
        double square = 0.0;
        for (Eigen::Index k = 0; k < b.rows(); ++k) {
            const double x = std::max(0.0, b.row(k).dot(at));
            square += x * x;
        }
        return 0.5 * square - at.dot(sum);
    };
    for (int step = 0; step < projection_even_steps; ++step) {
        even = b.lazyProduct(c).cwiseMax(0.0);
        Eigen::VectorXd turn = sum - b.transpose().lazyProduct(even);
        if (turn.norm() <= projection_even_rounding * sum.norm()) return true;
        Eigen::MatrixXd gram = projection_even_least * Eigen::MatrixXd::Identity(b.cols(), b.cols());
        for (Eigen::Index k = 0; k < b.rows(); ++k)
            if (even[k] > 0.0) gram += b.row(k).transpose().lazyProduct(b.row(k));
        const Eigen::VectorXd down = turn;
        if (!solve_symmetric(gram, turn)) return false;
        const double slope = down.dot(turn), now = value(c), rounding = 1e-15 * std::abs(now);
        double share = 1.0;
        while (share > 1e-6 && value(c + share * turn) > now - 0.1 * share * slope + rounding) share *= 0.5;
        c += share * turn;
    }
    return false;
}

}  // namespace

ActiveSet::ActiveSet(const std::vector<VelocityRow>& rows, std::size_t bodies, std::size_t exact)
    : rows_(rows), exact_(exact), joined_(bodies), place_(bodies, VelocityRow::none) {}

bool ActiveSet::solve(const std::vector<Demand>& demands, std::vector<double>& multipliers,
                      const VelocityBound& bound) {
    bound_ = bound;
    work_ = 0.0;
    if (bound.velocity) return solve_component(demands, multipliers);  // the bound is on all velocities together
    find_components(demands);
    if (component_count_ == 1) return solve_component(demands, multipliers);
    bool met = true;
    multipliers.assign(demands.size(), 0.0);
    for (std::size_t k = 0; k < component_count_; ++k) {
        component_demands_.clear();
        for (const std::uint32_t i : components_[k]) component_demands_.push_back(demands[i]);
        met = solve_component(component_demands_, component_multipliers_) && met;
        for (std::size_t i = 0; i < components_[k].size(); ++i)
            multipliers[components_[k][i]] = component_multipliers_[i];
    }
    return met;
}

// In the order of their first demands.
void ActiveSet::find_components(const std::vector<Demand>& demands) {
    const auto bodies_of = [&](const Demand& d) { return std::array{rows_[d.row].a, rows_[d.row].b}; };
    for (const Demand& d : demands)
        for (const std::uint32_t body : bodies_of(d))
            if (body != VelocityRow::none) joined_.separate(body);
    for (const Demand& d : demands) {
        const auto [a, b] = bodies_of(d);
        if (a != VelocityRow::none && b != VelocityRow::none) joined_.join(a, b);
    }
    component_count_ = 0;
    for (std::uint32_t i = 0; i < demands.size(); ++i) {
        const auto [a, b] = bodies_of(demands[i]);
        std::uint32_t& part = place_[joined_.root(a != VelocityRow::none ? a : b)];
        if (part == VelocityRow::none) {
            part = std::uint32_t(component_count_++);
            if (components_.size() < component_count_) components_.emplace_back();
            components_[part].clear();
        }
        components_[part].push_back(i);
    }
    for (const Demand& d : demands)
        for (const std::uint32_t body : bodies_of(d))
            if (body != VelocityRow::none) place_[body] = VelocityRow::none;
}

bool ActiveSet::solve_component(const std::vector<Demand>& demands, std::vector<double>& multipliers) {
    demands_ = &demands;
    multipliers_ = &multipliers;
    multipliers.assign(demands.size(), 0.0);
    work_ += double(demands.size()) * double(demands.size());
    place_bodies();
    change_.setZero(size_);
    return demands.size() <= exact_ ? active_set() : sweeps();
}

// Only the bodies that the component touches: the cost is that of the component, not of the cluster.
void ActiveSet::place_bodies() {
    local_.clear();
    std::uint32_t count = 0;
    const auto place = [&](std::uint32_t body, std::uint32_t bodies) {
        if (body == VelocityRow::none) return body;
        if (place_[body] == VelocityRow::none) {
            place_[body] = count;
            count += bodies;
        }
        return place_[body];
    };
    for (const Demand& demand : *demands_) {
        local_.push_back(rows_[demand.row]);
        VelocityRow& row = local_.back();
        row.a = place(row.a, row.bodies_a());
        row.b = place(row.b, row.bodies_b());
    }
    size_ = 6 * Index(count);
    if (bound_.velocity) start_.resize(size_);
    for (const Demand& demand : *demands_) {
        const VelocityRow& row = rows_[demand.row];
        if (bound_.velocity) {
            for (const auto& [body, bodies] : {std::pair(row.a, row.bodies_a()), std::pair(row.b, row.bodies_b())})
                if (body != VelocityRow::none && place_[body] != VelocityRow::none)
                    start_.segment(6 * Index(place_[body]), 6 * Index(bodies)) =
                        bound_.velocity->segment(6 * Index(body), 6 * Index(bodies));
        }
        if (row.a != VelocityRow::none) place_[row.a] = VelocityRow::none;
        if (row.b != VelocityRow::none) place_[row.b] = VelocityRow::none;
    }
}

bool ActiveSet::active_set() {
    const std::size_t n = demands_->size();
    held_.clear();
    basis_.clear();
    triangle_.clear();
    out_.assign(n, 0);
    bool all_met = true;
    for (std::size_t round = 0; round < 10 * n + 50; ++round) {
        std::size_t worst = n;
        double lowest = 0.0;
        for (std::size_t i = 0; i < n; ++i) {
            if (out_[i]) continue;
            const double s = value(i);
            if (s < -(*demands_)[i].tolerance && s < lowest) {
                lowest = s;
                worst = i;
            }
        }
        if (worst == n) {
            spread();
            refine();
            return all_met;
        }
        if (!take_in(worst)) {
            all_met = false;
            out_[worst] = 1;  // it cannot be met together with the held rows; the others still can
        }
    }
    return false;
}

// Increases lambda_i from zero until row i is met; rows whose multiplier reaches zero on the way are removed. Goldfarb
// and Idnani's step: d moves along the remainder z of w_i by t, the held multipliers by -t R^-1 Q^T w_i.
bool ActiveSet::take_in(std::size_t i) {
    std::vector<double>& lambda = *multipliers_;
    for (;;) {
        const bool independent = split(local_[i]);
        back_substitute();
        double blocked = infinity;
        std::size_t blocking = 0;
        const double least = independent ? projection_weight : tuning::projection_dependent;
        for (std::size_t k = 0; k < held_.size(); ++k) {
            if (weights_[k] <= least) continue;
            const double t = lambda[held_[k]] / weights_[k];
            if (t < blocked) {
                blocked = t;
                blocking = k;
            }
        }
        const double full = independent ? std::max(0.0, -value(i)) / remainder_.squaredNorm() : infinity;
        const double t = std::min(blocked, full);
        if (t == infinity) return false;
        if (independent) {
            if (bound_.velocity && (start_ + change_ + t * remainder_).norm() > bound_.longest) return false;
            change_ += t * remainder_;
        }
        for (std::size_t k = 0; k < held_.size(); ++k)
            lambda[held_[k]] = std::max(0.0, lambda[held_[k]] - t * weights_[k]);
        lambda[i] += t;
        if (full <= blocked) {
            hold(i);
            return true;
        }
        lambda[held_[blocking]] = 0.0;
        release_row(blocking);
    }
}

// w = Q along + remainder. A second pass where cancellation has cost digits in the first (Daniel, Gragg, Kaufman,
// Stewart 1976: twice is enough). Returns false when w depends on the held rows.
bool ActiveSet::split(const VelocityRow& row) {
    remainder_.setZero(size_);
    row.add_to(remainder_, 1.0);
    along_.assign(held_.size(), 0.0);
    for (std::size_t k = 0; k < held_.size(); ++k) {
        const auto q = basis(k);
        const double t = row.dot(q);  // of at most twelve numbers, but for joined bodies
        along_[k] = t;
        remainder_ -= t * q;
    }
    if (remainder_.squaredNorm() < 0.5) {
        for (std::size_t k = 0; k < held_.size(); ++k) {
            const auto q = basis(k);
            const double t = q.dot(remainder_);
            along_[k] += t;
            remainder_ -= t * q;
        }
    }
    return remainder_.norm() > tuning::projection_dependent;
}

void ActiveSet::back_substitute() {
    weights_ = along_;
    for (std::size_t k = held_.size(); k-- > 0;) {
        weights_[k] /= column(k)[k];
        for (std::size_t i = 0; i < k; ++i) weights_[i] -= column(k)[i] * weights_[k];
    }
}

void ActiveSet::forward_substitute(std::vector<double>& v) const {
    for (std::size_t k = 0; k < held_.size(); ++k) {
        for (std::size_t i = 0; i < k; ++i) v[k] -= column(k)[i] * v[i];
        v[k] /= column(k)[k];
    }
}

void ActiveSet::hold(std::size_t i) {
    const double length = remainder_.norm();
    triangle_.insert(triangle_.end(), along_.begin(), along_.end());
    triangle_.push_back(length);
    basis_.resize((held_.size() + 1) * std::size_t(size_));
    basis(held_.size()) = remainder_ / length;
    held_.push_back(i);
    out_[i] = 1;
}

// Removes column k of R; each later column moves up by one and its entry below the diagonal is rotated away
// (Givens).
void ActiveSet::release_row(std::size_t k) {
    out_[held_[k]] = 0;
    sines_.clear();
    cosines_.clear();
    for (std::size_t j = k + 1; j < held_.size(); ++j) {
        double* from = column(j);
        for (std::size_t m = 0; m < sines_.size(); ++m) {
            const double upper = from[k + m], lower = from[k + m + 1];
            from[k + m] = cosines_[m] * upper + sines_[m] * lower;
            from[k + m + 1] = cosines_[m] * lower - sines_[m] * upper;
        }
        const double length = std::sqrt(from[j - 1] * from[j - 1] + from[j] * from[j]);
        const double cosine = from[j - 1] / length, sine = from[j] / length;
        cosines_.push_back(cosine);
        sines_.push_back(sine);
        from[j - 1] = length;
        std::copy(from, from + j, column(j - 1));
        auto q = basis(j - 1), next = basis(j);
        for (Index r = 0; r < size_; ++r) {
            const double upper = q[r], lower = next[r];
            q[r] = cosine * upper + sine * lower;
            next[r] = cosine * lower - sine * upper;
        }
    }
    held_.erase(held_.begin() + std::ptrdiff_t(k));
    triangle_.resize(held_.size() * (held_.size() + 1) / 2);
    basis_.resize(held_.size() * std::size_t(size_));
}

// Chooses the multipliers of the least sum of squares among all with the same change: a flat box presses equally on its
// four corners, not on two of them. With B = W_tight Q, over all rows that are just met, and B^T B c = Q^T d these are
// B c; where one would become negative, the multipliers move from the active set's own towards them as far as none
// does.
void ActiveSet::spread() {
    std::vector<double>& lambda = *multipliers_;
    const std::size_t own = held_.size();
    tight_.clear();
    for (std::size_t i = 0; i < lambda.size(); ++i)
        if (!out_[i] && value(i) <= (*demands_)[i].tolerance) tight_.push_back(i);
    if (own == 0 || tight_.empty()) return;
    // Rows that add a direction extend Q temporarily; dependent rows are rows of B beyond the held ones.
    std::vector<std::size_t> dependent;
    for (const std::size_t i : tight_) {
        split(local_[i]);
        const double left = remainder_.norm();
        if (left > projection_spread_independent)
            hold(i);
        else if (left <= projection_spread_dependent)
            dependent.push_back(i);
    }
    std::vector<std::size_t> rows = held_;
    rows.insert(rows.end(), dependent.begin(), dependent.end());
    const auto rank = Index(held_.size());
    Eigen::MatrixXd b = Eigen::MatrixXd::Zero(Index(rows.size()), rank);
    Eigen::VectorXd now(rows.size());
    for (std::size_t k = 0; k < rows.size(); ++k) {
        now[Index(k)] = lambda[rows[k]];
        if (k < held_.size()) {
            for (std::size_t i = 0; i <= k; ++i) b(Index(k), Index(i)) = column(k)[i];
        } else {
            split(local_[rows[k]]);
            for (std::size_t i = 0; i < held_.size(); ++i) b(Index(k), Index(i)) = along_[i];
        }
    }
    if (Index(rows.size()) > rank) {
        Eigen::MatrixXd gram = b.transpose().lazyProduct(b);
        const Eigen::VectorXd sum = b.transpose().lazyProduct(now);
        Eigen::VectorXd c = sum;
        if (solve_symmetric(gram, c)) {
            Eigen::VectorXd even = b.lazyProduct(c);
            double share = 1.0;
            if (even.minCoeff() < 0.0 && rows.size() <= projection_even_rows && !spread_evenly(b, sum, c, even))
                even = b.lazyProduct(c);
            for (Index k = 0; k < now.size(); ++k)
                if (even[k] < 0.0) share = std::min(share, now[k] / (now[k] - even[k]));
            for (Index k = 0; k < now.size(); ++k)
                lambda[rows[std::size_t(k)]] = std::max(0.0, now[k] + share * (even[k] - now[k]));
        }
    }
    // Rows that got a positive multiplier join the held set: otherwise their speeds are only met to the tolerance.
    if (std::all_of(held_.begin(), held_.end(), [&](std::size_t i) { return lambda[i] > 0.0; })) return;
    held_.resize(own);
    triangle_.resize(own * (own + 1) / 2);
    basis_.resize(own * std::size_t(size_));
}

// One step of iterative refinement on W^T W lambda = -s of the held rows, from the change that the multipliers make.
void ActiveSet::refine() {
    std::vector<double>& lambda = *multipliers_;
    change_.setZero(size_);
    for (std::size_t i = 0; i < lambda.size(); ++i)
        if (lambda[i] > 0.0) local_[i].add_to(change_, lambda[i]);
    along_.resize(held_.size());
    for (std::size_t k = 0; k < held_.size(); ++k) along_[k] = -value(held_[k]);
    forward_substitute(along_);
    back_substitute();
    for (std::size_t k = 0; k < held_.size(); ++k) lambda[held_[k]] = std::max(0.0, lambda[held_[k]] + weights_[k]);
}

bool ActiveSet::sweeps() {
    std::vector<double>& lambda = *multipliers_;
    double first = 0.0;
    for (int sweep = 0; sweep < projection_sweeps; ++sweep) {
        double most = 0.0;
        for (std::size_t i = 0; i < lambda.size(); ++i) {
            const double target = std::max(0.0, lambda[i] - value(i));
            const double step = target - lambda[i];
            if (step == 0.0) continue;
            lambda[i] = target;
            local_[i].add_to(change_, step);
            most = std::max(most, std::abs(step));
        }
        if (sweep == 0) first = most;
        if (most <= projection_sweep_tolerance * first) return true;
    }
    return false;
}

}  // namespace tumble
