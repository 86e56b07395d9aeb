#include "app/cli/command.h"
#include "app/cli/progress.h"
#include "app/cli/say.h"
#include "app/cli/shared_options.h"
#include "app/files/output_plan.h"
#include "app/sweep/manifest.h"
#include "app/sweep/sample_folder.h"
#include "app/sweep/sample_maker.h"
#include "app/sweep/sweep_plan.h"
#include "app/sweep/sweep_run.h"
#include "app/threads/stage_timer.h"
#include "core/error.h"
#include "core/safe_text.h"
#include "scene/load.h"

#include <fmt/format.h>

#include <sys/resource.h>

#include <algorithm>
#include <charconv>
#include <filesystem>
#include <set>
#include <string>
#include <string_view>

namespace tumble {
namespace {

struct SweepCommand {
    std::filesystem::path plan;
    std::optional<std::filesystem::path> folder;
    std::vector<std::string> set;    // "PATH=VALUE", for all samples
    std::vector<std::int64_t> only;  // samples to make again
    int workers = 1;                 // processes
    bool dry_run = false;            // prints the plan's size and first samples
    bool stop = false;               // at the first sample that fails
    bool quiet = false;
};

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

/// Folders between the sweep's folder and the samples' folders.
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

/// "3,17,20-23" to numbers.
std::vector<std::int64_t> read_indices(std::string_view text) {
    std::vector<std::int64_t> indices;
    const auto fail = [&] {
        throw InputError(
            fmt::format("--only: must be indices of samples, as in 3,17,20-23 (given '{}')", safe_text(text)));
    };
    const char* at = text.data();
    const char* const end = text.data() + text.size();
    const auto number = [&] {
        std::int64_t value = 0;
        const auto [next, error] = std::from_chars(at, end, value);
        if (error != std::errc() || value < 0) fail();
        at = next;
        return value;
    };
    constexpr std::int64_t most = 1'000'000;  // indices of a range
    for (;;) {
        const std::int64_t first = number();
        std::int64_t last = first;
        if (at != end && *at == '-') ++at, last = number();
        if (last < first || last - first >= most) fail();
        for (std::int64_t i = first; i <= last; ++i) indices.push_back(i);
        if (at == end) return indices;
        if (*at++ != ',') fail();
    }
}

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

}  // namespace

void add_sweep(Command& command) {
    SweepCommand& c = command.keep<SweepCommand>();
    command.add_option("plan", c.plan, "The plan (TOML; docs/reference/sweep-plan.md)")
        ->check(file_name("toml"))
        ->required()
        ->type_name("PLAN");
    command
        .add_option("-o,--output", c.folder,
                    "The folder of the samples and their manifest.jsonl. Samples that are there are kept, so\n"
                    "that the same command goes on after an interruption, or with a longer plan")
        ->check(folder_name())
        ->type_name("DIR");
    command.add_flag("--dry-run", c.dry_run, "Print the size of the plan and its first samples, and write nothing");
    command
        .add_option_function<std::string>(
            "--only", [&c](const std::string& text) { c.only = read_indices(text); },
            "Make these samples again, as in 3,17,20-23, and no others")
        ->type_name("INDICES");
    command.add_flag("--stop", c.stop, "Stop at the first sample that fails; without this the others are made");
    command
        .add_option("--set", c.set,
                    "Any key of the scene by its path, for all samples, as in simulation.duration=2; may be\nrepeated")
        ->take_all()
        ->allow_extra_args(false)
        ->type_name("PATH=VALUE");
    add_workers(command, c.workers, "Processes, one per core; the result is the same for any number", most_threads);
    command.add_flag("--quiet", c.quiet, "Print errors only");
    command.examples =
        "  tumble sweep plan.toml --dry-run                  how many samples, and which\n"
        "  tumble sweep plan.toml -o data                    writes data/000000 ... and data/manifest.jsonl\n"
        "  tumble sweep plan.toml -o data --only 17          makes one sample again";
    command.logs = true;
    command.run = [&c] { return run_sweep(c); };
}

}  // namespace tumble
