#include "app/checkpoints/checkpoint_folder.h"

#include "app/checkpoints/checkpoint_file.h"
#include "core/error.h"
#include "core/safe_text.h"
#include "output/temporary_file.h"
#include "sim/checkpoint/archive.h"

#include <fmt/format.h>

#include <algorithm>
#include <system_error>
#include <utility>

namespace tumble {

namespace fs = std::filesystem;

namespace {

fs::path clip_path(const fs::path& folder) { return folder / "clip.tumble"; }

CheckpointHeader header_of(const std::string& program, const std::string& kind, std::int64_t frame,
                           const ClipIdentity& identity) {
    CheckpointHeader header;
    header.program = program;
    header.kind = kind;
    header.frame = frame;
    header.identity = identity;
    return header;
}

}  // namespace

fs::path checkpoint_path(const fs::path& folder, std::int64_t frame) {
    return folder / fmt::format("checkpoint_{:06}.tumble", frame);
}

CheckpointWriting::CheckpointWriting(const fs::path& folder, std::string program, ClipIdentity identity)
    : folder_(folder), program_(std::move(program)), identity_(std::move(identity)) {
    std::error_code missing;
    fs::remove(clip_path(folder), missing);
    for (const std::int64_t frame : numbers_in(folder, "checkpoint_", ".tumble"))
        fs::remove(checkpoint_path(folder, frame), missing);
}

void CheckpointWriting::write(const fs::path& path, const std::string& kind, std::int64_t frame,
                              std::span<const std::byte> content) {
    const std::vector<std::byte> bytes = checkpoint_bytes(header_of(program_, kind, frame, identity_), content);
    write_file(path, bytes);
    bytes_ += bytes.size();
}

void CheckpointWriting::add(const ClipState& state) {
    CheckpointWriter writer;
    writer.keep(state);
    write(checkpoint_path(folder_.path(), state.frame), "state", state.frame, writer.bytes());
    frames_.push_back(state.frame);
}

void CheckpointWriting::finish(std::span<const std::byte> survey) {
    CheckpointWriter writer;
    writer.keep(frames_, std::vector<std::byte>(survey.begin(), survey.end()));
    write(clip_path(folder_.path()), "clip", 0, writer.bytes());
}

CheckpointReading::CheckpointReading(const fs::path& folder, std::string program, ClipIdentity identity)
    : folder_(folder), program_(std::move(program)), identity_(std::move(identity)) {
    const fs::path path = clip_path(folder);
    std::error_code error;
    if (!fs::exists(path, error))
        throw InputError(
            fmt::format("--from-checkpoints: '{}' has no checkpoints of a whole clip: its clip.tumble is "
                        "missing. Make them by tumble simulate --checkpoints",
                        safe_path(folder)));
    const std::vector<std::byte> content = read_checkpoint(path, header_of(program_, "clip", 0, identity_));
    CheckpointReader reader(content);
    reader.keep(frames_, survey_);
}

std::optional<ClipState> CheckpointReading::before(std::int64_t frame) const {
    const auto after = std::upper_bound(frames_.begin(), frames_.end(), frame);
    if (after == frames_.begin()) return std::nullopt;
    const std::int64_t at = *std::prev(after);
    const fs::path path = checkpoint_path(folder_, at);
    const std::vector<std::byte> content = read_checkpoint(path, header_of(program_, "state", at, identity_));
    CheckpointReader reader(content);
    ClipState state;
    reader.keep(state);
    return state;
}

}  // namespace tumble
