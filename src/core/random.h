// Random numbers that are the same on every machine: std::mt19937_64 is specified to the bit, the standard's
// distributions are not and are replaced. No trigonometry: directions and rotations come from points drawn in a ball.
#pragma once

#include "core/vector.h"

#include <cstdint>
#include <random>

namespace tumble {

class Random {
public:
    /// Purpose of a stream. Each has its own, so that a palette added to a grid does not change its positions.
    enum class Purpose : std::uint64_t { position, rotation, size, color, cut };

    /// The stream of one body table of a scene with that seed.
    Random(std::uint64_t seed, std::uint64_t body, Purpose purpose);

    double unit();  // uniform in [0, 1), 53 bits
    double between(double low, double high);
    std::size_t index(std::size_t count);  // uniform in 0 .. count - 1
    Vec3 in_box(const Vec3& half);         // each component within +-half
    Vec3 direction();                      // uniform on the unit sphere
    Quat rotation();                       // uniform over all rotations (Marsaglia 1972)

private:
    std::mt19937_64 engine_;
};

}  // namespace tumble
