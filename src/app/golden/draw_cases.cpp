#include "app/golden/draw_cases.h"

#include "app/files/frame_folder.h"
#include "core/error.h"
#include "core/sha256.h"

#include <fmt/format.h>

#include <algorithm>
#include <system_error>

namespace tumble {
namespace {

namespace fs = std::filesystem;

/// A folder of the cache for the drawings of this run, removed with all its files.
class WorkFolder {
public:
    explicit WorkFolder(const ImageCache& cache) : path_(cache.make_work_folder()), lock_(path_, LockKind::alone) {}
    ~WorkFolder() {
        std::error_code ignored;
        fs::remove_all(path_, ignored);
    }
    WorkFolder(const WorkFolder&) = delete;
    WorkFolder& operator=(const WorkFolder&) = delete;
    const fs::path& path() const { return path_; }

private:
    fs::path path_;
    FolderLock lock_;
};

/// The drawing of a case.
struct CaseWork {
    const CaseDrawer& drawer;
    const ImageCache& cache;
    const DrawCasesOptions& options;
    fs::path folder;  // for its drawings
    DrawingWork division;
};

/// In a child: draws the missing images; returns their number and the folder.
std::string draw_case(const GoldenCase& golden, const CaseWork& work) {
    std::string identity;
    with_place_of(golden, [&] { identity = work.drawer.identity(golden); });
    const fs::path entry = work.cache.entry(golden, sha256(work.options.identity + identity));
    const std::vector<std::int64_t> missing = work.options.force ? golden.frames : ImageCache::missing(golden, entry);
    if (!missing.empty()) {
        fs::create_directory(work.folder);
        // All frames: the record is of the whole case.
        with_place_of(golden, [&] { work.drawer.draw(golden, golden.frames, work.folder, work.division); });
        work.cache.store(golden, work.folder, entry);
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
    cache.remove_left_work();
    const WorkFolder work(cache);
    const DrawingWork division = options.work.value_or(DrawingWork{share, share, false});
    const auto draw = [&](std::size_t i) {
        return draw_case(*cases[i], {drawer, cache, options, work.path() / cases[i]->name, division});
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
