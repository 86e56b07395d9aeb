// The plan of a sweep: one scene, the values that differ between its samples, and the files of each sample. Plain
// values, which read_plan() makes from a file.
#pragma once

#include "app/sweep/sweep_axis.h"
#include "output/video_format.h"
#include "render/aov/aov_kind.h"
#include "render/gl/gl_context.h"

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <variant>
#include <vector>

namespace tumble {

/// How listed values are combined. product: each with each, the last axis fastest; zip: the first ones, the second
/// ones, ...; random: each axis draws one of its values.
enum class Combination { product, zip, random };

/// The other value of a pair: the axis draws again or takes its next value; or the value times a factor, plus an
/// offset; or a value of another source.
struct PairFactor {
    double factor = 1.0, offset = 0.0;
};
struct OtherSource {
    AxisSource source;
};
using PairValue = std::variant<std::monostate, PairFactor, OtherSource>;

/// Each draw gives two samples, A and B, that differ in the value of one axis only.
struct PairPlan {
    std::vector<std::size_t> axes;  // the pairs take turns
    PairValue value;
};

enum class SceneForm { none, toml, json };

/// Files of each sample.
struct SampleOutputs {
    bool frames = false;
    std::string clip;  // file name; empty: none
    AovSet aovs;
    bool trajectory = false, energy = false, impacts = false, contacts = false, loads = false, joints = false;
    bool arrays = false;  // impacts, contacts, loads and joints as .npz instead of CSV
    SceneForm scene = SceneForm::toml;

    bool tables() const { return trajectory || energy || impacts || contacts || loads || joints; }
    bool drawn() const { return frames || !clip.empty() || !aovs.empty(); }
};

/// How the clips are drawn, as by the options of `tumble render`.
struct SampleDrawing {
    double start = 0.0, speed = 1.0, shutter = 0.0;
    int blur_samples = 8;
    bool transparent = false;
    VideoQuality quality = VideoQuality::normal;
    GlBackend backend = GlBackend::software;
};

struct SweepPlan {
    std::filesystem::path file, scene;
    std::string name = "{index:06}";  // template of the folders of samples
    std::uint64_t seed = 1;
    Combination combination = Combination::product;
    std::int64_t samples = 0;
    std::vector<std::string> fixed;  // "PATH=VALUE"
    std::vector<SweepAxis> axes;
    std::optional<PairPlan> pair;
    SampleOutputs outputs;
    SampleDrawing drawing;

    /// Number of combinations of listed values; 1 without lists or with random ones.
    std::int64_t combinations() const;
};

/// Throws InputError with file, line and column for any violation of the format.
SweepPlan read_plan(const std::filesystem::path& file);

}  // namespace tumble
