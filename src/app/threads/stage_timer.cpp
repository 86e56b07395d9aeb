#include "app/threads/stage_timer.h"

#include "app/threads/trace.h"

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
double thread_seconds() { return seconds_of(CLOCK_THREAD_CPUTIME_ID); }

void StageTime::add(const WorkTime& work, std::int64_t frame) {
    wall.fetch_add(work.wall, std::memory_order_relaxed);
    cpu.fetch_add(work.cpu, std::memory_order_relaxed);
    if (trace != nullptr && work.wall > 0.0) trace->add({name, work.start, work.start + work.wall, frame});
}

StageTimer::StageTimer(StageTime& stage, std::int64_t frame)
    : stage_(stage), frame_(frame), wall_start_(wall_seconds()), cpu_start_(thread_seconds()) {}

StageTimer::~StageTimer() {
    stage_.add({wall_start_, wall_seconds() - wall_start_, thread_seconds() - cpu_start_}, frame_);
}

}  // namespace tumble
