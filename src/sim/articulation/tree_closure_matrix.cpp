// TreeClosures: the dense equations G M^-1 G^T l = b of the rows.
#include "sim/articulation/tree_closures.h"

#include <algorithm>
#include <cmath>

namespace tumble {
namespace {

/// Share of its compliance below which a row is redundant; and compliance added to all, as a share of the largest,
/// whose error refinement removes. Not fitted: between rounding and the ratio of masses.
constexpr double closure_redundant = 1e-10;
constexpr double closure_compliance = 1e-12;

}  // namespace

// Rows that do not depend on those before them, by a Cholesky factorization with pivots: redundant ones hold by
// themselves. They stay the same within a step, between whose ends they are not redundant to the last digit.
void TreeClosures::choose() {
    const std::size_t m = rows_.size();
    used_.assign(m, 0);
    pivots_.assign(m, 1.0);
    std::vector<double> rest(m), factor(m * m, 0.0);
    double largest = 0.0;
    for (std::size_t i = 0; i < m; ++i) largest = std::max(largest, rest[i] = matrix_[i * m + i]);
    std::vector<std::size_t> order;
    for (;;) {
        std::size_t next = m;
        double most = closure_redundant;
        for (std::size_t i = 0; i < m; ++i) {
            const double own = matrix_[i * m + i];
            if (used_[i] || !(own > closure_compliance * largest) || !(rest[i] > most * own)) continue;
            most = rest[i] / own;
            next = i;
        }
        if (next == m) break;
        used_[next] = 1;
        pivots_[next] = most;
        const double root = std::sqrt(rest[next]);
        for (std::size_t i = 0; i < m; ++i) {
            if (used_[i]) continue;
            double sum = matrix_[i * m + next];
            for (const std::size_t k : order) sum -= factor[i * m + k] * factor[next * m + k];
            factor[i * m + next] = sum / root;
            rest[i] -= factor[i * m + next] * factor[i * m + next];
        }
        order.push_back(next);
    }
}

// The lower factor of a Cholesky factorization; of a row that is not used, that of 1.
void TreeClosures::factor() {
    const std::size_t m = rows_.size();
    double largest = 0.0;
    for (std::size_t i = 0; i < m; ++i) largest = std::max(largest, matrix_[i * m + i]);
    const double added = std::max(compliance_, closure_compliance) * largest;
    factor_.assign(m * m, 0.0);
    for (std::size_t i = 0; i < m; ++i) {
        if (!used_[i]) {
            factor_[i * m + i] = 1.0;
            continue;
        }
        for (std::size_t j = 0; j <= i; ++j) {
            if (!used_[j]) continue;
            double sum = matrix_[i * m + j] + (i == j ? added : 0.0);
            for (std::size_t k = 0; k < j; ++k) sum -= factor_[i * m + k] * factor_[j * m + k];
            factor_[i * m + j] = i == j ? std::sqrt(std::max(sum, 0.5 * added)) : sum / factor_[j * m + j];
        }
    }
}

bool TreeClosures::nearly_dependent(double share) const {
    return std::any_of(pivots_.begin(), pivots_.end(), [&](double pivot) { return pivot < share; });
}

// The rows that are not used take their share: the least forces with the same effect.
std::vector<double> TreeClosures::shared(const std::vector<double>& l) const {
    const std::size_t m = rows_.size();
    std::vector<std::vector<double>> depends;  // G of a row is that of the used ones times this
    for (std::size_t r = 0; r < m; ++r) {
        if (used_[r]) continue;
        std::vector<double> side(m);
        for (std::size_t i = 0; i < m; ++i) side[i] = used_[i] ? matrix_[i * m + r] : 0.0;
        depends.push_back(solve(side));
    }
    if (depends.empty()) return l;
    // (1 + K^T K) x = l by Woodbury: x = l - K^T (1 + K K^T)^-1 K l, and K x for the others.
    const std::size_t n = depends.size();
    const auto dot = [&](const std::vector<double>& a, const std::vector<double>& b) {
        double sum = 0.0;
        for (std::size_t i = 0; i < m; ++i) sum += a[i] * b[i];
        return sum;
    };
    std::vector<double> matrix(n * n), side(n);
    for (std::size_t i = 0; i < n; ++i) {
        side[i] = dot(depends[i], l);
        for (std::size_t j = 0; j < n; ++j) matrix[i * n + j] = dot(depends[i], depends[j]) + (i == j ? 1.0 : 0.0);
    }
    for (std::size_t k = 0; k < n; ++k)
        for (std::size_t i = k + 1; i < n; ++i) {
            const double share = matrix[i * n + k] / matrix[k * n + k];
            for (std::size_t j = k; j < n; ++j) matrix[i * n + j] -= share * matrix[k * n + j];
            side[i] -= share * side[k];
        }
    for (std::size_t i = n; i-- > 0;) {
        for (std::size_t j = i + 1; j < n; ++j) side[i] -= matrix[i * n + j] * side[j];
        side[i] /= matrix[i * n + i];
    }
    std::vector<double> x = l;
    for (std::size_t k = 0; k < n; ++k)
        for (std::size_t i = 0; i < m; ++i) x[i] -= side[k] * depends[k][i];
    std::size_t k = 0;
    for (std::size_t r = 0; r < m; ++r)
        if (!used_[r]) x[r] = side[k++];
    return x;
}

std::vector<double> TreeClosures::solve_once(std::vector<double> side) const {
    const std::size_t m = rows_.size();
    for (std::size_t i = 0; i < m; ++i) {
        for (std::size_t k = 0; k < i; ++k) side[i] -= factor_[i * m + k] * side[k];
        side[i] /= factor_[i * m + i];
    }
    for (std::size_t i = m; i-- > 0;) {
        for (std::size_t k = i + 1; k < m; ++k) side[i] -= factor_[k * m + i] * side[k];
        side[i] /= factor_[i * m + i];
    }
    return side;
}

std::vector<double> TreeClosures::solve(const std::vector<double>& side, const TreeClosures& forms) const {
    const std::size_t m = rows_.size();
    std::vector<double> product(m * m);
    for (std::size_t i = 0; i < m; ++i)
        for (std::size_t j = 0; j < m; ++j) {
            double sum = 0.0;
            for (std::size_t k = 0; k < speeds_; ++k) sum += forms.forms_[i * speeds_ + k] * columns_[j * speeds_ + k];
            product[i * m + j] = sum;
        }
    return solve_by(product, side);
}

// Refined, while that makes the rest smaller.
std::vector<double> TreeClosures::solve_by(const std::vector<double>& matrix, const std::vector<double>& side) const {
    const std::size_t m = rows_.size();
    std::vector<double> l(m, 0.0), rest = side;
    for (std::size_t i = 0; i < m; ++i)
        if (!used_[i]) rest[i] = 0.0;
    double last = infinity;
    for (int pass = 0; pass < 10; ++pass) {
        double most = 0.0;
        for (const double x : rest) most = std::max(most, std::abs(x));
        if (!(most > 0.0) || !(most < 0.5 * last)) break;
        last = most;
        const std::vector<double> more = solve_once(rest);
        for (std::size_t i = 0; i < m; ++i) l[i] += more[i];
        for (std::size_t i = 0; i < m; ++i) {
            if (!used_[i]) continue;
            double sum = side[i];
            for (std::size_t j = 0; j < m; ++j) sum -= matrix[i * m + j] * l[j];
            rest[i] = sum;
        }
    }
    return l;
}

double TreeClosures::energy_of(const std::vector<double>& l) const {
    double sum = 0.0;
    for (std::size_t i = 0; i < l.size(); ++i)
        for (std::size_t j = 0; j < l.size(); ++j) sum += l[i] * matrix_[i * l.size() + j] * l[j];
    return 0.5 * sum;
}

void TreeClosures::add_response(const std::vector<double>& l, double* u) const {
    for (std::size_t k = 0; k < speeds_; ++k) {
        double sum = 0.0;
        for (std::size_t r = 0; r < l.size(); ++r) sum += columns_[r * speeds_ + k] * l[r];
        u[k] += sum;
    }
}

}  // namespace tumble
