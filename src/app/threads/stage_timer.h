// Working time of the stages of a run: seconds between taking up a piece of work and finishing it, without waiting.
#pragma once

#include <atomic>

namespace tumble {

/// Sums of one stage over all its threads, s. `cpu` excludes threads that a library starts.
struct StageTime {
    std::atomic<double> wall{0.0}, cpu{0.0};

    void add(double wall_seconds, double cpu_seconds) {
        wall.fetch_add(wall_seconds, std::memory_order_relaxed);
        cpu.fetch_add(cpu_seconds, std::memory_order_relaxed);
    }
};

/// Seconds of a monotonic clock.
double wall_seconds();

/// Adds its own lifetime to the time of a stage.
class StageTimer {
public:
    explicit StageTimer(StageTime& stage);
    ~StageTimer();
    StageTimer(const StageTimer&) = delete;
    StageTimer& operator=(const StageTimer&) = delete;

private:
    StageTime& stage_;
    double wall_start_, cpu_start_;
};

}  // namespace tumble
