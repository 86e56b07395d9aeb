// A folder of checkpoints: checkpoint_000060.tumble holds the state just before frame 60 is made; motion_000060.tumble
// the motion from there to the next such file; clip.tumble, written last, the values of the whole clip that drawing
// needs.
#pragma once

#include "app/checkpoints/checkpoint_file.h"
#include "app/checkpoints/clip_state.h"
#include "app/files/frame_folder.h"

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace tumble {

class OutputPlan;

/// True for the name of such a file.
bool is_checkpoint_name(const std::filesystem::path& name);
/// The files of a folder with such names.
std::vector<std::filesystem::path> checkpoint_files_in(const std::filesystem::path& folder);

std::filesystem::path checkpoint_path(const std::filesystem::path& folder, std::int64_t frame);

/// The files of such a folder as values of --checkpoints. Throws InputError where another output is one of them.
void add_checkpoints(OutputPlan& plan, const std::filesystem::path& folder);

/// Throws RunError if the folder cannot be made or written into, or if another run writes into it.
class CheckpointWriting {
public:
    /// The checkpoints of an earlier run are removed.
    CheckpointWriting(const std::filesystem::path& folder, CheckpointIdentity identity);

    void add(const ClipState& state);
    /// The motion of a panel (FrameRecorder) from a frame to the next one that is given, or to the end. All panels that
    /// run are given the same frames, in order.
    void add_motion(std::int64_t frame, std::size_t panel, std::span<const std::byte> motion);
    /// `survey`: the values of the whole clip that drawing needs.
    void finish(std::span<const std::byte> survey);

    std::size_t count() const { return frames_.size(); }
    std::uintmax_t bytes() const { return bytes_; }  // of all files

private:
    void write(const std::filesystem::path& path, const std::string& kind, std::int64_t frame,
               std::span<const std::byte> content);

    FrameFolder folder_;
    CheckpointIdentity identity_;
    std::vector<std::int64_t> frames_;
    std::vector<std::int64_t> intervals_;  // of the motion: their first frames
    std::uintmax_t bytes_ = 0;
};

class CheckpointReading {
public:
    /// Throws InputError if the folder has no complete checkpoints of this clip.
    CheckpointReading(const std::filesystem::path& folder, CheckpointIdentity identity);

    std::span<const std::byte> survey() const { return survey_; }
    /// The last state at or before a frame; none: there the clip starts anew. Throws InputError for a damaged file.
    std::optional<ClipState> before(std::int64_t frame) const;

    /// True if the motion is in the folder too. It is in intervals, of which the first begins at the start.
    bool has_motion() const { return !intervals_.empty(); }
    /// The first frame of the interval of a frame, and of the next interval.
    std::int64_t interval_of(std::int64_t frame) const;
    std::optional<std::int64_t> interval_after(std::int64_t interval) const;
    std::vector<std::byte> motion(std::int64_t interval, std::size_t panel) const;

private:
    std::filesystem::path folder_;
    CheckpointIdentity identity_;
    std::vector<std::int64_t> frames_;     // of the states, ascending
    std::vector<std::int64_t> intervals_;  // of the motion: their first frames, ascending
    std::vector<std::byte> survey_;
};

}  // namespace tumble
