#include "render/passes/pass_timer.h"

#include <ctime>

namespace tumble {
namespace {

double cpu_seconds() {
    timespec now{};
    clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now);
    return double(now.tv_sec) + 1e-9 * double(now.tv_nsec);
}

}  // namespace

PassTimer::PassTimer(const GlFunctions& gl, PassTimes* times) : gl_(&gl), times_(times) {
    if (times_ != nullptr) last_ = cpu_seconds();
}

void PassTimer::ends(Pass stage) {
    if (times_ == nullptr) return;
    gl_->Finish();
    const double now = cpu_seconds();
    times_->seconds[std::size_t(stage)] += now - last_;
    last_ = now;
}

}  // namespace tumble
