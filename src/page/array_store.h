// Arrays of numbers behind the JSON header of the clip data. Each array is stored by byte planes, the lowest bytes of
// all numbers first, because planes of the high bytes are nearly constant and compress to almost nothing.
#pragma once

#include <nlohmann/json.hpp>

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace tumble {

class ArrayStore {
public:
    using Json = nlohmann::ordered_json;

    /// Each returns the reference that the header has: [offset in bytes, count, kind].
    /// Kind 0: doubles. `bits`: of the mantissa that are kept, at most 52.
    Json add(std::span<const double> values, int bits = 52);
    /// Kind k > 0: integers of k bytes, zigzag coded: 0, -1, 1, -2, ... are 0, 1, 2, 3, ...
    Json add(std::span<const std::int64_t> values);

    const std::vector<std::byte>& bytes() const { return bytes_; }

private:
    Json add_planes(std::span<const std::uint64_t> values, int planes, int kind);

    std::vector<std::byte> bytes_;
};

/// Zigzag code of an integer.
constexpr std::uint64_t zigzag(std::int64_t value) { return std::uint64_t(value) << 1 ^ std::uint64_t(value >> 63); }

/// The double with the nearest mantissa of fewer bits.
double rounded_mantissa(double value, int bits);

}  // namespace tumble
