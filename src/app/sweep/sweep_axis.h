// An axis of a plan: a value that differs between samples, and the keys of the scene that it sets.
#pragma once

#include "app/sweep/draw_stream.h"

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <variant>
#include <vector>

namespace tumble {

/// Listed values, or those of a range, as TOML.
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
    std::optional<std::uint64_t> seed;  // in place of the plan's

    bool is_list() const { return std::holds_alternative<ValueList>(source); }
    std::size_t list_size() const { return std::get<ValueList>(source).values.size(); }
};

/// A value of the distribution, as TOML.
std::string draw_value(const Distribution& distribution, DrawStream& stream);

/// A number as TOML, rounded to the decimals if they are given.
std::string rounded_number(double value, const std::optional<int>& decimals);

}  // namespace tumble
