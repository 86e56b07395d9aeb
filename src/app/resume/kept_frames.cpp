#include "app/resume/kept_frames.h"

#include "app/files/aov_folder.h"
#include "app/files/frame_folder.h"
#include "core/error.h"
#include "output/npz_archive.h"
#include "output/png_reader.h"

#include <fmt/format.h>

namespace tumble {
namespace {

namespace fs = std::filesystem;

constexpr const char* remedy = "; name another folder, or delete this one's frames";

/// The mark of a whole file; empty for a file that is to be made again. Throws InputError for a whole one without mark.
std::optional<std::string> mark_of_whole(const fs::path& path, FrameFiles kind) {
    if (kind == FrameFiles::aovs) return mark_of_whole_npz(path);
    const PngState state = state_of_png(path);
    if (!state.whole) return std::nullopt;
    if (state.mark) return state.mark;
    throw InputError({path.string(), 0, 0},
                     fmt::format("--resume: the picture was not written by render --frames: it has no mark{}", remedy));
}

}  // namespace

fs::path manifest_path(const fs::path& folder, FrameFiles kind) {
    return folder / (kind == FrameFiles::pictures ? "frames.json" : "aovs.json");
}

void require_same_clip(const fs::path& folder, FrameFiles kind, const FrameIdentity& identity) {
    const fs::path path = manifest_path(folder, kind);
    const std::optional<FrameIdentity> there = read_manifest(path);
    if (there && there->mark() != identity.mark())
        throw InputError({folder.string(), 0, 0},
                         fmt::format("the folder holds frames of another clip, which differs in {} ({}){}",
                                     differences(*there, identity), path.filename().string(), remedy));
}

FrameSet kept_frames(const fs::path& folder, FrameFiles kind, const FrameIdentity& identity, const FrameSet& wanted) {
    const std::string mark = identity.mark();
    return wanted.where([&](std::int64_t n) {
        const fs::path path = kind == FrameFiles::pictures ? frame_path(folder, n) : aov_path(folder, n);
        const std::optional<std::string> found = mark_of_whole(path, kind);
        if (found && *found != mark)
            throw InputError(
                {path.string(), 0, 0},
                fmt::format("--resume: the frame is of another scene, other settings or another version{}", remedy));
        return found.has_value();
    });
}

}  // namespace tumble
