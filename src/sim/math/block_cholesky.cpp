#include "sim/math/block_cholesky.h"

#include "core/cpu_dispatch.h"

#include <Eigen/OrderingMethods>
#include <Eigen/SparseCore>

#include <algorithm>
#include <cmath>
#include <cstring>

namespace tumble {
namespace {

using Row = BlockCholesky::Row;
#define TUMBLE_INLINE inline __attribute__((always_inline))

/// A row in two parts that the compiler keeps in registers, in the code for AVX2 too. Aligned as any memory.
struct Halves {
    typedef double Half __attribute__((vector_size(32)));
    Half low, high;

    static TUMBLE_INLINE Halves of(const Row& row) {
        Halves h;
        std::memcpy(&h.low, &row, sizeof h.low);
        std::memcpy(&h.high, reinterpret_cast<const char*>(&row) + sizeof h.low, sizeof h.high);
        return h;
    }
    TUMBLE_INLINE void store(Row& row) const {
        std::memcpy(&row, &low, sizeof low);
        std::memcpy(reinterpret_cast<char*>(&row) + sizeof low, &high, sizeof high);
    }
    TUMBLE_INLINE void scale(double factor) {
        low *= factor;
        high *= factor;
    }
    TUMBLE_INLINE void subtract(double factor, const Halves& other) {
        low -= factor * other.low;
        high -= factor * other.high;
    }
};

TUMBLE_INLINE double entry(const Row& row, int k) {
    double value;
    std::memcpy(&value, reinterpret_cast<const char*>(&row) + sizeof value * std::size_t(k), sizeof value);
    return value;
}

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
TUMBLE_WIDE bool BlockCholesky::factor() {
    for (std::size_t r = 0; r < bodies_; ++r) {
        Row* h = diagonal_[r].row;
        double* inverse = &inverse_pivot_[6 * r];
        for (int k = 0; k < 6; ++k) {
            const double pivot = entry(h[k], k);
            if (!(pivot > 0.0)) return false;
            inverse[k] = 1.0 / std::sqrt(pivot);
            Halves row = Halves::of(h[k]);
            row.scale(inverse[k]);
            row.store(h[k]);
            for (int j = k + 1; j < 6; ++j) {
                Halves next = Halves::of(h[j]);
                next.subtract(entry(h[k], j), row);
                next.store(h[j]);
            }
        }
        const std::uint32_t begin = first_[r], end = first_[r + 1];
        for (std::uint32_t e = begin; e < end; ++e) {
            Row* block = upper_[e].row;
            Halves y[6];
            for (int k = 0; k < 6; ++k) y[k] = Halves::of(block[k]);
            for (int k = 0; k < 6; ++k) {
                y[k].scale(inverse[k]);
                for (int j = k + 1; j < 6; ++j) y[j].subtract(entry(h[k], j), y[k]);
                y[k].store(block[k]);
            }
        }
        const std::uint32_t* target = target_.data() + first_target_[r];
        for (std::uint32_t x = begin; x < end; ++x) {
            const Row* left = upper_[x].row;
            Row* onto = diagonal_[column_[x]].row;
            Halves right[6];
            for (int s = 0; s < 6; ++s) right[s] = Halves::of(left[s]);
            for (int k = 0; k < 6; ++k) {
                Halves to = Halves::of(onto[k]);
                for (int s = 0; s < 6; ++s) to.subtract(entry(left[s], k), right[s]);
                to.store(onto[k]);
            }
            for (std::uint32_t y = x + 1; y < end; ++y) {
                Row* block = upper_[*target++].row;
                for (int s = 0; s < 6; ++s) right[s] = Halves::of(upper_[y].row[s]);
                for (int k = 0; k < 6; ++k) {
                    Halves::Half low = entry(left[0], k) * right[0].low, high = entry(left[0], k) * right[0].high;
                    for (int s = 1; s < 6; ++s) {
                        low += entry(left[s], k) * right[s].low;
                        high += entry(left[s], k) * right[s].high;
                    }
                    Halves to = Halves::of(block[k]);
                    to.low -= low;
                    to.high -= high;
                    to.store(block[k]);
                }
            }
        }
    }
    return true;
}

TUMBLE_WIDE void BlockCholesky::solve(std::vector<double>& x) const {
    for (std::size_t i = 0; i < bodies_; ++i) {
        const double* six = &x[6 * i];
        work_vector_[place_[i]] = Row{six[0], six[1], six[2], six[3], six[4], six[5], 0.0, 0.0};
    }
    for (std::size_t r = 0; r < bodies_; ++r) {
        const Row* h = diagonal_[r].row;
        const double* inverse = &inverse_pivot_[6 * r];
        double y[8];
        std::memcpy(y, &work_vector_[r], sizeof y);
        for (int k = 0; k < 6; ++k) {
            const double value = y[k] * inverse[k];
            for (int j = 0; j < 8; ++j) y[j] -= value * entry(h[k], j);
            y[k] = value;
        }
        std::memcpy(&work_vector_[r], y, sizeof y);
        for (std::uint32_t e = first_[r]; e < first_[r + 1]; ++e) {
            const Row* u = upper_[e].row;
            Row& row = work_vector_[column_[e]];
            Halves to = Halves::of(row);
            for (int k = 0; k < 6; ++k) to.subtract(y[k], Halves::of(u[k]));
            to.store(row);
        }
    }
    for (std::size_t r = bodies_; r-- > 0;) {
        double y[8];
        std::memcpy(y, &work_vector_[r], sizeof y);
        for (std::uint32_t e = first_[r]; e < first_[r + 1]; ++e) {
            const Row* u = upper_[e].row;
            double known[6];
            for (int k = 0; k < 6; ++k) known[k] = entry(work_vector_[column_[e]], k);
            for (int k = 0; k < 6; ++k)
                y[k] -= ((entry(u[k], 0) * known[0] + entry(u[k], 1) * known[1]) +
                         (entry(u[k], 2) * known[2] + entry(u[k], 3) * known[3])) +
                        (entry(u[k], 4) * known[4] + entry(u[k], 5) * known[5]);
        }
        const Row* h = diagonal_[r].row;
        for (int k = 5; k >= 0; --k) {
            double value = y[k];
            for (int j = k + 1; j < 6; ++j) value -= entry(h[k], j) * y[j];
            y[k] = value * inverse_pivot_[6 * r + std::size_t(k)];
        }
        std::memcpy(&work_vector_[r], y, sizeof y);
    }
    for (std::size_t i = 0; i < bodies_; ++i)
        for (int k = 0; k < 6; ++k) x[6 * i + std::size_t(k)] = entry(work_vector_[place_[i]], k);
}

}  // namespace tumble
