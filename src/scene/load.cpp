#include "scene/load.h"

#include "scene/camera/camera.h"
#include "scene/keys/bodies.h"
#include "scene/keys/body_values.h"
#include "scene/keys/fracture.h"
#include "scene/keys/joints.h"
#include "scene/keys/materials.h"
#include "scene/keys/readers.h"
#include "scene/keys/templates.h"
#include "scene/mesh/mesh_loader.h"
#include "scene/toml/limits.h"
#include "scene/toml/set_values.h"
#include "scene/toml/toml_reader.h"

#include <fmt/format.h>

#include <limits>

namespace tumble {
namespace {

void check_format(const TomlTable& root) {
    constexpr std::int64_t readable = 1;
    const auto format = root.find("format");
    if (!format) throw InputError(root.origin().where, "a scene starts with \"format = 1\" (not given)");
    const std::int64_t number =
        format->integer(std::numeric_limits<std::int64_t>::min(), std::numeric_limits<std::int64_t>::max());
    if (number != readable) format->fail(fmt::format("must be {}, the only one there is", readable));
}

void check_method_of_joints(const TomlTable& root, const SceneDescription& scene) {
    if (scene.joints.empty() || scene.simulation.method != SimulationMethod::notes) return;
    for (const char* key : {"joint", "chain", "instance"})
        if (const auto list = root.find(key))
            list->fail("joins bodies, which the method of the notes cannot: give method = \"tumble\", or no joints");
}

void check_method_of_rolling(const TomlTable& root, const SceneDescription& scene) {
    if (scene.simulation.method != SimulationMethod::notes) return;
    for (const BodyDescription& body : scene.bodies)
        if (body.rolling_friction.value_or(0.0) > 0.0 || body.spinning_friction.value_or(0.0) > 0.0)
            root.require("body").origin().fail(
                "has rolling or spinning friction, which the method of the notes has not: give method = \"tumble\", or "
                "no such friction");
}

}  // namespace

SceneDescription parse_scene(const std::string& text, const std::filesystem::path& file,
                             const SceneOverrides& overrides, FileList* read, MeshImports imports,
                             MeshSupplier supplied) {
    toml::table document = parse_toml(text, file.string());
    set_values(document, overrides.set);
    const TomlTable root(document, {"scene", {file.string(), 1, 1}}, "a scene");
    check_format(root);
    root.expect_keys({"format",      "title", "simulation", "output",     "camera",    "cameras", "shot",    "light",
                      "environment", "wind",  "contact",    "materials",  "body",      "joint",   "chain",   "template",
                      "instance",    "force", "field",      "pair_force", "explosion", "cord",    "overlay", "caption",
                      "speed",       "label", "logo",       "inset",      "water"});

    SceneDescription scene;
    scene.file = file.string();
    root.read("title", scene.title);
    read_run_settings(root, overrides, scene.simulation, scene.output);
    read_lights(root, scene);
    FileList files;
    scene.environment = read_environment(root, file.parent_path(), files, imports);
    scene.wind = read_wind(root);
    scene.water = read_water(root, scene.simulation);
    scene.contact = read_contact(root);
    MeshCache meshes(imports, std::move(supplied));
    TextureFiles textures;
    const std::filesystem::path folder = file.parent_path();
    const Materials materials = read_materials(root, {folder, textures});
    std::optional<LogoDescription> logo = read_logo(root, {folder, textures});
    const BodySources sources{materials, folder, scene.simulation, meshes, textures, files};
    scene.bodies = read_bodies(root, sources);
    const SceneTemplates templates = read_templates(root, sources);
    read_instances(root, templates, sources, scene.bodies, scene.joints);
    read_chains(root, sources, scene.bodies, scene.joints);
    read_joints(root, scene.bodies, scene.joints);
    check_method_of_joints(root, scene);
    check_method_of_rolling(root, scene);
    check_layers(root, scene);
    if (read != nullptr) {
        read->push_back(file);
        read->insert(read->end(), files.begin(), files.end());
        read->insert(read->end(), meshes.files().begin(), meshes.files().end());
        read->insert(read->end(), textures.files().begin(), textures.files().end());
    }
    if (overrides.integrator)  // the option applies to every body
        for (BodyDescription& body : scene.bodies) body.integrator.reset();
    read_forces(root, scene);
    read_force_fields(root, scene);
    read_cords(root, scene);
    add_cords_of_joints(scene);
    scene.camera = read_camera(root, scene, overrides.camera);
    scene.overlay = read_overlay(root, scene.bodies, overrides);
    read_labels(root, std::move(logo), overrides, scene);
    read_speed(root, scene);
    append_pieces(scene);
    return scene;
}

std::string read_scene_text(const std::filesystem::path& file) {
    return read_toml_file(file, "scene", limits::scene_bytes);
}

SceneDescription load_scene(const std::filesystem::path& file, const SceneOverrides& overrides, FileList* read,
                            MeshImports imports) {
    return parse_scene(read_scene_text(file), file, overrides, read, imports);
}

}  // namespace tumble
