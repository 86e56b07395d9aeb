// Working time of the stages of a run: seconds between taking up a piece of work and finishing it, without waiting.
#pragma once

#include <atomic>
#include <cstdint>

namespace tumble {

// The clock of times and traces.

/// Seconds of a monotonic clock, the same in all processes of the machine.
double wall_seconds();
/// Seconds of processor time of the calling thread.
double thread_seconds();

class Trace;

/// A piece of work, s.
struct WorkTime {
    double start = 0.0;  // of wall_seconds()
    double wall = 0.0, cpu = 0.0;
};

/// Sums of one stage over all its threads, s. `cpu` excludes threads that a library starts.
struct StageTime {
    const char* name = "";
    std::atomic<double> wall{0.0}, cpu{0.0};
    Trace* trace = nullptr;  // of each piece of work, if asked for

    void add(const WorkTime& work, std::int64_t frame = -1);
};

/// Adds its own lifetime to the time of a stage.
class StageTimer {
public:
    explicit StageTimer(StageTime& stage, std::int64_t frame = -1);
    ~StageTimer();
    StageTimer(const StageTimer&) = delete;
    StageTimer& operator=(const StageTimer&) = delete;

private:
    StageTime& stage_;
    std::int64_t frame_;
    double wall_start_, cpu_start_;
};

}  // namespace tumble
