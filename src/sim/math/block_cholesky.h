// Linear equations H x = g of bodies coupled by contacts: H is symmetric, positive definite, and made of 6 x 6 blocks,
// one on the diagonal for each body and one for each pair that touches. Factored as U^T U in an order that keeps the
// fill small (approximate minimum degree, Amestoy, Davis and Duff 1996; Eigen's). The structure is analyzed once and
// kept while the same bodies touch.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

namespace tumble {

class BlockCholesky {
public:
    /// Six rows of six numbers, each padded to eight for the vector units.
    typedef double Row __attribute__((vector_size(64)));
    struct Block {
        Row row[6];
    };
    struct Pair {
        std::uint32_t i, j;
        friend bool operator==(const Pair&, const Pair&) = default;
    };

    /// Bodies 0 to bodies-1; pairs may come in any order and more than once, i != j.
    void analyze(std::size_t bodies, const std::vector<Pair>& pairs);
    /// Block multiplications per factorization.
    std::size_t work() const { return work_; }

    void set_zero();
    /// Copies of all blocks, for matrices that differ from one another in a few.
    struct Blocks {
        std::vector<Block> diagonal, upper;
    };
    void save(Blocks& to) const {
        to.diagonal = diagonal_;
        to.upper = upper_;
    }
    /// Precondition: saved after the last analyze().
    void restore(const Blocks& from) {
        diagonal_ = from.diagonal;
        upper_ = from.upper;
    }
    Block& diagonal(std::size_t body) { return diagonal_[place_[body]]; }
    /// The block of pair number k of the analysis. Its rows belong to body i, or to body j where `transposed`.
    Block& coupling(std::size_t k) { return upper_[coupling_[k].block]; }
    bool transposed(std::size_t k) const { return coupling_[k].transposed; }

    /// Returns false when a pivot is not positive.
    bool factor();
    /// x: six numbers per body; on entry g, on return H^-1 g. Precondition: factor() succeeded.
    void solve(std::vector<double>& x) const;

private:
    struct Coupling {
        std::uint32_t block = 0;
        bool transposed = false;
    };
    void order(const std::vector<Pair>& pairs);
    std::uint32_t find_block(std::uint32_t row, std::uint32_t column) const;

    std::size_t bodies_ = 0, work_ = 0;
    std::vector<Pair> pairs_;                    // of the last analysis
    std::vector<std::uint32_t> place_;           // position of a body in the order of elimination
    std::vector<std::uint32_t> first_, column_;  // blocks right of the diagonal, by row: [first_[r], first_[r + 1])
    std::vector<std::uint32_t> first_target_,
        target_;  // by row: blocks that the products of its blocks are subtracted from
    std::vector<Coupling> coupling_;
    std::vector<Block> diagonal_, upper_;
    std::vector<double> inverse_pivot_;  // six per row
    mutable std::vector<Row> work_vector_;
};

}  // namespace tumble
