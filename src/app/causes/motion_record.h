// Motion record: values, poses, camera and first contacts of a run, small enough to stand beside its images. Two
// records of one name tell the causes of differences between their images.
#pragma once

#include "core/image.h"
#include "core/vector.h"

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <map>
#include <string>
#include <vector>

namespace tumble {

/// Described values by their path ("light.direction"), as text.
using ValueMap = std::map<std::string, std::string>;

struct RecordedBody {
    std::string name;
    std::size_t kind = 0;  // index into PanelRecord::kinds
    bool moves = false;    // otherwise its pose is that of the start in every frame
};

/// Values that several bodies have in common.
struct BodyKind {
    ValueMap look;       // shape, color, ...
    ValueMap matter;     // mass, restitution, ... and the velocities of the start
    Bounds bounds;       // of the shape, body frame, m; empty for a plane
    bool round = false;  // a plain sphere: its rotation is not seen
    friend bool operator==(const BodyKind& a, const BodyKind& b) { return a.look == b.look && a.matter == b.matter; }
};

/// Rounded: 24 bits of the position, 15 bits of each component of the rotation.
struct RecordedPose {
    Vec3 origin = Vec3::Zero();  // m, of the body's own origin
    Quat rotation = Quat::Identity();
};

struct RecordedView {
    Vec3 eye = Vec3::Zero(), target = Vec3::Zero(), up = Vec3::UnitY();
    double vertical_fov = 40.0;  // degrees
};

/// Impact of two bodies, or the start of a resting contact (without impulse).
struct RecordedContact {
    float time = 0.0f;  // s
    std::uint32_t a = 0, b = 0;
    float impulse = 0.0f;  // N s
    friend bool operator==(const RecordedContact&, const RecordedContact&) = default;
};

/// Digests of the true poses. Equal motion has equal digests on every processor.
struct MotionTrace {
    std::vector<std::uint32_t> frames;  // of all bodies, by frame from 0
    int every = 1;                      // frames of a block
    std::vector<std::uint16_t> blocks;  // of each body that moves: by block, then by body
};

struct PanelRecord {
    Rectangle place;  // in the image, pixels
    ValueMap values;  // light, simulation, overlay, ...
    std::vector<BodyKind> kinds;
    std::vector<RecordedBody> bodies;              // in scene order
    std::vector<RecordedPose> start;               // by body
    std::vector<double> times;                     // s of the motion, by recorded frame
    std::vector<RecordedView> views;               // by recorded frame
    std::vector<std::vector<RecordedPose>> poses;  // by recorded frame, then by body that moves
    MotionTrace trace;
    std::vector<RecordedContact> contacts;  // the first ones, in order of time
    bool all_contacts = true;               // false: there are more

    const BodyKind& kind_of(std::size_t body) const { return kinds[bodies[body].kind]; }
};

struct MotionRecord {
    ValueMap values;                   // of the whole image: size, samples, text, ...
    std::vector<std::int64_t> frames;  // recorded ones, ascending
    std::vector<PanelRecord> panels;
    bool whole_run = false;  // an image shows all of the motion: a plot
};

// -- Motion records as JSON files: described values as text, poses and digests as base64.

/// The record of a folder of frames (frame_000000.png, ...).
inline constexpr const char* folder_record_name = "frames.motion.json";

std::string record_text(const MotionRecord& record);

/// Writes through a temporary file. Throws RunError naming the path.
void write_motion_record(const std::filesystem::path& file, const MotionRecord& record);

/// Throws InputError naming the file if it is missing or no record of this format.
MotionRecord read_motion_record(const std::filesystem::path& file);
/// The same of a text.
MotionRecord parse_record(const std::string& text, const std::filesystem::path& file);

}  // namespace tumble
