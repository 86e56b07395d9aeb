// Draws cases, several at a time. A case whose images are all in the cache is not drawn.
#pragma once

#include "app/golden/child_tasks.h"
#include "app/golden/drawer.h"
#include "app/golden/image_cache.h"

#include <filesystem>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace tumble {

struct DrawnCase {
    const GoldenCase* golden = nullptr;
    std::filesystem::path folder;  // of the images and the record
    bool drawn = false;            // in this run; else its images were in the cache
    double seconds = 0.0;          // of the drawing
    std::string error;             // of a case that cannot be drawn
};

struct DrawCasesOptions {
    bool force = false;                            // ignores images of the cache
    int jobs = 1;                                  // cases at a time
    std::optional<DrawingWork> work;               // of each case; empty: by the jobs
    std::string identity;                          // of the program (program_identity.h)
    std::function<void(const DrawnCase&)> report;  // at the end of each case, in any order; may be empty
};

/// Draws all cases, in the order of the list. An error of a case ends that case only. Throws RunError after an
/// interrupt, or if the cache cannot be written.
std::vector<DrawnCase> draw_cases(std::span<const GoldenCase* const> cases, const CaseDrawer& drawer,
                                  const ImageCache& cache, const DrawCasesOptions& options, Interrupt& interrupt);

}  // namespace tumble
