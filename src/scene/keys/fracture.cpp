#include "scene/keys/fracture.h"

#include "core/safe_text.h"
#include "scene/fracture/cut_body.h"
#include "scene/keys/bodies.h"
#include "scene/keys/read_fields.h"
#include "sim/geometry/shapes/shape.h"

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <iterator>
#include <memory>
#include <set>
#include <string>
#include <utility>

namespace tumble {
namespace {

constexpr double usual_shear = 1.6;         // of the strength: of glass and stone
constexpr double usual_stiffness = 1000.0;  // of the strength: brittle matter fails at strains of a thousandth or less
constexpr double usual_toughness = 10.0;    // J/m^2, of glass

constexpr std::array<Choice<std::size_t>, 6> side_names{
    {{"-x", 0}, {"+x", 1}, {"-y", 2}, {"+y", 3}, {"-z", 4}, {"+z", 5}}};

void read_held(const TomlTable& table, BodyType type, std::array<bool, 6>& held) {
    const auto given = table.find("held");
    if (!given) return;
    if (type == BodyType::dynamic)
        given->origin().fail("is for fixed and kinematic bodies: nothing holds a dynamic one to the world");
    held = {};
    for (const TomlValue& side : given->items()) held[side.choice<std::size_t>(side_names)] = true;
    if (held == std::array<bool, 6>{}) given->fail("must name at least one side");
}

void read_focus(const TomlTable& table, FractureRequest& fracture) {
    const auto given = table.find("focus");
    if (!given) return;
    if (!given->is_text()) {
        fracture.focus = given->vector(limits::coordinate);
        return;
    }
    if (given->text() != "impact")
        given->fail(fmt::format("must be a point or \"impact\" (given \"{}\")", safe_text(given->text())));
    fracture.focus_at_impact = true;
}

/// Keys that another pattern or another type of body has.
void check_pattern(const TomlTable& table, FracturePattern pattern) {
    if (const auto axis = table.find("axis"); axis && pattern != FracturePattern::slabs)
        axis->origin().fail("is for pattern = \"slabs\"");
    if (const auto focus = table.find("focus");
        focus && pattern != FracturePattern::radial && pattern != FracturePattern::voronoi)
        focus->origin().fail("is for pattern = \"radial\" or \"voronoi\"");
}

double usual_blow_time(const BodyDescription& body, double stiffness) {
    const double way = local_bounds(body.shape).extent().norm();
    const MassProperties solid = mass_properties(body);
    const double volume = mass_properties(body.shape, body.density).mass / body.density;
    return 2.0 * way / std::sqrt(stiffness * volume / solid.mass);
}

template <class Change>
void change_fracture(BodyDescription& body, const Change& change) {
    if (!body.fracture) return;
    auto changed = std::make_shared<FractureDescription>(*body.fracture);
    change(*changed);
    body.fracture = std::move(changed);
}

}  // namespace

void read_fracture(const TomlTable& table, const FractureMaterial& material, BodyDescription& body) {
    const auto given = table.find("fracture");
    if (!given) return;
    if (endless(body.shape)) given->origin().fail("is for bodies of finite size (given a plane, which is endless)");
    TomlTable keys = given->table();
    keys.set_title("fracture");
    FractureDescription fracture;
    static_cast<FractureRequest&>(fracture) = read_all_fields<FractureRequest>(keys);
    read_focus(keys, fracture);
    read_held(keys, body.type, fracture.held);
    check_pattern(keys, fracture.pattern);
    if (!material.strength)
        given->origin().fail(
            "needs a strength, in Pa, of the body or of its material: glass has 30e6, concrete 3e6, dry clay 0.5e6");
    fracture.strength = *material.strength;
    fracture.shear_strength = material.shear_strength.value_or(usual_shear * fracture.strength);
    fracture.compressive_strength = material.compressive_strength.value_or(0.0);
    fracture.stiffness = material.stiffness.value_or(usual_stiffness * fracture.strength);
    fracture.toughness = material.toughness.value_or(usual_toughness);
    fracture.blow_time = material.blow_time.value_or(0.0);
    fracture.inner_color = material.inner_color;
    fracture.where = given->origin().where;
    body.fracture = std::make_shared<const FractureDescription>(std::move(fracture));
}

void enlarge_fracture(BodyDescription& body, double factor) {
    change_fracture(body, [&](FractureDescription& fracture) {
        if (fracture.focus) *fracture.focus *= factor;
        if (fracture.smallest) *fracture.smallest *= factor;
    });
}

void vary_fracture(BodyDescription& body, std::uint64_t i) {
    if (i > 0) change_fracture(body, [&](FractureDescription& fracture) { fracture.seed += i; });
}

void append_pieces(SceneDescription& scene) {
    const std::size_t wholes = scene.bodies.size();
    std::set<std::string> names;
    std::size_t all = 0;
    for (std::size_t i = 0; i < wholes; ++i) {
        if (!scene.bodies[i].fracture) continue;
        auto fracture = std::make_shared<FractureDescription>(*scene.bodies[i].fracture);
        const SourcePosition origin{"fracture", fracture->where};
        if (scene.simulation.method == SimulationMethod::notes)
            origin.fail("is unknown to the method of the notes: give method = \"tumble\"");
        if (names.empty())
            for (const BodyDescription& body : scene.bodies) names.insert(body.name);
        CutBody cut;
        try {
            cut = cut_body(scene.bodies[i], scene.simulation.seed);
        } catch (const InputError& error) {
            origin.fail(error.message());
        }
        all += cut.pieces.size();
        if (all > limits::fracture_pieces)
            origin.fail(fmt::format("makes too many pieces: the limit of a scene is {} (given {} so far)",
                                    limits::fracture_pieces, all));
        check_number_of_bodies(std::int64_t(scene.bodies.size() + cut.pieces.size()), origin);
        const std::string name = scene.bodies[i].name;
        for (std::size_t k = 0; k < cut.pieces.size(); ++k) {
            cut.pieces[k].name = fmt::format("{}/{}", name, k);
            cut.pieces[k].piece_of = i;
            if (names.contains(cut.pieces[k].name))
                origin.fail(fmt::format("makes a piece \"{}\", and a body has this name: give the body another one",
                                        safe_text(cut.pieces[k].name)));
        }
        if (fracture->blow_time == 0.0) fracture->blow_time = usual_blow_time(scene.bodies[i], fracture->stiffness);
        fracture->first_piece = scene.bodies.size();
        fracture->pieces = cut.pieces.size();
        fracture->bonds = std::move(cut.bonds);
        scene.bodies[i].fracture = std::move(fracture);
        std::move(cut.pieces.begin(), cut.pieces.end(), std::back_inserter(scene.bodies));
    }
}

void cut_again(SceneDescription& scene) {
    std::erase_if(scene.bodies, [](const BodyDescription& body) { return body.piece_of.has_value(); });
    append_pieces(scene);
}

}  // namespace tumble
