#include "app/threads/stage_timer.h"

#include <time.h>

namespace tumble {
namespace {

double seconds_of(clockid_t clock) {
    timespec t{};
    clock_gettime(clock, &t);
    return double(t.tv_sec) + 1e-9 * double(t.tv_nsec);
}

}  // namespace

double wall_seconds() { return seconds_of(CLOCK_MONOTONIC); }

StageTimer::StageTimer(StageTime& stage)
    : stage_(stage), wall_start_(wall_seconds()), cpu_start_(seconds_of(CLOCK_THREAD_CPUTIME_ID)) {}

StageTimer::~StageTimer() {
    stage_.add(wall_seconds() - wall_start_, seconds_of(CLOCK_THREAD_CPUTIME_ID) - cpu_start_);
}

}  // namespace tumble
