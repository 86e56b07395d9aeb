// Compares drawn cases with the references of their suite.
#pragma once

#include "app/golden/draw_cases.h"
#include "app/golden/suite.h"
#include "compare/comparison.h"

#include <optional>
#include <span>
#include <string>
#include <vector>

namespace tumble {

struct CheckOptions {
    std::optional<std::string> platform;  // of the references; empty: this machine's; "none": general ones alone
    int workers = 1;                      // pairs at a time
};

/// A result for each image of the cases, in their order, with the causes of differences. An image without a reference
/// is `missing`, a case that could not be drawn is `broken`.
SetResult check_cases(const GoldenSuite& suite, std::span<const DrawnCase> drawn, const CheckOptions& options,
                      Interrupt& interrupt);

/// References and records in the suite's folder that belong to no case, by name.
std::vector<std::string> references_of_no_case(const GoldenSuite& suite);

}  // namespace tumble
