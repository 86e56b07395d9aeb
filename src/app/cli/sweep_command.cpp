#include "app/cli/commands.h"
#include "app/cli/progress.h"
#include "app/cli/say.h"
#include "app/files/output_plan.h"
#include "app/sweep/manifest.h"
#include "app/sweep/read_plan.h"
#include "app/sweep/sample_folder.h"
#include "app/sweep/sample_maker.h"
#include "app/sweep/sweep_run.h"
#include "app/threads/stage_timer.h"
#include "core/error.h"
#include "core/safe_text.h"
#include "scene/load.h"

#include <fmt/format.h>

#include <sys/resource.h>

#include <algorithm>
#include <filesystem>
#include <set>
#include <string>

namespace tumble {
namespace {

constexpr std::int64_t shown_samples = 6, shown_failures = 20;

std::string named(const SweepPlan& plan, const SweepSample& sample) {
    std::string text = fmt::format("sample {}", sample.index);
    if (sample.name.find(fmt::format("{:06}", sample.index)) == std::string::npos)
        text += fmt::format(" ({})", safe_text(sample.name));
    if (sample.pair)
        text += fmt::format(" [{} of pair {}, {} differs]", sample.pair->side, sample.pair->pair,
                            safe_text(sample.pair->differs));
    return plan.axes.empty() ? text : fmt::format("{}: {}", text, sample.text(plan));
}

std::string axis_text(const SweepAxis& axis) {
    if (axis.is_list()) return fmt::format("{} values", axis.list_size());
    constexpr const char* names[] = {"uniform", "log-uniform", "normal", "integer", "choice"};
    return names[std::size_t(std::get<Distribution>(axis.source).kind)];
}

void print_plan(const SweepPlan& plan) {
    put("{}: {} samples of {}\n", safe_path(plan.file), plan.samples, safe_path(plan.scene));
    for (const SweepAxis& axis : plan.axes) put("  {}: {}\n", safe_text(axis.name), axis_text(axis));
    if (plan.combinations() > 1) put("  {} combinations of listed values\n", plan.combinations());
    for (std::int64_t i = 0; i < std::min(plan.samples, shown_samples); ++i)
        put("{}\n", named(plan, sample_of(plan, i)));
    if (plan.samples > shown_samples) put("...\n");
}

double cpu_seconds() {
    double seconds = 0.0;
    for (const int who : {RUSAGE_SELF, RUSAGE_CHILDREN}) {
        rusage used{};
        getrusage(who, &used);
        for (const timeval& t : {used.ru_utime, used.ru_stime}) seconds += double(t.tv_sec) + 1e-6 * double(t.tv_usec);
    }
    return seconds;
}

void print_result(const SweepCounts& counts, const std::filesystem::path& folder, double seconds) {
    std::string text = fmt::format("wrote {}: {} samples made", safe_path(ManifestFile::path_in(folder)), counts.made);
    if (counts.kept > 0) text += fmt::format(", {} kept", counts.kept);
    if (counts.failed > 0) text += fmt::format(", {} failed", counts.failed);
    text += fmt::format("; {:.2f} s", seconds);
    if (counts.made > 0)
        text += fmt::format(", {:.1f} samples/s; CPU {:.3f} s a sample", double(counts.made) / seconds,
                            cpu_seconds() / double(counts.made));
    say("{}\n", text);
}

/// Folders above those of the samples, below that of the sweep.
std::set<std::filesystem::path> inner_folders(const SweepPlan& plan) {
    std::set<std::filesystem::path> folders;
    if (plan.name.find('/') == std::string::npos) return folders;
    for (std::int64_t i = 0; i < plan.samples; ++i)
        folders.insert(std::filesystem::path(sample_of(plan, i).name).parent_path());
    return folders;
}

/// Throws InputError if a sample or the manifest would replace a file that is read, or would not be below the folder.
void plan_outputs(const SweepPlan& plan, const std::filesystem::path& folder) {
    FileList read{plan.file, plan.scene};
    try {
        load_scene(plan.scene, {}, &read);
    } catch (const InputError&) {
        // The scene may need the values of the samples.
    }
    OutputPlan outputs;
    outputs.add_inputs(read);
    outputs.add_below("-o", folder, ManifestFile::path_in({}));
    for (const std::filesystem::path& inner : inner_folders(plan)) confined_path(folder, inner / record_name);
    const std::filesystem::path hidden = SampleMaker::hidden_folder({});
    outputs.add_replaced_folders("-o", folder, [&](const std::filesystem::path& inner) {
        std::error_code error;
        return inner.filename() == hidden || std::filesystem::exists(inner / record_name, error);
    });
}

}  // namespace

int run_sweep(const SweepCommand& command) {
    const double start = wall_seconds();
    SweepPlan plan = read_plan(command.plan);
    plan.fixed.insert(plan.fixed.end(), command.set.begin(), command.set.end());
    for (const std::int64_t index : command.only)
        if (index >= plan.samples)
            throw InputError(fmt::format("--only: the plan has {} samples, with indices from 0 ({} was given)",
                                         plan.samples, index));
    if (!command.dry_run && !command.folder)
        throw InputError("sweep: needs -o with the folder of the samples, or --dry-run");
    const std::string scene = read_scene_text(plan.scene);
    SweepOptions options;
    options.workers = check_sweep(plan, scene, command.workers);
    if (command.dry_run) {
        print_plan(plan);
        return 0;
    }
    plan_outputs(plan, *command.folder);
    options.folder = *command.folder;
    options.stop_at_first = command.stop;
    options.only = command.only;
    SweepCounts counts;
    {
        Progress progress(command.only.empty() ? plan.samples : std::int64_t(command.only.size()), command.quiet,
                          "samples");
        std::int64_t failures = 0;
        counts = run_sweep(plan, scene, options,
                           {[&](const SweepSample& sample, const std::string& reason) {
                                if (++failures <= shown_failures)
                                    say("error: {}: {}\n", named(plan, sample), safe_lines(reason));
                                if (failures == shown_failures + 1)
                                    say("error: more samples fail: manifest.jsonl has all of them\n");
                            },
                            [&](std::int64_t done) { progress.update(done); }});
    }
    if (!command.quiet) print_result(counts, options.folder, wall_seconds() - start);
    return counts.failed > 0 ? 1 : 0;
}

}  // namespace tumble
