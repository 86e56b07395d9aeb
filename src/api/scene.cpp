#include "tumble/scene.h"

#include "api/convert.h"
#include "api/enum_names.h"
#include "api/guard.h"
#include "api/scene_data.h"
#include "api/spec_text.h"
#include "presimulation/impact_focus.h"
#include "presimulation/motion_camera.h"
#include "scene/toml/limits.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <filesystem>

namespace tumble::v0 {
namespace {

namespace fs = std::filesystem;

std::shared_ptr<const SceneData> make_data(std::shared_ptr<const SceneDescription> description, FileList files) {
    auto data = std::make_shared<SceneData>();
    const auto& from = description->output;
    data->output = {from.width, from.height, from.fps, from.samples};
    data->description = std::move(description);
    data->files = std::move(files);
    return data;
}

template <class Options>
MeshImports imports_of(const Options& options) {
    return options.allow_import_process ? MeshImports::in_child_process : MeshImports::refused;
}

SceneOverrides to_overrides(const LoadOptions& options) {
    SceneOverrides o;
    o.duration = options.duration;
    o.fps = options.fps;
    o.step = options.step;
    o.steps_per_frame = options.steps_per_frame;
    o.width = options.width;
    o.height = options.height;
    o.samples = options.samples;
    if (options.integrator) o.integrator = name_of(*options.integrator);
    if (options.impacts) o.impacts = name_of(*options.impacts);
    if (options.impact_law) o.impact_law = name_of(*options.impact_law);
    return o;
}

/// "--steps-per-frame: must be ..." is about the field steps_per_frame.
Error option_error(const LoadOptions& options, const std::string& message) {
    const std::size_t end = message.find(": ");
    if (message.rfind("--", 0) != 0 || end == std::string::npos) return Error(ErrorKind::input, {}, message);
    std::string field = message.substr(2, end - 2);
    std::replace(field.begin(), field.end(), '-', '_');
    if (field == "size") {
        const bool width_fits = !options.width || (*options.width >= 1 && *options.width <= limits::image_side);
        field = width_fits ? "height" : "width";
    }
    return Error(ErrorKind::input, {{}, 0, 0, field}, message.substr(end + 2));
}

MeshFile mesh_of(const TriangleMesh::Arrays* arrays) {
    if (arrays == nullptr) throw MeshError("has no arrays");
    MeshFile mesh;
    mesh.check_more_positions(arrays->vertices.size());
    mesh.positions.reserve(arrays->vertices.size());
    for (const Vec3& vertex : arrays->vertices) mesh.add_position(to_internal(vertex));
    if (arrays->triangles.empty()) throw MeshError("has no triangles");
    for (std::size_t i = 0; i < arrays->triangles.size(); ++i) {
        std::array<MeshFile::Corner, 3> corners;
        for (std::size_t corner = 0; corner < 3; ++corner) {
            const std::uint32_t vertex = arrays->triangles[i][corner];
            if (vertex >= arrays->vertices.size())
                throw MeshError(fmt::format("has a wrong triangle, {}: a vertex must be below {} (given {})", i,
                                            arrays->vertices.size(), vertex));
            corners[corner].position = vertex;
        }
        mesh.add_triangle(corners);
    }
    return mesh;
}

std::shared_ptr<const SceneData> check(const SceneSpec& spec) {
    FileList files;
    const fs::path file = fs::path(spec.folder) / "scene";  // the folder counts; no such file is opened
    try {
        const SpecText made = spec_text(spec);
        const auto mesh = [&](std::size_t index) { return mesh_of(made.meshes.at(index).get()); };
        auto description = std::make_shared<const SceneDescription>(
            focused_on_impacts(parse_scene(made.text, file, {}, &files, imports_of(spec), mesh)));
        files.erase(files.begin());
        return make_data(std::move(description), std::move(files));
    } catch (const InputError& error) {
        throw Error(ErrorKind::input, {{}, 0, 0, element_of_line(spec, error.where().line)}, error.message());
    }
}

const BodyDescription& body_of(const SceneData& data, std::size_t body) {
    const auto& bodies = data.description->bodies;
    if (body < bodies.size()) return bodies[body];
    throw Error(ErrorKind::input, {}, fmt::format("a body's index must be below {} (given {})", bodies.size(), body));
}

}  // namespace

Scene::Scene(std::shared_ptr<const SceneData> data) : data_(std::move(data)) {}
Scene::Scene(const SceneSpec& spec) : data_(guarded([&] { return check(spec); })) {}

const std::unordered_map<std::string_view, std::size_t>& SceneData::names() const {
    std::call_once(named_, [&] {
        for (std::size_t i = 0; i < description->bodies.size(); ++i) names_.emplace(description->bodies[i].name, i);
    });
    return names_;
}

const SceneDescription& SceneData::drawn() const {
    std::call_once(framed_, [&] {
        drawn_ = description->camera.any_fits_motion() || description->camera.any_lags()
                     ? std::make_shared<const SceneDescription>(framed(*description, 1))
                     : description;
    });
    return *drawn_;
}

Scene make_scene(std::shared_ptr<const SceneDescription> description, FileList files) {
    return Scene(make_data(std::move(description), std::move(files)));
}

Scene load_scene(const std::string& file, const LoadOptions& options) {
    return guarded([&] {
        FileList files;
        try {
            auto description = std::make_shared<const SceneDescription>(
                focused_on_impacts(tumble::load_scene(file, to_overrides(options), &files, imports_of(options))));
            return make_scene(std::move(description), std::move(files));
        } catch (const InputError& error) {
            if (error.where().file.empty()) throw option_error(options, error.message());
            throw;
        }
    });
}

const SceneData& Scene::data() const {
    if (data_ == nullptr)
        throw Error(ErrorKind::input, {}, "this Scene was moved from: use the object that it was moved to");
    return *data_;
}

const std::string& Scene::title() const { return data().description->title; }
const OutputSettings& Scene::output() const { return data().output; }
double Scene::duration() const { return data().description->simulation.duration; }
double Scene::step() const { return data().description->step(); }
int Scene::steps_per_frame() const { return data().description->simulation.steps_per_frame; }
std::int64_t Scene::frame_count() const { return data().description->frame_count(); }
std::size_t Scene::body_count() const { return data().description->bodies.size(); }

const std::string& Scene::body_name(std::size_t body) const { return body_of(data(), body).name; }

BodyType Scene::body_type(std::size_t body) const {
    switch (body_of(data(), body).type) {
        case tumble::BodyType::fixed:
            return BodyType::fixed;
        case tumble::BodyType::kinematic:
            return BodyType::kinematic;
        default:
            return BodyType::dynamic;
    }
}

std::optional<std::size_t> Scene::find_body(const std::string& name) const {
    const auto found = data().names().find(name);
    if (found == data().names().end()) return std::nullopt;
    return found->second;
}

bool Scene::breakable() const {
    return std::ranges::any_of(data().description->bodies, [](const auto& body) { return body.fracture != nullptr; });
}

std::size_t Scene::joint_count() const { return data().description->joints.size(); }

bool Scene::has_water() const { return data().description->water.has_value(); }

const std::string& Scene::joint_name(std::size_t joint) const {
    const auto& joints = data().description->joints;
    if (joint < joints.size()) return joints[joint].name;
    throw Error(ErrorKind::input, {}, fmt::format("a joint's index must be below {} (given {})", joints.size(), joint));
}

std::vector<std::string> Scene::files() const { return {data().files.begin(), data().files.end()}; }

}  // namespace tumble::v0
