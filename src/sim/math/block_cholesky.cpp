#include "sim/math/block_cholesky.h"

#include <Eigen/OrderingMethods>
#include <Eigen/SparseCore>

#include <algorithm>
#include <cmath>

namespace tumble {
namespace {

using Row = BlockCholesky::Row;

void load(const double* six, Row& row) { row = Row{six[0], six[1], six[2], six[3], six[4], six[5], 0.0, 0.0}; }

}  // namespace

// The order of elimination, from the graph of the bodies.
void BlockCholesky::order(const std::vector<Pair>& pairs) {
    const int n = int(bodies_);
    std::vector<Eigen::Triplet<double, int>> entries;
    for (int i = 0; i < n; ++i) entries.emplace_back(i, i, 1.0);
    for (const Pair& p : pairs) {
        entries.emplace_back(int(p.i), int(p.j), 1.0);
        entries.emplace_back(int(p.j), int(p.i), 1.0);
    }
    Eigen::SparseMatrix<double, Eigen::ColMajor, int> graph(n, n);
    graph.setFromTriplets(entries.begin(), entries.end());
    Eigen::PermutationMatrix<Eigen::Dynamic, Eigen::Dynamic, int> permutation;
    Eigen::AMDOrdering<int>()(graph, permutation);
    place_.resize(bodies_);
    for (int k = 0; k < n; ++k) place_[std::size_t(permutation.indices()[k])] = std::uint32_t(k);
}

std::uint32_t BlockCholesky::find_block(std::uint32_t row, std::uint32_t column) const {
    const auto begin = column_.begin() + first_[row], end = column_.begin() + first_[row + 1];
    return std::uint32_t(std::lower_bound(begin, end, column) - column_.begin());
}

void BlockCholesky::analyze(std::size_t bodies, const std::vector<Pair>& pairs) {
    if (bodies == bodies_ && pairs == pairs_) return;
    bodies_ = bodies;
    pairs_ = pairs;
    order(pairs);

    // Eliminating a body couples all bodies that it is still coupled to. Merging its pattern into that of the first of
    // them makes every pattern complete at its turn (George and Liu 1981, section 5.2).
    std::vector<std::vector<std::uint32_t>> pattern(bodies);
    for (const Pair& p : pairs) {
        const std::uint32_t r = std::min(place_[p.i], place_[p.j]), c = std::max(place_[p.i], place_[p.j]);
        pattern[r].push_back(c);
    }
    first_.assign(1, 0);
    column_.clear();
    work_ = 0;
    for (std::size_t r = 0; r < bodies; ++r) {
        auto& columns = pattern[r];
        std::sort(columns.begin(), columns.end());
        columns.erase(std::unique(columns.begin(), columns.end()), columns.end());
        if (!columns.empty()) pattern[columns[0]].insert(pattern[columns[0]].end(), columns.begin() + 1, columns.end());
        column_.insert(column_.end(), columns.begin(), columns.end());
        first_.push_back(std::uint32_t(column_.size()));
        work_ += 1 + columns.size() + columns.size() * (columns.size() + 1) / 2;
    }
    first_target_.assign(1, 0);
    target_.clear();
    for (std::size_t r = 0; r < bodies; ++r) {
        const auto& columns = pattern[r];
        for (std::size_t x = 0; x < columns.size(); ++x)
            for (std::size_t y = x + 1; y < columns.size(); ++y) target_.push_back(find_block(columns[x], columns[y]));
        first_target_.push_back(std::uint32_t(target_.size()));
    }
    coupling_.clear();
    for (const Pair& p : pairs) {
        const std::uint32_t i = place_[p.i], j = place_[p.j];
        coupling_.push_back({find_block(std::min(i, j), std::max(i, j)), i > j});
    }
    diagonal_.resize(bodies);
    upper_.resize(column_.size());
    inverse_pivot_.resize(6 * bodies);
    work_vector_.resize(bodies);
}

void BlockCholesky::set_zero() {
    std::fill(diagonal_.begin(), diagonal_.end(), Block{});
    std::fill(upper_.begin(), upper_.end(), Block{});
}

// Row by row of blocks: U_rr^T U_rr = H_rr, U_rc = U_rr^-T H_rc, and H_cd -= U_rc^T U_rd for all c <= d after it.
bool BlockCholesky::factor() {
    for (std::size_t r = 0; r < bodies_; ++r) {
        Row* h = diagonal_[r].row;
        double* inverse = &inverse_pivot_[6 * r];
        for (int k = 0; k < 6; ++k) {
            if (!(h[k][k] > 0.0)) return false;
            inverse[k] = 1.0 / std::sqrt(h[k][k]);
            h[k] *= inverse[k];
            for (int j = k + 1; j < 6; ++j) h[j] -= h[k][j] * h[k];
        }
        const std::uint32_t begin = first_[r], end = first_[r + 1];
        for (std::uint32_t e = begin; e < end; ++e) {
            Row* y = upper_[e].row;
            for (int k = 0; k < 6; ++k) {
                y[k] *= inverse[k];
                for (int j = k + 1; j < 6; ++j) y[j] -= h[k][j] * y[k];
            }
        }
        const std::uint32_t* target = target_.data() + first_target_[r];
        for (std::uint32_t x = begin; x < end; ++x) {
            const Row* left = upper_[x].row;
            Row* onto = diagonal_[column_[x]].row;
            for (int k = 0; k < 6; ++k)
                for (int s = 0; s < 6; ++s) onto[k] -= left[s][k] * left[s];
            for (std::uint32_t y = x + 1; y < end; ++y) {
                const Row* right = upper_[y].row;
                Row* to = upper_[*target++].row;
                for (int k = 0; k < 6; ++k) {
                    Row sum = left[0][k] * right[0];
                    for (int s = 1; s < 6; ++s) sum += left[s][k] * right[s];
                    to[k] -= sum;
                }
            }
        }
    }
    return true;
}

void BlockCholesky::solve(std::vector<double>& x) const {
    for (std::size_t i = 0; i < bodies_; ++i) load(&x[6 * i], work_vector_[place_[i]]);
    for (std::size_t r = 0; r < bodies_; ++r) {
        const Row* h = diagonal_[r].row;
        Row y = work_vector_[r];
        for (int k = 0; k < 6; ++k) {
            const double value = y[k] * inverse_pivot_[6 * r + std::size_t(k)];
            y -= value * h[k];
            y[k] = value;
        }
        work_vector_[r] = y;
        for (std::uint32_t e = first_[r]; e < first_[r + 1]; ++e) {
            const Row* u = upper_[e].row;
            Row& to = work_vector_[column_[e]];
            for (int k = 0; k < 6; ++k) to -= y[k] * u[k];
        }
    }
    for (std::size_t r = bodies_; r-- > 0;) {
        Row y = work_vector_[r];
        for (std::uint32_t e = first_[r]; e < first_[r + 1]; ++e) {
            const Row* u = upper_[e].row;
            const Row known = work_vector_[column_[e]];
            for (int k = 0; k < 6; ++k) {
                const Row p = u[k] * known;
                y[k] -= ((p[0] + p[1]) + (p[2] + p[3])) + (p[4] + p[5]);
            }
        }
        const Row* h = diagonal_[r].row;
        for (int k = 5; k >= 0; --k) {
            double value = y[k];
            for (int j = k + 1; j < 6; ++j) value -= h[k][j] * y[j];
            y[k] = value * inverse_pivot_[6 * r + std::size_t(k)];
        }
        work_vector_[r] = y;
    }
    for (std::size_t i = 0; i < bodies_; ++i)
        for (int k = 0; k < 6; ++k) x[6 * i + std::size_t(k)] = work_vector_[place_[i]][k];
}

}  // namespace tumble
