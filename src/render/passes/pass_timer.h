// Cost of the passes, for measurements: CPU time, with glFinish between the passes, because llvmpipe would otherwise do
// most of the work at the end. The measurement itself has a small cost.
#pragma once

#include "render/gl/gl_functions.h"

#include <array>
#include <cstddef>

namespace tumble {

enum class Pass { preparation, upload, shadow, background, bodies, planes, edges, read };
inline constexpr std::size_t pass_count = 8;
inline constexpr std::array<const char*, pass_count> pass_names = {"preparation", "upload", "shadow", "background",
                                                                   "bodies",      "planes", "edges",  "read"};

/// CPU seconds of the process, summed over all frames.
struct PassTimes {
    std::array<double, pass_count> seconds{};
};

/// Adds the time since the last pass ended. Without a target it does nothing and does not wait.
class PassTimer {
public:
    PassTimer(const GlFunctions& gl, PassTimes* times);
    void ends(Pass stage);

private:
    const GlFunctions* gl_;
    PassTimes* times_;
    double last_ = 0.0;
};

}  // namespace tumble
