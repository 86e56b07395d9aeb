// Random numbers of a plan's distributions: the same on every machine, and for each sample its own stream, so that
// further samples or axes leave the values of the others as they are.
#pragma once

#include <cstdint>
#include <string_view>

namespace tumble {

class DrawStream {
public:
    /// The stream of the axis of that name in one draw of the plan.
    DrawStream(std::uint64_t seed, std::string_view axis, std::uint64_t draw);

    double unit();                            // uniform in [0, 1), 53 bits
    double between(double low, double high);  // uniform, within the bounds
    double normal();                          // of mean 0 and deviation 1
    std::int64_t index(std::int64_t count);   // uniform in 0 .. count - 1

private:
    std::uint64_t next();

    std::uint64_t state_;
};

}  // namespace tumble
