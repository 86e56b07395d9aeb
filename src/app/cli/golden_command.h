// Parameters and entry points of `tumble golden`.
#pragma once

#include "app/golden/suite_edit.h"

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace tumble {

struct GoldenCommand {
    std::filesystem::path suite;
    std::vector<std::string> cases;                            // by name; empty: all
    bool all = false;                                          // accept: all cases
    bool even_alike = false;                                   // accept: also within the tolerances
    bool force = false;                                        // check: ignores images of the cache
    std::optional<std::filesystem::path> cache;                // folder
    std::optional<std::filesystem::path> report, json, junit;  // check: to write
    std::optional<std::filesystem::path> failures;             // check: folder for images that differ
    std::optional<std::string> platform;                       // of the references; "none": the general ones alone
    NewCase added;                                             // add
    int jobs = 1;                                              // cases at a time
    bool quiet = false;
};

/// Returns 0 if all images are alike, 1 if one differs, 2 if one cannot be drawn or compared, 3 if a reference is
/// missing.
int run_golden_check(const GoldenCommand& command);
/// Both return 0, 1 if an image is refused, 2 if a case cannot be drawn.
int run_golden_accept(const GoldenCommand& command);
int run_golden_add(const GoldenCommand& command);

}  // namespace tumble
