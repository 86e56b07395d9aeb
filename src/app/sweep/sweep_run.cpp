#include "app/sweep/sweep_run.h"

#include "app/files/frame_folder.h"
#include "app/sweep/manifest.h"
#include "app/sweep/sample_clip.h"
#include "app/sweep/sample_maker.h"
#include "app/sweep/sweep_worker.h"
#include "app/threads/interrupt.h"
#include "app/workers/frame_memory.h"
#include "core/error.h"
#include "output/output_path.h"
#include "output/video_writer.h"

#include <fmt/format.h>

#include <fcntl.h>
#include <poll.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <memory>
#include <optional>
#include <system_error>
#include <thread>
#include <utility>

namespace tumble {
namespace {

namespace fs = std::filesystem;

constexpr std::int64_t first_samples = 8;  // that are loaded before the run: one of them must be right
constexpr int poll_period = 50;            // ms between checks for Ctrl-C
constexpr std::chrono::seconds longest_end_of_workers{3};

/// The samples to make, in order.
class Jobs {
public:
    Jobs(const SweepPlan& plan, const SweepOptions& options) : only_(options.only), end_(plan.samples) {
        if (!only_.empty()) end_ = std::int64_t(only_.size());
    }

    std::optional<SampleJob> take() {
        if (next_ == end_) return std::nullopt;
        const std::int64_t number = next_++;
        return only_.empty() ? SampleJob{number, false} : SampleJob{only_[std::size_t(number)], true};
    }

private:
    std::vector<std::int64_t> only_;
    std::int64_t end_, next_ = 0;
};

class SweepPool {
public:
    SweepPool(const SweepTask& task, const SweepOptions& options, const SweepReports& reports, ManifestFile& manifest)
        : task_(task), options_(options), reports_(reports), manifest_(manifest), jobs_(task.plan, options) {}

    SweepCounts run(Interrupt& interrupt) {
        for (int i = 0; i < options_.workers; ++i) {
            const std::optional<SampleJob> job = jobs_.take();
            if (!job) break;
            start_worker().give(*job);
        }
        while (working()) {
            for (const std::size_t ready : wait()) take_reply(ready);
            reports_.progress(counts_.done());
            if (interrupt.pending()) interrupted_ = true;
            if (interrupted_) break;
        }
        if (!interrupted_ && !failure_)
            for (const auto& worker : workers_) worker->finish();
        workers_.clear();
        return counts_;
    }

    bool interrupted() const { return interrupted_; }
    /// The first one, if the sweep had to stop there.
    const std::optional<std::string>& failure() const { return failure_; }

private:
    SweepWorker& start_worker() {
        std::vector<int> sockets;
        for (const auto& worker : workers_) sockets.push_back(worker->socket());
        workers_.push_back(std::make_unique<SweepWorker>(task_, sockets));
        return *workers_.back();
    }

    bool working() const {
        return !failure_ && std::any_of(workers_.begin(), workers_.end(), [](const auto& w) { return w->job(); });
    }

    /// Workers with a reply.
    std::vector<std::size_t> wait() const {
        std::vector<pollfd> polled;
        for (const auto& worker : workers_) polled.push_back({worker->job() ? worker->socket() : -1, POLLIN, 0});
        std::vector<std::size_t> ready;
        if (::poll(polled.data(), polled.size(), poll_period) <= 0) return ready;
        for (std::size_t i = 0; i < polled.size(); ++i)
            if (polled[i].revents != 0) ready.push_back(i);
        return ready;
    }

    void take_reply(std::size_t which) {
        const SampleReply reply = workers_[which]->receive();
        const SweepSample sample = sample_of(task_.plan, reply.index);
        std::string reason = reply.reason.data();
        std::string line;
        if (reply.outcome != SampleReply::Outcome::failed) {
            const auto record = read_sample_record(task_.folder / sample.name);
            if (record) line = record->text;
            if (!record) reason = "its files have disappeared";
        }
        if (line.empty()) {
            line = failure_text(task_.plan, sample, reason);
            ++counts_.failed;
            reports_.failure(sample, reason);
            if (options_.stop_at_first) failure_ = reason;
        } else {
            ++(reply.outcome == SampleReply::Outcome::made ? counts_.made : counts_.kept);
        }
        manifest_.add(reply.index, std::move(line));
        if (failure_) return;
        const std::optional<SampleJob> job = jobs_.take();
        if (!workers_[which]->alive()) {
            workers_.erase(workers_.begin() + std::ptrdiff_t(which));
            if (job) start_worker().give(*job);
        } else if (job) {
            workers_[which]->give(*job);
        }
    }

    const SweepTask& task_;
    const SweepOptions& options_;
    const SweepReports& reports_;
    ManifestFile& manifest_;
    Jobs jobs_;
    std::vector<std::unique_ptr<SweepWorker>> workers_;
    SweepCounts counts_;
    bool interrupted_ = false;
    std::optional<std::string> failure_;
};

/// The workers of a killed sweep hold its folder until the system has ended them.
std::unique_ptr<FolderLock> lock_folder(const fs::path& folder) {
    const auto end = std::chrono::steady_clock::now() + longest_end_of_workers;
    for (;;) {
        try {
            return std::make_unique<FolderLock>(folder, LockKind::alone);
        } catch (const RunError&) {
            if (std::chrono::steady_clock::now() > end) throw;
        }
        std::this_thread::sleep_for(std::chrono::milliseconds(poll_period));
    }
}

/// Brings all files of the folder's file system to the disk.
void bring_all_to_disk(const fs::path& folder) {
    const int file = ::open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
    if (file < 0) return;
    ::syncfs(file);
    ::close(file);
}

void check_outputs_of(const SweepPlan& plan, const RenderScenes& scenes) {
    const FrameOutputs outputs = frame_outputs(plan, scenes);
    if (outputs.video) find_ffmpeg();
}

/// The reason without the option that a value would have on a command line.
std::string reason_in_plan(const std::exception& error) {
    constexpr std::string_view option = "--set ";
    std::string reason = reason_of(error.what());
    return reason.starts_with(option) ? reason.substr(option.size()) : reason;
}

int workers_for(const SweepPlan& plan, const RenderScenes& scenes, int workers) {
    RenderWork work{frame_outputs(plan, scenes), std::nullopt, scenes.frames.count(),
                    shutter_of(plan.drawing).blur_samples};
    if (work.outputs.video)
        work.clip = video_format(plan.outputs.clip, scenes.first().output.fps, plan.drawing.transparent).kind;
    return workers_that_fit(scenes.composition, work, workers);
}

}  // namespace

int check_sweep(const SweepPlan& plan, const std::string& scene, int workers) {
    const SampleMaker maker(plan, scene, {});
    std::optional<InputError> first;
    const std::int64_t count = std::min(plan.samples, first_samples);
    for (std::int64_t i = 0; i < count; ++i) {
        const SweepSample sample = sample_of(plan, i);
        try {
            const RenderScenes scenes = maker.load(sample);
            check_outputs_of(plan, scenes);
            return workers_for(plan, scenes, int(std::min<std::int64_t>(workers, plan.samples)));
        } catch (const InputError& error) {
            if (!first)
                first.emplace(
                    SourceLocation{plan.file.string(), 0, 0},
                    fmt::format(
                        "{} can be made; sample 0{}: {}",
                        count == plan.samples ? "no sample" : fmt::format("none of the first {} samples", count),
                        plan.axes.empty() ? "" : fmt::format(" ({})", sample.text(plan)), reason_in_plan(error)));
        }
    }
    throw *first;
}

SweepCounts run_sweep(const SweepPlan& plan, const std::string& scene, const SweepOptions& options,
                      const SweepReports& reports) {
    make_folder(options.folder);
    Interrupt interrupt;  // before any process is made
    const std::unique_ptr<FolderLock> lock = lock_folder(options.folder);
    const fs::path hidden = SampleMaker::hidden_folder(options.folder);
    std::error_code ignored;
    fs::remove_all(hidden, ignored);  // of a killed sweep
    ManifestFile manifest(options.folder);
    if (!options.only.empty())
        for (auto& [index, line] : read_sweep_manifest(options.folder))
            if (std::find(options.only.begin(), options.only.end(), index) == options.only.end())
                manifest.add(index, std::move(line));
    const SweepTask task{plan, scene, options.folder};
    SweepPool pool(task, options, reports, manifest);
    const SweepCounts counts = pool.run(interrupt);
    fs::remove_all(hidden, ignored);
    bring_all_to_disk(options.folder);
    manifest.finish();
    if (pool.interrupted())
        throw RunError(fmt::format("interrupted after {} of {} samples; the same command goes on from there",
                                   counts.done(), plan.samples));
    if (pool.failure()) throw RunError("stopped at the first failure (--stop)");
    return counts;
}

}  // namespace tumble
