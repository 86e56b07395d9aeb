// A clip that several programs on several machines make together, in a folder that all of them can reach.
#pragma once

#include "app/files/frame_set.h"

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

namespace tumble {

/// Successive frames, drawn by one program.
struct FarmPart {
    std::int64_t first = 0, last = 0;  // frame numbers in the scene, from 0
    std::int64_t count() const { return last - first + 1; }
    std::string range() const;  // "12-23", as --frames-range takes it
    friend bool operator==(const FarmPart&, const FarmPart&) = default;
};

struct FarmJob {
    std::vector<std::filesystem::path> scenes;  // absolute; several are shown side by side
    std::filesystem::path clip, folder;         // absolute
    std::vector<std::filesystem::path> meshes;  // files that the scenes name
    std::string program = "tumble";             // on the machines of the farm
    std::int64_t frames = 0;                    // of the scene
    double fps = 0.0;                           // of the clip
    std::vector<FarmPart> parts;                // part 1 is the first
    double checkpoint_period = 0.0;             // s of the clip
    std::vector<std::string> simulate_options, render_options, encode_options;  // words of a command line
    int retries = 2;                                                            // of a failed part
};

inline constexpr int most_parts = 100000;

/// Divides the frames into parts of one length, which begin where checkpoints of one period are; the last part may be
/// shorter.
std::vector<FarmPart> divide_frames(std::int64_t frames, std::int64_t length);

/// Parts as a list of a job array: "3,7-9". Precondition: the numbers ascend.
std::string part_list(const std::vector<int>& numbers);

/// Folders in the job's folder.
std::filesystem::path frames_folder(const std::filesystem::path& job_folder);
std::filesystem::path checkpoints_folder(const std::filesystem::path& job_folder);

/// The file in the job's folder that `tumble farm status` reads.
std::filesystem::path farm_file(const std::filesystem::path& job_folder);
void write_farm_file(const FarmJob& job);
/// Throws InputError where it is missing or broken.
FarmJob read_farm_file(const std::filesystem::path& job_folder);

// Which parts of a farm's clip are drawn.

/// The frames of each part that are missing, damaged, or of another clip.
struct FarmStatus {
    std::vector<FrameSet> missing;        // by part
    std::int64_t drawn = 0;               // frames
    std::vector<int> incomplete() const;  // numbers of parts, from 1
};

/// Reads each frame's file, and does not unpack it: the job that makes the clip does.
FarmStatus find_farm_status(const FarmJob& job);

/// The state as text of several lines, with the commands that draw the missing parts.
std::string status_text(const FarmJob& job, const FarmStatus& status);

// -- A job template of Open Job Description (2023-09) for render farms that read it, such as AWS Deadline Cloud: steps
// that simulate with checkpoints, draw the frames by chunks, and make the clip.

/// The JSON text for a template at this path (absolute). Of the job: scene, meshes, clip (its name only), program,
/// frames, parts (the first one's length is that of a chunk) and options. Throws InputError for a value that a template
/// cannot hold.
std::string openjd_template(const FarmJob& job, const std::filesystem::path& file);

}  // namespace tumble
