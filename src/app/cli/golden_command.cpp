#include "app/cli/command.h"
#include "app/cli/compare_command.h"
#include "app/cli/plot_command.h"
#include "app/cli/progress.h"
#include "app/cli/render_run.h"
#include "app/cli/say.h"
#include "app/cli/shared_options.h"
#include "app/clip/drawing_settings.h"
#include "app/clip/render_scenes.h"
#include "app/files/frame_folder.h"
#include "app/files/frame_set.h"
#include "app/files/output_plan.h"
#include "app/golden/accept.h"
#include "app/golden/check.h"
#include "app/golden/image_cache.h"
#include "app/golden/suite.h"
#include "app/plots/variants.h"
#include "app/threads/interrupt.h"
#include "compare/comparison.h"
#include "compare/difference_image.h"
#include "compare/platform.h"
#include "compare/report/comparison_report.h"
#include "core/error.h"
#include "core/safe_text.h"
#include "output/file_bytes.h"
#include "output/file_transaction.h"
#include "output/output_path.h"
#include "output/temporary_file.h"
#include "output/temporary_folder.h"
#include "presimulation/impact_focus.h"
#include "scene/hash/scene_hash.h"
#include "scene/toml/error_text.h"
#include "scene/toml/limits.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <system_error>

namespace tumble {
namespace {

namespace fs = std::filesystem;

struct GoldenCommand {
    fs::path suite;
    std::vector<std::string> cases;               // by name; empty: all
    bool all = false;                             // accept: all cases
    bool even_alike = false;                      // accept: also within the tolerances
    bool force = false;                           // check: ignores images of the cache
    std::optional<fs::path> cache;                // folder
    std::optional<fs::path> report, json, junit;  // check: to write
    std::optional<fs::path> failures;             // check: folder for images that differ
    std::optional<std::string> platform;          // of the references; "none": the general ones alone
    NewCase added;                                // add
    int jobs = 1;                                 // cases at a time
    bool quiet = false;
};

/// Draws golden cases as `tumble render` and `tumble plot` do.
class SceneDrawer : public CaseDrawer {
public:
    std::string identity(const GoldenCase& golden) const override;
    void draw(const GoldenCase& golden, const fs::path& folder, const DrawingWork& work) const override;
};

constexpr int plot_width = 900, plot_height = 540;  // pixels, of a plot without a size

RenderCommand render_command(const GoldenCase& golden) {
    RenderCommand command;
    command.scenes = golden.scenes;
    command.vary = golden.vary;
    command.overrides = golden.overrides;
    command.arrangement = golden.arrangement;
    command.drawing.transparent = golden.transparent;
    command.speed = golden.speed;
    command.shutter = golden.shutter;
    command.blur_samples = golden.blur_samples;
    command.quiet = true;
    return command;
}

PlotCommand plot_command(const GoldenCase& golden) {
    PlotCommand command;
    command.scenes = golden.scenes;
    command.vary = golden.vary;
    command.overrides = golden.overrides;
    command.overrides.width.reset();
    command.overrides.height.reset();
    command.width = golden.overrides.width.value_or(plot_width);
    command.height = golden.overrides.height.value_or(plot_height);
    command.quantities = *golden.of;
    command.quiet = true;
    return command;
}

void draw_plot(const GoldenCase& golden, const fs::path& folder, const DrawingWork& work) {
    PlotCommand command = plot_command(golden);
    command.output = folder / golden.image_name(0);
    command.motion_record = folder / golden.record_name();
    command.threads = work.threads;
    run_plot(command);
}

/// "0,44-45,89-90", with or without the frame before each one.
std::string range_of(const std::vector<std::int64_t>& frames, bool with_neighbors) {
    FrameSet set;
    for (const std::int64_t frame : frames)
        set.append(std::max(with_neighbors ? frame - 1 : frame, set.end()), frame + 1);
    return set.text(frames.size());
}

void draw_frames(const GoldenCase& golden, const fs::path& folder, const DrawingWork& work) {
    RenderCommand command = render_command(golden);
    command.frames = folder / "frames";
    command.motion_record = folder / golden.record_name();
    command.workers = work.workers;
    command.threads = work.threads;
    // Dirty regions are those since the frame before, which is drawn as well.
    const bool all = RenderScenes(command, Shutter::of(command.shutter, command.blur_samples)).shows_damage();
    command.frames_range = all ? fmt::format("0-{}", golden.frames.back()) : range_of(golden.frames, work.neighbors);
    render_to_files(command);
    for (const std::int64_t frame : golden.frames)
        fs::rename(frame_path(*command.frames, frame), folder / golden.image_name(frame));
    fs::remove_all(*command.frames);
}

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

std::string SceneDrawer::identity(const GoldenCase& golden) const {
    std::string text;
    if (golden.of) {
        const PlotCommand command = plot_command(golden);
        text = fmt::format("{} {} {}\n", command.quantities, command.width, command.height);
        for (const Variant& variant : make_variants(command.scenes, command.overrides, command.vary))
            text += fmt::format("{} {}\n", scene_hash(focused_on_impacts(load_scene(variant.scene, variant.overrides))),
                                variant.label);
        return text;
    }
    const RenderCommand command = render_command(golden);
    const RenderScenes scenes(command, Shutter::of(command.shutter, command.blur_samples));
    for (const ClipScene& one : scenes.scenes) text += fmt::format("{} {}\n", scene_hash(*one.scene), one.label);
    const DrawingChoices choices{golden.shutter, golden.blur_samples, golden.transparent, command.drawing.backend};
    for (const auto& [name, value] : drawing_settings(command, choices, scenes.composition))
        text += fmt::format("{} {}\n", name, value);
    return text;
}

void SceneDrawer::draw(const GoldenCase& golden, const fs::path& folder, const DrawingWork& work) const {
    if (golden.of)
        draw_plot(golden, folder, work);
    else
        draw_frames(golden, folder, work);
}

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

void add_suite(CLI::App& command, GoldenCommand& c) {
    command.add_option("suite", c.suite, "The suite (TOML; docs/reference/golden-suite.md)")
        ->check(file_name("toml"))
        ->required()
        ->type_name("SUITE");
}

constexpr const char* checked_platform =
    "References of the folder NAME replace general ones; none: no folder does. By default\n"
    "the processor: amd, intel, arm or other";
constexpr const char* accepted_platform_help =
    "Write references for processors of that name, in the folder NAME, in place of general\nones";

void add_common(Command& command, GoldenCommand& c, const char* platform) {
    command.judges = true;
    c.jobs = std::min(machine_threads(), enough_workers);
    command.add_option("--platform", c.platform, platform)->check(platform_name())->type_name("NAME");
    command.add_option("--jobs", c.jobs, "Cases drawn at a time")
        ->check(number_within(1, most_threads))
        ->option_text(fmt::format("N [{}]", c.jobs));
    command.add_flag("--quiet", c.quiet, "Print differences and errors only");
}

void add_cases(CLI::App& command, GoldenCommand& c, const std::string& help) {
    command.add_option("cases", c.cases, help)->check(some_name())->type_name("CASE");
}

/// "0,45,90", ascending.
std::vector<std::int64_t> read_frames(const std::string& text) {
    std::vector<std::int64_t> frames;
    const char *at = text.data(), *const end = at + text.size();
    for (;;) {
        std::int64_t frame = -1;
        const auto [next, error] = std::from_chars(at, end, frame);
        const bool in_order = frames.empty() || frame > frames.back();
        if (error != std::errc() || frame < 0 || frame > limits::frames || !in_order || (next != end && *next != ','))
            throw InputError(fmt::format("--frames: must be ascending numbers of frames, as in 0,45,90 (given '{}')",
                                         safe_text(text)));
        frames.push_back(frame);
        if (next == end) return frames;
        at = next + 1;
    }
}

void add_check(Command& golden) {
    Command& command = golden.add("check", "Draw the cases and compare them with their references",
                                  {{0, "alike"}, {1, "different"}, {2, "broken"}, {3, "a reference is missing"}});
    GoldenCommand& c = command.keep<GoldenCommand>();
    add_suite(command, c);
    add_cases(command, c, "Names of cases; without one: all");
    command.add_option("--report", c.report, "Write a page with the images that differ, and the causes")
        ->check(file_name("html"))
        ->type_name("R.html");
    command.add_option("--json", c.json, "Write the verdict, the figures, the limits and the causes of each image")
        ->check(file_name("json"))
        ->type_name("R.json");
    command.add_option("--junit", c.junit, "Write the verdicts as JUnit XML, for CI services")
        ->check(file_name("xml"))
        ->type_name("R.xml");
    command
        .add_option("--failures", c.failures,
                    "Write new_NAME.png and difference_NAME.png of each image that is not alike")
        ->check(folder_name())
        ->type_name("DIR");
    command
        .add_option("--cache", c.cache,
                    "Folder of drawn images, in place of tumble/golden in $XDG_CACHE_HOME or ~/.cache: a case is\n"
                    "drawn again only if its scene, the program, a library or a font has changed; none: all\nare "
                    "drawn, and removed at the end")
        ->check(folder_name())
        ->type_name("DIR");
    command.add_flag("--force", c.force, "Draw all cases, changed or not");
    add_common(command, c, checked_platform);
    command.examples =
        "  tumble golden check golden.toml\n"
        "  tumble golden check golden.toml falling_boxes --report report.html --junit result.xml";
    command.logs = true;
    command.run = [&c] { return run_golden_check(c); };
}

void add_accept(Command& golden) {
    Command& command = golden.add("accept",
                                  "Draw cases twice and take the images as references; an image that does not render\n"
                                  "twice alike is refused (exit code 1)");
    GoldenCommand& c = command.keep<GoldenCommand>();
    add_suite(command, c);
    add_cases(command, c, "Names of the cases to accept");
    command.add_flag("--all", c.all, "All cases");
    command.add_flag("--even-alike", c.even_alike,
                     "Replace references also where the new image is within the tolerances");
    add_common(command, c, accepted_platform_help);
    command.examples = "  tumble golden accept golden.toml falling_boxes";
    command.logs = true;
    command.run = [&c] { return run_golden_accept(c); };
}

void add_add(Command& golden) {
    Command& command = golden.add("add", "Add a case to the suite, which is made if it does not exist, and accept it");
    GoldenCommand& c = command.keep<GoldenCommand>();
    NewCase& added = c.added;
    add_suite(command, c);
    add_scene(command, added.scene);
    command.add_option("--name", added.name, "Name of the case, in place of the scene's file name")
        ->check(some_name())
        ->type_name("NAME");
    command
        .add_option_function<std::string>(
            "--frames", [&added](const std::string& text) { added.frames = read_frames(text); },
            "Numbers of the frames, from 0; without this: the frames of [defaults], otherwise the first one")
        ->type_name("N,N");
    add_size(command, added.overrides.width, added.overrides.height, "Picture size, in place of the scene's");
    add_frames_of_time(command, added.overrides);
    add_overlay(command, added.overrides, "Overlays of the pictures, in place of the scene's: none, or a list out of");
    command.add_option("--plot", added.overrides.plot, "Curves of quantities in the pictures (tumble render --help)")
        ->type_name("LIST");
    command.add_flag("--transparent", added.transparent, "Draw the bodies alone on a transparent background");
    add_common(command, c, accepted_platform_help);
    command.examples = "  tumble golden add golden.toml scene.toml --frames 0,45,90 --size 160x90";
    command.run = [&c] { return run_golden_add(c); };
}

}  // namespace

void add_golden(Command& command) {
    command.require_subcommand(1);
    add_check(command);
    add_accept(command);
    add_add(command);
    command.examples =
        "  tumble golden add golden.toml scene.toml --frames 0,45\n"
        "  tumble golden check golden.toml --report report.html";
}

}  // namespace tumble
