#include "app/threads/stage_timer.h"

#include "app/threads/trace.h"

namespace tumble {

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
