// A process that makes samples, one after the other, with an OpenGL context of its own.
#pragma once

#include "app/sweep/sweep_plan.h"
#include "output/process.h"

#include <sys/types.h>

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
    /// Forks; the child closes the sockets of the workers that were started before it. Precondition: the program has no
    /// other thread, and no OpenGL context. Throws RunError.
    SweepWorker(const SweepTask& task, std::span<const int> other_sockets);
    /// Ends the process in any state.
    ~SweepWorker();
    SweepWorker(const SweepWorker&) = delete;
    SweepWorker& operator=(const SweepWorker&) = delete;

    int socket() const { return socket_; }
    /// Precondition: it has no job.
    void give(const SampleJob& job);
    const std::optional<SampleJob>& job() const { return job_; }
    /// Call it when the socket can be read. If the process has died, a failure with its end; it is then of no more use.
    SampleReply receive();
    bool alive() const { return id_ >= 0; }

    /// Ends a process without a job.
    void finish();

private:
    pid_t id_ = -1;
    int socket_ = -1;
    std::optional<SampleJob> job_;
};

}  // namespace tumble
