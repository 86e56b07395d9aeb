#include "scene/keys/bodies.h"

#include "core/safe_text.h"
#include "scene/keys/arrays.h"
#include "scene/keys/body_values.h"
#include "scene/keys/fracture.h"
#include "scene/keys/posed_bodies.h"
#include "scene/keys/read_fields.h"
#include "scene/toml/limits.h"
#include "scene/toml/toml_reader.h"

#include <fmt/format.h>

#include <iterator>
#include <string>
#include <utility>

namespace tumble {
namespace {

/// "file" is no material unless the scene has one of that name: the colors of a mesh file, which it has without a color
/// of its own.
Material read_material(const TomlTable& table, const Shape& shape, const BodySources& sources) {
    const Materials& materials = sources.materials;
    Material material, own;
    const auto name = table.find("material");
    if (name && name->text() == "file" && !materials.contains("file")) {
        if (!mean_paint(shape))
            name->origin().fail("\"file\" is for meshes whose files have colors or materials, and this shape has none");
        for (const char* key : {"color", "colors"})
            if (const auto color = table.find(key)) color->origin().fail("and material = \"file\" exclude each other");
    } else if (name) {
        material = find_material(materials, *name);
    }
    read_material_keys(table, {sources.folder, sources.textures}, own);
    return overridden(material, own);
}

/// Names the bodies of one table: its name, copies with their number, or their index in the list of all bodies.
void name_bodies(const TomlTable& table, bool are_copies, std::size_t first_index, BodyNames& names,
                 std::vector<BodyDescription>& bodies) {
    const auto given = table.find("name");
    for (std::size_t i = 0; i < bodies.size(); ++i) {
        if (!given) {
            bodies[i].name = fmt::format("{}", first_index + i);
            continue;
        }
        if (are_copies) bodies[i].name = fmt::format("{}.{}", bodies[i].name, i);
        names.take(bodies[i].name, given->origin());
    }
}

/// Fails where the table and the columns of its file have the same value.
void check_poses(const TomlTable& table, const PosedBodies& posed) {
    constexpr std::pair<const char*, std::string_view> same[] = {{"name", "body"},
                                                                 {"position", "x,y,z"},
                                                                 {"rotation", "qw,qx,qy,qz"},
                                                                 {"velocity", "vx,vy,vz"},
                                                                 {"angular_velocity", "wx,wy,wz"}};
    for (const auto& [key, columns] : same)
        if (const auto value = table.find(key); value && posed.has(columns))
            value->origin().fail(
                fmt::format("and the columns ({}) of poses exclude each other: give one of them", columns));
}

/// The bodies of poses = "FILE.csv".
std::vector<BodyDescription> read_poses(const TomlTable& table, const TomlValue& value, const BodyDescription& model,
                                        std::size_t before, const BodySources& sources, BodyNames& names) {
    for (const char* key : {"grid", "scatter"})
        if (const auto other = table.find(key)) other->origin().fail("and poses exclude each other: give one of them");
    if (model.type == BodyType::kinematic)
        value.origin().fail("is for dynamic and fixed bodies (given a kinematic one)");
    if (endless(model.shape)) value.origin().fail("is for bodies of finite size (given a plane, which is endless)");
    std::filesystem::path file;
    const std::string text = read_named_file(value, "file of poses", sources, file);
    PosedBodies posed = read_posed_bodies(text, file.string(), model, names, std::int64_t(before));
    check_poses(table, posed);
    if (!posed.has("body")) name_bodies(table, true, before, names, posed.bodies);
    return std::move(posed.bodies);
}

}  // namespace

std::string read_named_file(const TomlValue& value, const std::string& what, const BodySources& sources,
                            std::filesystem::path& file) {
    const std::string name = value.text();
    if (name.empty()) value.fail("must not be empty");
    file = (sources.folder / std::filesystem::path(name)).lexically_normal();
    try {
        std::string text = read_toml_file(file, what, limits::scene_bytes);
        sources.files.push_back(file);
        return text;
    } catch (const InputError& error) {
        value.origin().fail(fmt::format("\"{}\": {}", safe_text(name, path_text_bytes), error.message()));
    }
}

BodyNames::BodyNames(const std::vector<BodyDescription>& bodies) {
    for (std::size_t i = 0; i < bodies.size(); ++i)
        if (bodies[i].name != std::to_string(i)) taken_.insert(bodies[i].name);
}

void BodyNames::take(const std::string& name, const SourcePosition& origin) {
    if (!taken_.insert(name).second)
        origin.fail(fmt::format("must be unique, and another body has it (given \"{}\")", safe_text(name)));
}

BodyDescription read_body_model(const TomlTable& table, BodyType type, ShapeRequest& shape,
                                const BodySources& sources) {
    Material material = read_material(table, shape.shape, sources);
    if (material.color || material.texture || material.normal_map || material.roughness_map || table.has("colors"))
        shape.shape = without_paint(shape.shape);
    else
        material.color = mean_paint(shape.shape);
    BodyDescription body;
    body.type = type;
    body.shape = shape.shape;
    read_fields(table, body);
    apply_material(material, body);
    shape.shape = body.shape;
    if (body.mass && table.has("density"))
        table.find("density")->origin().fail("and mass exclude each other: give one of them");
    check_motion(table, body);
    read_matter(table, body);
    read_fracture(table, material.fracture, body);
    if (const auto name = table.find("integrator"))
        body.integrator = name->choice(integrator_choices(sources.settings.method));
    return body;
}

void check_number_of_bodies(std::int64_t number, const SourcePosition& origin) {
    if (number > limits::bodies) {
        origin.fail(
            fmt::format("makes too many bodies: the limit of a scene is {} (given {} so far)", limits::bodies, number));
    }
}

std::vector<BodyDescription> read_bodies(const TomlTable& root, const BodySources& sources) {
    std::vector<BodyDescription> bodies;
    const auto list = root.find("body");
    if (!list) return bodies;
    BodyNames names({});
    std::uint64_t number = 0;
    const std::vector<std::string_view> known =
        list_keys<BodyDescription, CopyLooks, Material, FractureMaterial>().keys;
    for (TomlTable& table : list->tables("; write [[body]] for each")) {
        table.set_title("[[body]]");
        table.expect_keys(known);
        BodyType type = BodyType::dynamic;
        table.read<BodyType>("type", type, choices<BodyType>);
        ShapeRequest shape = read_shape(table.require("shape"), type, sources.folder, sources.meshes);
        const BodyDescription model = read_body_model(table, type, shape, sources);
        const auto copies = read_copies(table, type, shape);
        const auto poses = table.find("poses");
        check_number_of_bodies(static_cast<std::int64_t>(bodies.size()) + (copies ? number_of(*copies) : 1),
                               copies ? copies->origin : table.origin());
        std::vector<BodyDescription> made{model};
        if (copies) made = make_copies(*copies, model, shape, sources.meshes, sources.settings.seed, number);
        if (poses)
            made = read_poses(table, *poses, model, bodies.size(), sources, names);
        else
            name_bodies(table, copies.has_value(), bodies.size(), names, made);
        if (copies || poses)
            for (std::size_t i = 0; i < made.size(); ++i) vary_fracture(made[i], i);
        if (bodies.empty())
            bodies = std::move(made);
        else
            bodies.insert(bodies.end(), std::make_move_iterator(made.begin()), std::make_move_iterator(made.end()));
        ++number;
    }
    return bodies;
}

}  // namespace tumble
