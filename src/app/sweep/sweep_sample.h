// The samples of a plan: each one's values, from its index alone.
#pragma once

#include "app/sweep/sweep_plan.h"

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace tumble {

/// One of the two samples of a pair.
struct PairSide {
    std::int64_t pair = 0;
    char side = 'A';      // or 'B'
    std::string differs;  // name of the axis
};

struct SweepSample {
    std::int64_t index = 0;
    std::vector<std::string> values;  // of the axes in order, as TOML
    std::optional<PairSide> pair;
    std::string name;  // of its folder, relative

    /// "friction = 0.4, mass = 2.0", for messages.
    std::string text(const SweepPlan& plan) const;
    /// The fixed values and the values of the axes, as "PATH=VALUE".
    std::vector<std::string> assignments(const SweepPlan& plan) const;
};

/// Throws InputError where a pair finds no second value.
SweepSample sample_of(const SweepPlan& plan, std::int64_t index);

// -- Names of the folders of samples: a text with fields in braces, as in "train/{index:06}_{friction}".

/// Throws InputError where the template is no relative path of a folder, or has an unknown field.
void check_name_template(const SweepPlan& plan);

/// The folder of the sample, whose values must be there. Characters of values other than letters, digits, '.', '+' and
/// '-' become '_'.
std::string name_of_sample(const SweepPlan& plan, const SweepSample& sample);

/// True if the fields tell any two samples apart.
bool names_each_index(const SweepPlan& plan);

}  // namespace tumble
