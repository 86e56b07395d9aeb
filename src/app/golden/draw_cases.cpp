#include "app/golden/draw_cases.h"

#include "core/error.h"
#include "core/sha256.h"

#include <fmt/format.h>

#include <algorithm>
#include <system_error>

namespace tumble {
namespace {

namespace fs = std::filesystem;

/// A folder that is removed with all its files.
class WorkFolder {
public:
    explicit WorkFolder(fs::path path) : path_(std::move(path)) {}
    ~WorkFolder() {
        std::error_code ignored;
        fs::remove_all(path_, ignored);
    }
    WorkFolder(const WorkFolder&) = delete;
    WorkFolder& operator=(const WorkFolder&) = delete;
    const fs::path& path() const { return path_; }

private:
    fs::path path_;
};

/// In a child: draws the missing images; returns their number and the folder.
std::string draw_case(const GoldenCase& golden, const CaseDrawer& drawer, const ImageCache& cache,
                      const DrawCasesOptions& options, const DrawingWork& work) {
    std::string identity;
    with_place_of(golden, [&] { identity = drawer.identity(golden); });
    const fs::path entry = cache.entry(golden, sha256(options.identity + identity));
    const std::vector<std::int64_t> missing = options.force ? golden.frames : ImageCache::missing(golden, entry);
    if (!missing.empty()) {
        const WorkFolder folder(cache.make_work_folder());
        // The record is of all frames of the case.
        with_place_of(golden, [&] { drawer.draw(golden, golden.frames, folder.path(), work); });
        cache.store(golden, folder.path(), entry);
    }
    return fmt::format("{} {}", missing.size(), entry.string());
}

}  // namespace

std::vector<DrawnCase> draw_cases(std::span<const GoldenCase* const> cases, const CaseDrawer& drawer,
                                  const ImageCache& cache, const DrawCasesOptions& options, Interrupt& interrupt) {
    std::vector<DrawnCase> drawn(cases.size());
    for (std::size_t i = 0; i < cases.size(); ++i) drawn[i].golden = cases[i];
    const int jobs = std::max(1, std::min(options.jobs, int(cases.size())));
    const int share = std::max(1, options.jobs / jobs);  // of a few cases
    const auto draw = [&](std::size_t i) {
        return draw_case(*cases[i], drawer, cache, options, options.work.value_or(DrawingWork{share, share, false}));
    };
    const auto ended = [&](std::size_t i, const TaskEnd& end) {
        if (end.ok()) {
            const std::size_t space = end.text.find(' ');
            drawn[i].drawn = std::stoul(end.text.substr(0, space));
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
