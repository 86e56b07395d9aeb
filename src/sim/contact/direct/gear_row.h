// The row of a gear in the Jacobian: one number per velocity of up to four bodies.
#pragma once

#include "sim/math/block_cholesky.h"

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace tumble {

class GearRow {
public:
    /// Zeros instead of all numbers; bodies and pairs stay.
    void clear_numbers() {
        for (Side& side : sides_) side.six = {};
    }
    /// Adds `factor` times six numbers to the six numbers of a body of the island.
    void add_side(int body, const double* six, double factor);

    double dot(const std::vector<double>& u) const;
    void add(double amount, std::vector<double>& to) const;  // to += amount J^T
    /// Pairs of the row's bodies, appended.
    void add_pairs(std::vector<BlockCholesky::Pair>& pairs);
    void add_square(BlockCholesky& matrix, double weight) const;  // H += weight J^T J

private:
    struct Side {
        int body = 0;
        std::array<double, 6> six{};
    };
    std::array<Side, 4> sides_;
    std::size_t count_ = 0;
    std::uint32_t first_pair_ = 0;  // index in the matrix; the others follow
};

}  // namespace tumble
