// Takes drawn images as references.
#pragma once

#include "app/golden/draw_cases.h"
#include "app/golden/suite.h"

#include <optional>
#include <span>
#include <string>
#include <vector>

namespace tumble {

struct AcceptOptions {
    std::optional<std::string> platform;  // its folder gets the references; empty: the general one
    bool even_alike = false;              // also replaces references within the tolerances
    int jobs = 1;                         // cases at a time
};

struct AcceptedImage {
    enum class What { made, replaced, kept_same, kept_alike, refused, broken };
    std::string name;
    What what = What::made;
    std::string reason;  // of a refused or broken one
};

/// Draws each case twice, divided into other processes and threads, and compares the two. Images that are the same
/// pixel by pixel become references. A case with another image is refused as a whole; one that cannot be drawn is
/// broken. All references get their names together. Throws InputError if one would not be below the suite's folder
/// (references.h), RunError if one cannot be written, or after an interrupt.
std::vector<AcceptedImage> accept_cases(const GoldenSuite& suite, std::span<const GoldenCase* const> cases,
                                        const CaseDrawer& drawer, const AcceptOptions& options, Interrupt& interrupt);

}  // namespace tumble
