// A suite of golden images as plain values: the cases of a golden.toml, checked, with the place of each key for errors.
#pragma once

#include "app/composition/frame_layout.h"
#include "app/files/output_plan.h"
#include "compare/tolerances.h"
#include "core/error.h"
#include "scene/keys/overrides.h"
#include "scene/toml/toml_reader.h"

#include <cstdint>
#include <filesystem>
#include <functional>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace tumble {

/// A clip of which a few frames are kept, or a plot.
struct GoldenCase {
    std::string name;  // files of its references begin with it; no '/'
    SourceLocation where;
    std::map<std::string, SourceLocation, std::less<>> places;  // of its keys, of [defaults] as well

    std::vector<std::filesystem::path> scenes;  // a panel for each
    std::vector<std::int64_t> frames{0};        // ascending; of a plot: 0
    SceneOverrides overrides;
    std::vector<std::string> vary;  // "PATH=VALUE,VALUE"
    PanelArrangement arrangement = PanelArrangement::automatic;
    bool transparent = false;
    double speed = 1.0;                    // of the motion in the clip
    double shutter = 0.0;                  // degrees
    int blur_samples = 8;                  // images per frame while the shutter is open
    std::optional<std::string> of;         // quantities: the case is a plot of them
    std::optional<Tolerances> tolerances;  // instead of the suite's

    /// The place of a key, otherwise of the case.
    const SourceLocation& place_of(std::string_view key) const;
    /// "NAME_000045.png".
    std::string image_name(std::int64_t frame) const;
    /// "NAME.motion.json".
    std::string record_name() const { return name + ".motion.json"; }
};

struct GoldenSuite {
    std::filesystem::path file;
    std::filesystem::path references;  // folder
    Tolerances tolerances;
    std::vector<GoldenCase> cases;  // in the order of the file

    const GoldenCase* find(std::string_view name) const;
    /// Tolerances of the case, otherwise of the suite.
    const Tolerances& tolerances_of(const GoldenCase& golden) const;
    /// Tolerances of an image of a case (image_name()).
    PairTolerances tolerances_of(const std::string& image) const;
};

/// Throws InputError with file, line and column for any mistake. Scenes are not read.
GoldenSuite load_suite(const std::filesystem::path& file);
GoldenSuite parse_suite(const std::string& text, const std::filesystem::path& file);
/// The text of the file. Throws InputError if it cannot be read.
std::string read_suite_text(const std::filesystem::path& file);

/// Calls `action`, and gives its InputErrors without a place ("--fps: ...") that of the case's key.
void with_place_of(const GoldenCase& golden, const std::function<void()>& action);

// New cases in the text of a suite: the rest of the file stays as it was written.

/// A case of the command line.
struct NewCase {
    std::filesystem::path scene;
    std::optional<std::string> name;   // without this, the scene's file name
    std::vector<std::int64_t> frames;  // empty: the frames of [defaults], or the first one
    SceneOverrides overrides;
    bool transparent = false;
};

/// The suite's text with the case at its end; a new suite's if the file does not exist. Throws InputError for a mistake
/// in either.
std::string suite_text_with(const std::filesystem::path& suite, const NewCase& added);

// -- The keys of a case: [[case]] and [defaults] of a golden.toml.

/// Throws InputError at the first unknown key of [defaults].
void check_default_keys(const TomlTable& defaults);

/// A case of the table; keys that it does not have come from `defaults`. Relative scenes are relative to the folder of
/// the suite's file; its tolerances are the base of the case's.
GoldenCase read_case(const TomlTable& table, const std::optional<TomlTable>& defaults, const GoldenSuite& suite);

/// A table with the keys of tolerances.toml, or the name of such a file.
Tolerances read_tolerances(const TomlValue& value, const std::filesystem::path& folder,
                           const PairTolerances& base = {});

// -- The files of a suite: inputs, and the places of its references.

/// NAME, or PLATFORM/NAME, below the folder of the references.
std::filesystem::path reference_name(const std::string& name, const std::optional<std::string>& platform);

/// The suite's file, its tolerances and masks, the scenes of the cases with all that they read.
void add_suite_inputs(const GoldenSuite& suite, OutputPlan& plan);

/// The folder of the references, as an input.
void add_reference_inputs(const GoldenSuite& suite, OutputPlan& plan);

/// The references of the cases, as outputs. Throws InputError if one would not be below the folder of the references,
/// or if a link leads this folder out of that of the suite.
void add_references(const GoldenSuite& suite, std::span<const GoldenCase* const> cases,
                    const std::optional<std::string>& platform, OutputPlan& plan);

}  // namespace tumble
