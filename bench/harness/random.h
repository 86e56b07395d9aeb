// Pseudo-random numbers that are the same in every program.
#pragma once

#include "harness/scene.h"

#include <cstdint>
#include <numbers>

namespace tumble::bench {

/// xorshift64 (Marsaglia 2003), with the seeds and the order of draws of the measurements behind the published tables.
class Random {
public:
    explicit Random(std::uint64_t seed) : state_(seed * 0x9e3779b97f4a7c15u + 1) {}
    double unit() {  // 0 .. 1
        state_ ^= state_ << 13;
        state_ ^= state_ >> 7;
        state_ ^= state_ << 17;
        return double(state_ >> 11) * 0x1p-53;
    }
    double both() { return 2.0 * unit() - 1.0; }  // -1 .. 1
    double between(double low, double high) { return low + (high - low) * unit(); }
    /// A rotation by up to `most` rad about an axis drawn from the cube.
    Orientation turned(double most) {
        const double x = both(), y = both(), z = both() + 1e-3;
        return turn({x, y, z}, most * unit());
    }

private:
    std::uint64_t state_;
};

}  // namespace tumble::bench
