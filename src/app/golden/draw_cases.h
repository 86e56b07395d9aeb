// Draws cases, several at a time. A case whose images are all in the cache is not drawn.
#pragma once

#include "app/golden/child_tasks.h"
#include "app/golden/image_cache.h"
#include "app/golden/suite.h"

#include <filesystem>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace tumble {

/// How the drawing is divided; the images must not depend on it.
struct DrawingWork {
    int workers = 1;         // render processes
    int threads = 1;         // of the simulation
    bool neighbors = false;  // also draws the frame before each one
};

/// The drawing that the golden commands need. The command line implements it (app/cli/golden_command.cpp).
class CaseDrawer {
public:
    virtual ~CaseDrawer() = default;

    /// Loads the scenes. Text on which the images of a case depend, apart from the program. Throws InputError.
    virtual std::string identity(const GoldenCase& golden) const = 0;

    /// Draws the frames of a case as image_name(), and writes record_name(), into an existing folder. Precondition: the
    /// program has no other thread. Throws InputError, RunError.
    virtual void draw(const GoldenCase& golden, const std::filesystem::path& folder, const DrawingWork& work) const = 0;
};

struct DrawnCase {
    const GoldenCase* golden = nullptr;
    std::filesystem::path folder;  // of the images and the record
    bool drawn = false;            // in this run; otherwise its images were in the cache
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
