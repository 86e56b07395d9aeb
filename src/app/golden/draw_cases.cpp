#include "app/golden/draw_cases.h"

#include "app/threads/stage_timer.h"
#include "core/sha256.h"

#include <fmt/format.h>

#include <algorithm>
#include <string>

namespace tumble {
namespace {

namespace fs = std::filesystem;

/// The drawing of a case.
struct CaseWork {
    const CaseDrawer& drawer;
    const ImageCache& cache;
    const DrawCasesOptions& options;
    fs::path folder;  // for its drawings
    DrawingWork division;
};

/// In a child. Returns the seconds of the drawing, or "kept", and the folder.
std::string draw_case(const GoldenCase& golden, const CaseWork& work) {
    std::string identity;
    with_place_of(golden, [&] { identity = work.drawer.identity(golden); });
    const fs::path entry = work.cache.entry(golden, sha256(work.options.identity + identity));
    if (!work.options.force && ImageCache::holds(golden, entry)) return "kept " + entry.string();
    const double start = wall_seconds();
    fs::create_directory(work.folder);
    with_place_of(golden, [&] { work.drawer.draw(golden, work.folder, work.division); });
    work.cache.store(golden, work.folder, entry);
    return fmt::format("{:.6f} {}", wall_seconds() - start, entry.string());
}

}  // namespace

std::vector<DrawnCase> draw_cases(std::span<const GoldenCase* const> cases, const CaseDrawer& drawer,
                                  const ImageCache& cache, const DrawCasesOptions& options, Interrupt& interrupt) {
    std::vector<DrawnCase> drawn(cases.size());
    for (std::size_t i = 0; i < cases.size(); ++i) drawn[i].golden = cases[i];
    const int jobs = std::max(1, std::min(options.jobs, int(cases.size())));
    const int share = std::max(1, options.jobs / jobs);  // of a few cases
    const TemporaryFolder work = cache.make_work_folder();
    const DrawingWork division = options.work.value_or(DrawingWork{share, share, false});
    const auto draw = [&](std::size_t i) {
        return draw_case(*cases[i], {drawer, cache, options, work.path() / cases[i]->name, division});
    };
    const auto ended = [&](std::size_t i, const TaskEnd& end) {
        if (end.ok) {
            const std::size_t space = end.text.find(' ');
            drawn[i].drawn = end.text.substr(0, space) != "kept";
            if (drawn[i].drawn) drawn[i].seconds = std::stod(end.text.substr(0, space));
            drawn[i].folder = end.text.substr(space + 1);
        } else {
            drawn[i].error = end.text;
        }
        if (options.report) options.report(drawn[i]);
    };
    run_in_children(cases.size(), std::size_t(jobs), draw, ended, interrupt);
    return drawn;
}

}  // namespace tumble
