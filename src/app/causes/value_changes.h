// Differences of described values.
#pragma once

#include "app/causes/motion_record.h"

#include <string>
#include <vector>

namespace tumble {

struct ValueDifference {
    std::string key, before, after;  // empty: the value is missing
};

std::vector<ValueDifference> value_differences(const ValueMap& before, const ValueMap& after);

/// "0.5 to 0.8"; "changed" for values that cannot be shown.
std::string value_change_text(const std::string& before, const std::string& after);

}  // namespace tumble
