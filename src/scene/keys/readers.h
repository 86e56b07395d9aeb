// Readers of the tables of a scene file that load.cpp calls, one after the other.
#pragma once

#include "scene/description/description.h"
#include "scene/keys/bodies.h"
#include "scene/keys/materials.h"
#include "scene/keys/overrides.h"
#include "scene/mesh/mesh_file.h"
#include "scene/toml/toml_reader.h"

#include <filesystem>
#include <optional>
#include <vector>

namespace tumble {

// -- [simulation], [output], [light], [wind] and [water]. For the first two, the file and the command line are merged
// first, each value with its source, and checked together after that: a step that fits the file's fps may not fit that
// of
// --fps.

/// Reads both tables (either may be missing) with the overrides.
void read_run_settings(const TomlTable& root, const SceneOverrides& overrides, SimulationSettings& simulation,
                       OutputSettings& output);

/// [light], or all of [[light]] with the one that has shadows as the light.
void read_lights(const TomlTable& root, SceneDescription& scene);
std::optional<WindDescription> read_wind(const TomlTable& root);
/// After the simulation, whose gravity makes the surface level.
std::optional<WaterDescription> read_water(const TomlTable& root, const SimulationSettings& simulation);
PairRules read_contact(const TomlTable& root);

// -- [environment].

/// `folder`: of the scene. Adds the image file to `files`.
std::optional<EnvironmentDescription> read_environment(const TomlTable& root, const std::filesystem::path& folder,
                                                       std::vector<std::filesystem::path>& files, MeshImports imports);

// -- [[chain]]: a row of equal bodies, each joined to the next.

/// Appends the links NAME.0, NAME.1, ... of all chains, and their joints: NAME.i is at the start of link i.
void read_chains(const TomlTable& root, const BodySources& sources, std::vector<BodyDescription>& bodies,
                 std::vector<JointDescription>& joints);

// -- [[force]] and [[cord]]: forces at points of bodies, and drawn cords.

/// Both refer to bodies and joints by name. Precondition: `scene` has its bodies and joints.
void read_forces(const TomlTable& root, SceneDescription& scene);
void read_cords(const TomlTable& root, SceneDescription& scene);

/// Appends a cord for each joint that is visible.
void add_cords_of_joints(SceneDescription& scene);

// -- [[field]], [[pair_force]] and [[explosion]].

/// Reads all three, after the bodies.
void read_force_fields(const TomlTable& root, SceneDescription& scene);

// -- The tables [overlay] and [[caption]], and the options that take their place.

/// `bodies`: all bodies of the scene, which the table may name.
OverlayDescription read_overlay(const TomlTable& root, const std::vector<BodyDescription>& bodies,
                                const SceneOverrides& overrides);

// -- [[label]] and [logo].

/// The logo of the file; reads its image.
std::optional<LogoDescription> read_logo(const TomlTable& root, const TextureSource& textures);

/// Labels and logo of the overlay. Precondition: `scene` has its bodies and its overlay.
void read_labels(const TomlTable& root, std::optional<LogoDescription> logo, const SceneOverrides& overrides,
                 SceneDescription& scene);

// -- [[speed]]: slow motion and stops of a clip.

/// Refers to bodies by name. Precondition: `scene` has its bodies.
void read_speed(const TomlTable& root, SceneDescription& scene);

}  // namespace tumble
