#include "app/cli/golden_command.h"

#include "app/cli/compare_summary.h"
#include "app/cli/golden_drawing.h"
#include "app/cli/progress.h"
#include "app/cli/say.h"
#include "app/files/output_plan.h"
#include "app/golden/accept.h"
#include "app/golden/check.h"
#include "app/golden/program_identity.h"
#include "app/golden/references.h"
#include "app/threads/interrupt.h"
#include "compare/comparison_text.h"
#include "compare/difference_image.h"
#include "compare/platform.h"
#include "compare/report/comparison_report.h"
#include "core/error.h"
#include "core/safe_text.h"
#include "output/file_bytes.h"
#include "output/file_transaction.h"
#include "output/make_folder.h"
#include "output/temporary_file.h"
#include "output/temporary_folder.h"
#include "scene/toml/error_text.h"

#include <fmt/format.h>

#include <algorithm>
#include <system_error>

namespace tumble {
namespace {

namespace fs = std::filesystem;

/// The named cases in the order of the suite; all of them if none is named.
std::vector<const GoldenCase*> chosen_cases(const GoldenSuite& suite, const std::vector<std::string>& names) {
    std::vector<std::string_view> known;
    for (const GoldenCase& golden : suite.cases) known.push_back(golden.name);
    for (const std::string& name : names)
        if (suite.find(name) == nullptr)
            throw InputError(fmt::format("there is no case \"{}\" in {}{}", safe_text(name), safe_path(suite.file),
                                         suggestion(name, known)));
    std::vector<const GoldenCase*> chosen;
    for (const GoldenCase& golden : suite.cases)
        if (names.empty() || std::ranges::find(names, golden.name) != names.end()) chosen.push_back(&golden);
    return chosen;
}

constexpr const char *new_prefix = "new_", *difference_prefix = "difference_";  // of the files of --failures

std::optional<std::string> accepted_platform(const GoldenCommand& command) {
    return command.platform == "none" ? std::nullopt : command.platform;
}

void save_report(const GoldenCommand& command, const GoldenSuite& suite, const SetResult& result) {
    ReportOptions options;
    options.title = suite.file.string();
    options.generator = "Tumble " TUMBLE_VERSION;
    options.platform = this_platform();
    options.workers = command.jobs;
    write_comparison_report(result, options, *command.report);
}

void plan_check(const GoldenCommand& command, const GoldenSuite& suite, const std::vector<const GoldenCase*>& cases,
                const std::optional<fs::path>& cache) {
    if (!command.report && !command.json && !command.junit && !command.failures) return;
    OutputPlan plan;
    add_suite_inputs(suite, plan);
    add_reference_inputs(suite, plan);
    if (cache) plan.add_input_folder(*cache, [](const fs::path&) { return true; });
    if (command.report) plan.add("--report", *command.report);
    if (command.json) plan.add("--json", *command.json);
    if (command.junit) plan.add("--junit", *command.junit);
    if (!command.failures) return;
    for (const GoldenCase* golden : cases)
        for (const std::int64_t frame : golden->frames)
            for (const char* kind : {new_prefix, difference_prefix})
                plan.add_below("--failures", *command.failures, kind + golden->image_name(frame));
}

/// Before anything is drawn.
void plan_accept(const GoldenCommand& command, const GoldenSuite& suite, const std::vector<const GoldenCase*>& cases) {
    OutputPlan plan;
    add_suite_inputs(suite, plan);
    add_references(suite, cases, accepted_platform(command), plan);
}

/// new_NAME, and difference_NAME where there is a reference.
void keep_failures(const fs::path& folder, const GoldenSuite& suite, const SetResult& result) {
    for (const ImageResult& image : result.images) {
        if (image.verdict == Verdict::same || image.verdict == Verdict::alike || image.image.empty()) continue;
        const std::optional<std::string> bytes = bytes_of_file(image.image);
        if (!bytes) throw RunError(fmt::format("--failures: cannot read '{}' again", safe_path(image.image)));
        make_folder(folder);
        write_file(folder / (new_prefix + image.name), *bytes);
        if (image.verdict == Verdict::different || image.sizes_differ())
            write_difference_image(image.reference, image.image, suite.tolerances_of(image.name).pixels,
                                   folder / (difference_prefix + image.name));
    }
}

void print_drawn(const std::vector<DrawnCase>& drawn) {
    const auto kept = std::ranges::count_if(drawn, [](const DrawnCase& d) { return d.error.empty() && !d.drawn; });
    say("{} cases: {} drawn, {} unchanged since they were drawn\n", drawn.size(), std::ptrdiff_t(drawn.size()) - kept,
        kept);
}

void print_hints(const GoldenCommand& command, const GoldenSuite& suite, const SetResult& result,
                 const std::vector<DrawnCase>& drawn) {
    std::string names;
    for (const DrawnCase& one : drawn) {
        const bool fails = std::ranges::any_of(result.images, [&](const ImageResult& image) {
            return (image.verdict == Verdict::different || image.verdict == Verdict::missing) &&
                   std::ranges::any_of(one.golden->frames,
                                       [&](std::int64_t f) { return one.golden->image_name(f) == image.name; });
        });
        if (fails) names += " " + one.golden->name;
    }
    if (!names.empty())
        say("if the new images are right: tumble golden accept {}{}\n", safe_path(command.suite), names);
    if (!command.cases.empty()) return;
    const std::vector<std::string> others = references_of_no_case(suite);
    if (!others.empty())
        say("note: {} files in {} belong to no case: {}{}\n", others.size(), safe_path(suite.references),
            safe_text(others.front()), others.size() > 1 ? ", ..." : "");
}

std::vector<AcceptedImage> accept(const GoldenCommand& command, const GoldenSuite& suite,
                                  const std::vector<const GoldenCase*>& cases) {
    const SceneDrawer drawer;
    Interrupt interrupt;
    AcceptOptions options;
    options.platform = accepted_platform(command);
    options.even_alike = command.even_alike;
    options.jobs = command.jobs;
    return accept_cases(suite, cases, drawer, options, interrupt);
}

/// Returns the exit code.
int print_accepted(const std::vector<AcceptedImage>& images, bool quiet) {
    using What = AcceptedImage::What;
    std::int64_t refused = 0, broken = 0, made = 0, replaced = 0, same = 0, alike = 0;
    for (const AcceptedImage& image : images) {
        switch (image.what) {
            case What::refused:
                ++refused;
                say("refused: {}\n  {}\n", safe_text(image.name), safe_lines(image.reason));
                break;
            case What::broken:
                ++broken;
                say("broken: {}\n  {}\n", safe_text(image.name), safe_lines(image.reason));
                break;
            case What::made:
                ++made;
                if (!quiet) say("new: {}\n", safe_text(image.name));
                break;
            case What::replaced:
                ++replaced;
                if (!quiet) say("replaced: {}\n", safe_text(image.name));
                break;
            case What::kept_same:
                ++same;
                break;
            case What::kept_alike:
                ++alike;
                break;
        }
    }
    if (!quiet) {
        say("{} images: {} new, {} replaced, {} the same, {} alike and kept, {} refused\n", images.size(), made,
            replaced, same, alike, refused);
        if (alike > 0) say("(--even-alike replaces images within the tolerances as well)\n");
    }
    return broken > 0 ? 2 : refused > 0 ? 1 : 0;
}

}  // namespace

int run_golden_check(const GoldenCommand& command) {
    const GoldenSuite suite = load_suite(command.suite);
    const std::vector<const GoldenCase*> cases = chosen_cases(suite, command.cases);
    std::optional<fs::path> kept;
    if (command.cache != "none") kept = cache_folder(suite, command.cache);
    plan_check(command, suite, cases, kept);
    finish_left_transactions(suite.references);
    const SceneDrawer drawer;
    Interrupt interrupt;
    std::optional<TemporaryFolder> no_cache;
    if (!kept) no_cache.emplace("golden");
    const ImageCache cache(kept ? *kept : no_cache->path());
    DrawCasesOptions drawing;
    drawing.force = command.force;
    drawing.jobs = command.jobs;
    if (!no_cache) drawing.identity = program_identity(interrupt);
    std::vector<DrawnCase> drawn;
    {
        std::int64_t done = 0;
        Progress progress(std::int64_t(cases.size()), command.quiet, "cases");
        drawing.report = [&](const DrawnCase&) { progress.update(++done); };
        drawn = draw_cases(cases, drawer, cache, drawing, interrupt);
    }
    SetResult result = check_cases(suite, drawn, {command.platform, command.jobs}, interrupt);
    if (command.failures) keep_failures(*command.failures, suite, result);
    if (command.report) save_report(command, suite, result);
    if (no_cache) forget_files_in(no_cache->path(), result);
    if (command.json) write_file(*command.json, to_json(result));
    if (command.junit) write_file(*command.junit, to_junit(result));
    print_summary(result, command.quiet);
    if (!command.quiet) print_drawn(drawn);
    print_hints(command, suite, result, drawn);
    return result.exit_code();
}

int run_golden_accept(const GoldenCommand& command) {
    const GoldenSuite suite = load_suite(command.suite);
    if (command.all == !command.cases.empty())
        throw InputError(command.all ? "--all: stands for all cases; leave out the names, or --all"
                                     : "give the names of the cases to accept, or --all");
    const std::vector<const GoldenCase*> cases = chosen_cases(suite, command.cases);
    plan_accept(command, suite, cases);
    return print_accepted(accept(command, suite, cases), command.quiet);
}

int run_golden_add(const GoldenCommand& command) {
    const std::string text = suite_text_with(command.suite, command.added);
    const GoldenSuite suite = parse_suite(text, command.suite);
    const GoldenCase* const added = &suite.cases.back();
    plan_accept(command, suite, {added});
    if (const int code = print_accepted(accept(command, suite, {added}), command.quiet); code != 0) return code;
    write_file(command.suite, text);
    if (!command.quiet) say("added the case {} to {}\n", added->name, safe_path(command.suite));
    return 0;
}

}  // namespace tumble
