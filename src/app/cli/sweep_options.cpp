#include "app/cli/command_line.h"
#include "app/cli/options.h"
#include "core/error.h"

#include <charconv>
#include <string_view>

namespace tumble {
namespace {

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

}  // namespace

CLI::App* add_sweep(CLI::App& app, CommandLine& line) {
    SweepCommand& c = line.sweep;
    CLI::App* command = app.add_subcommand("sweep", "Make many samples of one scene, with other values in each");
    command->add_option("plan", c.plan, "The plan (TOML; docs/reference/sweep-plan.md)")
        ->check(some_name())
        ->required()
        ->type_name("PLAN");
    command
        ->add_option("-o,--output", c.folder,
                     "The folder of the samples and their manifest.jsonl. Samples that are there are kept, so\n"
                     "that the same command goes on after an interruption, or with a longer plan")
        ->check(some_name())
        ->type_name("DIR");
    command->add_flag("--dry-run", c.dry_run, "Print the size of the plan and its first samples, and write nothing");
    command
        ->add_option_function<std::string>(
            "--only", [&c](const std::string& text) { c.only = read_indices(text); },
            "Make these samples again, as in 3,17,20-23, and no others")
        ->type_name("INDICES");
    command->add_flag("--stop", c.stop, "Stop at the first sample that fails; without this the others are made");
    command
        ->add_option("--set", c.set,
                     "Any key of the scene by its path, for all samples, as in simulation.duration=2; may be\nrepeated")
        ->take_all()
        ->allow_extra_args(false)
        ->type_name("PATH=VALUE");
    c.workers = machine_threads();
    command->add_option("--workers", c.workers, "Processes, one per core; the result is the same for any number")
        ->check(CLI::Range(1, most_threads))
        ->option_text(fmt::format("N [{}]", c.workers));
    command->add_flag("--quiet", c.quiet, "Print errors only");
    command->footer(
        "Examples:\n"
        "  tumble sweep plan.toml --dry-run                  how many samples, and which\n"
        "  tumble sweep plan.toml -o data                    writes data/000000 ... and data/manifest.jsonl\n"
        "  tumble sweep plan.toml -o data --only 17          makes one sample again");
    return command;
}

}  // namespace tumble
