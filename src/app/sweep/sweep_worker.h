// A process that makes samples, one after the other, with an OpenGL context of its own.
#pragma once

#include "app/sweep/sweep_plan.h"
#include "app/workers/worker_process.h"

#include <array>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <span>
#include <string>

namespace tumble {

struct SampleJob {
    std::int64_t index = 0;
    bool anew = false;  // even if its files are there
};

struct SampleReply {
    enum class Outcome { made, kept, failed };

    std::int64_t index = 0;
    Outcome outcome = Outcome::made;
    std::array<char, 8192> reason{};  // of a failure
};

/// The sweep, as a worker knows it.
struct SweepTask {
    const SweepPlan& plan;
    const std::string& scene;  // text of the plan's scene
    std::filesystem::path folder;
};

class SweepWorker {
public:
    /// Forks as a WorkerProcess does.
    SweepWorker(const SweepTask& task, std::span<const int> other_sockets);

    int socket() const { return process_.socket(); }
    /// Precondition: it has no job.
    void give(const SampleJob& job);
    const std::optional<SampleJob>& job() const { return job_; }
    /// Call it when the socket can be read. If the process has died, a failure with its end; it is then of no more use.
    SampleReply receive();
    bool alive() const { return process_.alive(); }

    /// Ends a process without a job.
    void finish() { process_.finish(); }

private:
    WorkerProcess process_;
    std::optional<SampleJob> job_;
};

}  // namespace tumble
