// The drawing that the golden commands need. The command line implements it (app/cli/golden_command.cpp).
#pragma once

#include "app/golden/suite.h"

#include <filesystem>
#include <string>

namespace tumble {

/// How the drawing is divided; the images must not depend on it.
struct DrawingWork {
    int workers = 1;         // render processes
    int threads = 1;         // of the simulation
    bool neighbors = false;  // also draws the frame before each one
};

class CaseDrawer {
public:
    virtual ~CaseDrawer() = default;

    /// Loads the scenes. Text on which the images of a case depend, apart from the program. Throws InputError.
    virtual std::string identity(const GoldenCase& golden) const = 0;

    /// Draws the frames of a case as image_name(), and writes record_name(), into an existing folder. Precondition: the
    /// program has no other thread. Throws InputError, RunError.
    virtual void draw(const GoldenCase& golden, const std::filesystem::path& folder, const DrawingWork& work) const = 0;
};

}  // namespace tumble
