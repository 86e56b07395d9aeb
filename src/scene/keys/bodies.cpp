#include "scene/keys/bodies.h"

#include "core/safe_text.h"
#include "scene/keys/arrays.h"
#include "scene/keys/motion.h"
#include "scene/keys/settings.h"
#include "scene/toml/limits.h"

#include <fmt/format.h>

#include <iterator>
#include <set>
#include <string>

namespace tumble {
namespace {

constexpr Choice<BodyType> body_types[] = {
    {"dynamic", BodyType::dynamic},
    {"fixed", BodyType::fixed},
    {"kinematic", BodyType::kinematic},
};

Material read_material(const TomlTable& table, const Materials& materials) {
    Material material;
    if (const auto name = table.find("material")) material = find_material(materials, *name);
    return material.overridden_by(read_material_keys(table));
}

void read_mass(const TomlTable& table, BodyDescription& body) {
    table.read("mass", body.mass, limits::mass);
    if (body.mass && table.has("density")) {
        table.find("density")->origin().fail("and mass exclude each other: give one of them");
    }
}

/// The body described by its table; the model of all copies of a grid or a scatter.
BodyDescription read_model(const TomlTable& table, const Materials& materials, BodyType type, const Shape& shape,
                           SimulationMethod method) {
    BodyDescription body;
    body.type = type;
    body.shape = shape;
    table.read("name", body.name);
    if (table.has("name") && body.name.empty()) table.find("name")->fail("must not be empty");
    apply_material(read_material(table, materials), body);
    table.read("visible", body.appearance.visible);
    read_mass(table, body);
    read_motion(table, body);
    if (const auto name = table.find("integrator")) body.integrator = name->choice(integrator_choices(method));
    return body;
}

/// Names the bodies of one table, and rejects duplicate given names.
class Names {
public:
    void give(const TomlTable& table, bool are_copies, std::size_t first_index, std::vector<BodyDescription>& bodies) {
        const auto given = table.find("name");
        for (std::size_t i = 0; i < bodies.size(); ++i) {
            if (!given) {
                bodies[i].name = fmt::format("{}", first_index + i);
                continue;
            }
            if (are_copies) bodies[i].name = fmt::format("{}.{}", bodies[i].name, i);
            if (!taken_.insert(bodies[i].name).second) {
                given->origin().fail(
                    fmt::format("must be unique, and another body has it (given \"{}\")", safe_text(bodies[i].name)));
            }
        }
    }

private:
    std::set<std::string> taken_;
};

}  // namespace

std::vector<BodyDescription> read_bodies(const TomlTable& root, const Materials& materials,
                                         const std::filesystem::path& folder, const SimulationSettings& settings,
                                         MeshCache& meshes) {
    std::vector<BodyDescription> bodies;
    const auto list = root.find("body");
    if (!list) return bodies;
    Names names;
    std::uint64_t number = 0;
    for (TomlTable& table : list->tables("; write [[body]] for each")) {
        table.set_title("[[body]]");
        table.expect_keys({"name",
                           "type",
                           "shape",
                           "material",
                           "color",
                           "roughness",
                           "metallic",
                           "pattern",
                           "visible",
                           "density",
                           "mass",
                           "restitution",
                           "friction",
                           "position",
                           "rotation",
                           "velocity",
                           "angular_velocity",
                           "keyframes",
                           "interpolation",
                           "integrator",
                           "grid",
                           "scatter",
                           "scale",
                           "colors"});
        BodyType type = BodyType::dynamic;
        table.read<BodyType>("type", type, body_types);
        const ShapeRequest shape = read_shape(table.require("shape"), type, folder, meshes);
        const BodyDescription model = read_model(table, materials, type, shape.shape, settings.method);
        const auto copies = read_copies(table, type, shape);

        const std::int64_t total = static_cast<std::int64_t>(bodies.size()) + (copies ? number_of(*copies) : 1);
        if (total > limits::bodies) {
            (copies ? copies->origin : table.origin())
                .fail(fmt::format("makes too many bodies: the limit of a scene is {} (given {} so far)", limits::bodies,
                                  total));
        }
        std::vector<BodyDescription> made{model};
        if (copies) made = make_copies(*copies, model, shape, meshes, settings.seed, number);
        names.give(table, copies.has_value(), bodies.size(), made);
        bodies.insert(bodies.end(), std::make_move_iterator(made.begin()), std::make_move_iterator(made.end()));
        ++number;
    }
    return bodies;
}

}  // namespace tumble
