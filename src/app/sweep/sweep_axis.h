// An axis of a plan: a value that differs between samples, and the keys of the scene that it sets.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

namespace tumble {

// Random numbers of a plan's distributions: the same on every machine, and for each sample its own stream, so that
// further samples or axes leave the values of the others as they are.

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

/// Listed values, or values of a range, as TOML.
struct ValueList {
    std::vector<std::string> values;
};

enum class DistributionKind { uniform, log_uniform, normal, integer, choice };

/// Numbers are drawn for each component: one for a number, several for an array.
struct Distribution {
    DistributionKind kind = DistributionKind::uniform;
    bool array = false;                   // the value is an array of the components
    std::vector<double> min, max;         // of each component; of a normal one the bounds within which it is drawn
    std::vector<double> mean, deviation;  // normal
    std::vector<std::string> values;      // choice: as TOML
    std::vector<double> weights;          // choice: of each value
    std::optional<int> decimals;          // that a number is rounded to
};

using AxisSource = std::variant<ValueList, Distribution>;

struct SweepAxis {
    std::string name;                // in names of samples, in the manifest, and of its random numbers
    std::vector<std::string> paths;  // of the keys that get the value, as for --set
    AxisSource source;
    std::optional<std::uint64_t> seed;  // instead of the plan's

    bool is_list() const { return std::holds_alternative<ValueList>(source); }
    std::size_t list_size() const { return std::get<ValueList>(source).values.size(); }
};

/// A value of the distribution, as TOML.
std::string draw_value(const Distribution& distribution, DrawStream& stream);

/// A number as TOML, rounded to the decimals if they are given.
std::string rounded_number(double value, const std::optional<int>& decimals);

}  // namespace tumble
