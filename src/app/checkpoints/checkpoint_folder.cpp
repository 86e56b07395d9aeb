#include "app/checkpoints/checkpoint_folder.h"

#include "app/checkpoints/checkpoint_file.h"
#include "app/files/output_plan.h"
#include "core/error.h"
#include "core/safe_text.h"
#include "output/temporary_file.h"
#include "scene/toml/limits.h"
#include "sim/checkpoint/archive.h"
#include "tumble/version.h"

#include <fmt/format.h>

#include <algorithm>
#include <system_error>
#include <utility>

namespace tumble {

namespace fs = std::filesystem;

namespace {

fs::path clip_path(const fs::path& folder) { return folder / "clip.tumble"; }

fs::path motion_path(const fs::path& folder, std::int64_t frame, std::size_t panel) {
    const std::string of_panel = panel == 0 ? "" : fmt::format("_panel_{}", panel + 1);
    return folder / fmt::format("motion_{:06}{}.tumble", frame, of_panel);
}

std::string motion_kind(std::size_t panel) { return fmt::format("motion of panel {}", panel + 1); }

CheckpointHeader header_of(const std::string& kind, std::int64_t frame, const CheckpointIdentity& identity) {
    CheckpointHeader header;
    header.program = v0::version();
    header.kind = kind;
    header.frame = frame;
    header.identity = identity;
    return header;
}

}  // namespace

bool is_checkpoint_name(const fs::path& name) {
    const std::string text = name.string();
    const bool ours = text.starts_with("checkpoint_") || text.starts_with("motion_") || text == "clip.tumble";
    return ours && text.ends_with(".tumble") && !name.has_parent_path();
}

std::vector<fs::path> checkpoint_files_in(const fs::path& folder) {
    std::vector<fs::path> files;
    std::error_code error;
    for (fs::directory_iterator entry(folder, error), end; !error && entry != end; entry.increment(error))
        if (is_checkpoint_name(entry->path().filename())) files.push_back(entry->path());
    return files;
}

fs::path checkpoint_path(const fs::path& folder, std::int64_t frame) {
    return folder / fmt::format("checkpoint_{:06}.tumble", frame);
}

void add_checkpoints(OutputPlan& plan, const fs::path& folder) {
    constexpr const char* option = "--checkpoints";
    const auto path_of_motion = [](const fs::path& in, std::int64_t frame) { return motion_path(in, frame, 0); };
    for (const fs::path& file : checkpoint_files_in(folder)) {  // replaced or removed, whatever their numbers
        const std::string name = file.filename().string();
        if (!number_in(name, "checkpoint_", ".tumble") && !number_in(name, "motion_", ".tumble") &&
            file != clip_path(folder))
            plan.add(option, file);
    }
    plan.add(option, clip_path(folder));
    plan.add({option, folder, "checkpoint_", ".tumble", checkpoint_path, 0, limits::frames});
    plan.add({option, folder, "motion_", ".tumble", path_of_motion, 0, limits::frames});
}

CheckpointWriting::CheckpointWriting(const fs::path& folder, CheckpointIdentity identity)
    : folder_(folder), identity_(std::move(identity)) {
    std::error_code missing;
    fs::remove(clip_path(folder), missing);  // first: the others are of no use without
    for (const fs::path& file : checkpoint_files_in(folder)) fs::remove(file, missing);
}

void CheckpointWriting::write(const fs::path& path, const std::string& kind, std::int64_t frame,
                              std::span<const std::byte> content) {
    const std::vector<std::byte> bytes = checkpoint_bytes(header_of(kind, frame, identity_), content);
    write_file(path, bytes);
    bytes_ += bytes.size();
}

void CheckpointWriting::add(const ClipState& state) {
    CheckpointWriter writer;
    writer.keep(state);
    write(checkpoint_path(folder_.path(), state.frame), "state", state.frame, writer.bytes());
    frames_.push_back(state.frame);
}

void CheckpointWriting::add_motion(std::int64_t frame, std::size_t panel, std::span<const std::byte> motion) {
    write(motion_path(folder_.path(), frame, panel), motion_kind(panel), frame, motion);
    if (intervals_.empty() || intervals_.back() != frame) intervals_.push_back(frame);
}

void CheckpointWriting::finish(std::span<const std::byte> survey) {
    CheckpointWriter writer;
    writer.any(frames_, intervals_);
    writer.keep(std::vector<std::byte>(survey.begin(), survey.end()));
    write(clip_path(folder_.path()), "clip", 0, writer.bytes());
}

CheckpointReading::CheckpointReading(const fs::path& folder, CheckpointIdentity identity)
    : folder_(folder), identity_(std::move(identity)) {
    const fs::path path = clip_path(folder);
    std::error_code error;
    if (!fs::exists(path, error))
        throw InputError(
            fmt::format("--from-checkpoints: '{}' has no checkpoints of a whole clip: its clip.tumble is "
                        "missing. Make them by tumble simulate --checkpoints",
                        safe_path(folder)));
    const std::vector<std::byte> content = read_checkpoint(path, header_of("clip", 0, identity_));
    CheckpointReader reader(content);
    reader.any(frames_, intervals_);
    reader.keep(survey_);
    reader.require([&] {
        return std::is_sorted(frames_.begin(), frames_.end()) && std::is_sorted(intervals_.begin(), intervals_.end());
    });
}

std::optional<ClipState> CheckpointReading::before(std::int64_t frame) const {
    const auto after = std::upper_bound(frames_.begin(), frames_.end(), frame);
    if (after == frames_.begin()) return std::nullopt;
    const std::int64_t at = *std::prev(after);
    const fs::path path = checkpoint_path(folder_, at);
    const std::vector<std::byte> content = read_checkpoint(path, header_of("state", at, identity_));
    CheckpointReader reader(content);
    ClipState state;
    reader.keep(state);
    reader.require([&] { return state.frame == at; });
    return state;
}

std::int64_t CheckpointReading::interval_of(std::int64_t frame) const {
    const auto after = std::upper_bound(intervals_.begin(), intervals_.end(), frame);
    return after == intervals_.begin() ? 0 : *std::prev(after);
}

std::optional<std::int64_t> CheckpointReading::interval_after(std::int64_t interval) const {
    const auto after = std::upper_bound(intervals_.begin(), intervals_.end(), interval);
    return after == intervals_.end() ? std::nullopt : std::optional(*after);
}

std::vector<std::byte> CheckpointReading::motion(std::int64_t interval, std::size_t panel) const {
    return read_checkpoint(motion_path(folder_, interval, panel), header_of(motion_kind(panel), interval, identity_));
}

}  // namespace tumble
