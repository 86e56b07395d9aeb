// A checked scene: the input of World and Renderer.
#pragma once

#include "error.h"
#include "spec.h"

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

TUMBLE_BEGIN

/// Values that replace those of a scene file, like the options of the command line. Each is checked like the file's
/// own.
struct LoadOptions {
    std::optional<double> duration;  // s
    std::optional<double> fps;       // frames per second
    std::optional<double> step;      // s; not together with steps_per_frame
    std::optional<int> steps_per_frame;
    std::optional<int> width, height;  // pixels
    std::optional<int> samples;        // 1, 2 or 4
    std::optional<Integrator> integrator;
    std::optional<ImpactMode> impacts;
    std::optional<ImpactLaw> impact_law;
    bool allow_import_process = false;  // for mesh files other than OBJ, STL, PLY and glTF: see below
};

struct SceneData;  // of the library

/// Immutable; copies share their data.
class Scene {
public:
    /// Checks the spec and loads its meshes. Throws Error (input) with the element that is wrong.
    explicit Scene(const SceneSpec& spec);

    const std::string& title() const;
    const OutputSettings& output() const;
    double duration() const;  // s
    double step() const;      // s, the fixed step
    int steps_per_frame() const;
    /// Frame n shows the time n / fps; the last one is at or before the duration.
    std::int64_t frame_count() const;

    /// Bodies in the order of the file, grids and scatters expanded. Throw Error (input) for an index of no body.
    std::size_t body_count() const;
    const std::string& body_name(std::size_t body) const;  // given, or the index
    BodyType body_type(std::size_t body) const;
    /// The index of the body of that name; empty where there is none.
    std::optional<std::size_t> find_body(const std::string& name) const;

    /// Joints in the order of the file, chains expanded. Throws Error (input) for an index of no joint.
    std::size_t joint_count() const;
    /// True if a body has a fracture table.
    bool breakable() const;
    const std::string& joint_name(std::size_t joint) const;  // given, or "joint" with the index

    /// True for a scene with [water].
    bool has_water() const;

    /// The scene file and the mesh files that were read.
    std::vector<std::string> files() const;

    // For the library.
    explicit Scene(std::shared_ptr<const SceneData> data);
    const SceneData& data() const;

private:
    std::shared_ptr<const SceneData> data_;
};

/// Reads a scene file and its meshes. Throws Error (input) with file, line and column. Mesh files other than OBJ, STL,
/// PLY and glTF can crash their importer. It runs in a child process, which is forked and ends before the function
/// returns; without allow_import_process such a file is an error.
Scene load_scene(const std::string& file, const LoadOptions& options = {});

TUMBLE_END
