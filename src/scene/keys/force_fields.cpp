#include "scene/keys/readers.h"

#include "core/safe_text.h"
#include "scene/fields/force_fields.h"
#include "scene/keys/body_index.h"
#include "scene/keys/read_fields.h"

#include <fmt/format.h>

#include <algorithm>
#include <span>
#include <string>
#include <vector>

namespace tumble {
namespace {

/// A key that some types alone have.
struct KeyOfTypes {
    std::string_view key;
    std::uint32_t types, required;  // bits
};

template <class Enum>
constexpr std::uint32_t bits(auto... types) {
    return ((1u << unsigned(types)) | ...);
}

template <class Enum>
void check_keys(const TomlTable& table, Enum type, std::span<const KeyOfTypes> keys) {
    const std::uint32_t bit = 1u << unsigned(type);
    std::string_view name;
    for (const auto& choice : choices<Enum>)
        if (choice.value == type) name = choice.name;
    for (const auto& [key, types, required] : keys) {
        if ((required & bit) != 0) table.require(key);
        if (const auto given = table.find(key); given && (types & bit) == 0)
            given->origin().fail(fmt::format("is a key of another type than \"{}\"", name));
    }
}

// `enabled = [from]` or `[from, until]`.
template <class Description>
void read_span(const TomlTable& table, Description& description) {
    description.end = infinity;
    const auto value = table.find("enabled");
    if (!value) return;
    const auto time = value->items();
    if (time.empty() || time.size() > 2) value->fail("must be an array of one or two numbers, from and until");
    description.start = time[0].number(limits::time);
    if (time.size() == 2) description.end = time[1].number(limits::time);
    if (description.end <= description.start) value->fail("must end after it starts");
}

FieldRegion read_region(const TomlValue& value) {
    TomlTable table = value.table();
    table.set_title("a region");
    FieldRegion region = read_all_fields<FieldRegion>(table);
    const auto box = table.find("box"), sphere = table.find("sphere");
    if (box && sphere) box->origin().fail("and sphere exclude each other: give one of them");
    if (!box && !sphere) value.origin().fail("needs a box or a sphere (not given)");
    region.kind = box ? RegionKind::box : RegionKind::sphere;
    return region;
}

void read_fields_of(const TomlTable& root, SceneDescription& scene) {
    using enum FieldKind;
    constexpr std::uint32_t centered = bits<FieldKind>(point, vortex);
    constexpr KeyOfTypes keys[] = {{"acceleration", bits<FieldKind>(uniform), bits<FieldKind>(uniform)},
                                   {"center", centered, 0},
                                   {"axis", bits<FieldKind>(vortex), 0},
                                   {"strength", centered, centered},
                                   {"softening", centered, 0},
                                   {"velocity", bits<FieldKind>(drag), 0},
                                   {"linear", bits<FieldKind>(drag), 0},
                                   {"quadratic", bits<FieldKind>(drag), 0}};
    const auto list = root.find("field");
    if (!list) return;
    for (TomlTable& table : list->tables("; write [[field]] for each")) {
        table.set_title("[[field]]");
        FieldDescription field = read_all_fields<FieldDescription>(table);
        check_keys(table, field.type, keys);
        if (field.type == drag && !table.has("linear") && !table.has("quadratic"))
            table.require("type").origin().fail("\"drag\" needs linear or quadratic (not given)");
        if (const auto region = table.find("region")) field.region = read_region(*region);
        read_span(table, field);
        scene.fields.push_back(field);
    }
}

// The body of the name, or the copies NAME.0, NAME.1, ...
std::vector<std::size_t> bodies_named(const TomlValue& value, const BodyIndex& bodies, const SceneDescription& scene) {
    const std::string name = value.text();
    std::vector<std::size_t> found;
    if (!bodies.has(name)) {
        for (std::size_t i = 0; i < scene.bodies.size(); ++i) {
            const std::string& other = scene.bodies[i].name;
            if (!other.starts_with(name) || other.size() < name.size() + 2 || other[name.size()] != '.') continue;
            if (other.find_first_not_of("0123456789", name.size() + 1) == std::string::npos) found.push_back(i);
        }
    }
    return found.empty() ? std::vector{bodies.find(value)} : found;
}

void read_bodies_of(const TomlTable& table, const BodyIndex& index, const SceneDescription& scene,
                    PairForceDescription& force) {
    const TomlValue bodies = table.require("bodies");
    const std::vector<TomlValue> names = bodies.items();
    std::vector<double> charges;
    if (const auto given = table.find("charges")) {
        for (const TomlValue& one : given->items()) charges.push_back(one.number(limits::charge));
        if (charges.size() != names.size())
            given->fail(fmt::format("must have one charge for each of the {} entries of bodies, not {}", names.size(),
                                    charges.size()));
    }
    std::vector<Vec3> moments;
    if (const auto given = table.find("moments")) {
        for (const TomlValue& one : given->items()) moments.push_back(one.vector(limits::magnetic_moment));
        if (moments.size() != names.size())
            given->fail(fmt::format("must have one moment for each of the {} entries of bodies, not {}", names.size(),
                                    moments.size()));
        if (std::all_of(moments.begin(), moments.end(), [](const Vec3& m) { return m.isZero(0.0); }))
            given->fail("must not all be zero");
    }
    for (std::size_t k = 0; k < names.size(); ++k)
        for (const std::size_t body : bodies_named(names[k], index, scene)) {
            if (std::find(force.bodies.begin(), force.bodies.end(), body) != force.bodies.end())
                names[k].fail(fmt::format("names '{}' again", safe_text(scene.bodies[body].name)));
            if (force.type == PairForceKind::gravity && !scene.bodies[body].dynamic())
                names[k].fail("must be a dynamic body: others have no mass; give a [[field]] with type = \"point\"");
            if (endless(scene.bodies[body].shape)) names[k].fail("must have a center: a plane has none");
            force.bodies.push_back(body);
            if (!charges.empty()) force.charges.push_back(charges[k]);
            if (!moments.empty()) force.moments.push_back(moments[k]);
        }
    if (force.bodies.size() < 2) bodies.fail("must name two bodies or more");
    if (force.bodies.size() > limits::pair_force_bodies)
        bodies.fail(fmt::format("must name at most {} bodies, not {}", limits::pair_force_bodies, force.bodies.size()));
    if (std::none_of(force.bodies.begin(), force.bodies.end(),
                     [&](std::size_t body) { return scene.bodies[body].dynamic(); }))
        bodies.fail("must name a dynamic body: no force moves another");
}

void read_pair_forces(const TomlTable& root, SceneDescription& scene) {
    using enum PairForceKind;
    constexpr std::uint32_t springs = bits<PairForceKind>(spring), others = ~springs;
    constexpr KeyOfTypes keys[] = {{"strength", others, bits<PairForceKind>(inverse_square)},
                                   {"softening", others, 0},
                                   {"charges", bits<PairForceKind>(coulomb), bits<PairForceKind>(coulomb)},
                                   {"moments", bits<PairForceKind>(dipole), bits<PairForceKind>(dipole)},
                                   {"stiffness", springs, springs},
                                   {"damping", springs, 0},
                                   {"length", springs, 0}};
    constexpr double gravitation = 6.6743e-11;                 // m^3/(kg s^2), CODATA 2018
    constexpr double coulomb_constant = 8.9875517873681764e9;  // N m^2/C^2
    constexpr double magnetic_constant = 1e-7;                 // N/A^2, mu_0 / (4 pi)
    const auto list = root.find("pair_force");
    if (!list) return;
    const BodyIndex bodies(scene.bodies);
    for (TomlTable& table : list->tables("; write [[pair_force]] for each")) {
        table.set_title("[[pair_force]]");
        PairForceDescription force = read_all_fields<PairForceDescription>(table);
        check_keys(table, force.type, keys);
        if (!table.has("strength"))
            force.strength = force.type == coulomb  ? coulomb_constant
                             : force.type == dipole ? magnetic_constant
                                                    : gravitation;
        read_bodies_of(table, bodies, scene, force);
        read_span(table, force);
        scene.pair_forces.push_back(force);
    }
}

void read_explosions(const TomlTable& root, SceneDescription& scene) {
    const auto list = root.find("explosion");
    if (!list) return;
    for (TomlTable& table : list->tables("; write [[explosion]] for each")) {
        table.set_title("[[explosion]]");
        scene.explosions.push_back(read_all_fields<ExplosionDescription>(table));
    }
}

}  // namespace

void read_force_fields(const TomlTable& root, SceneDescription& scene) {
    for (const char* key : {"field", "pair_force", "explosion"})
        if (const auto list = root.find(key); list && scene.simulation.method == SimulationMethod::notes)
            list->origin().fail("is unknown to the method of the notes: give method = \"tumble\"");
    read_fields_of(root, scene);
    read_pair_forces(root, scene);
    read_explosions(root, scene);
}

}  // namespace tumble
