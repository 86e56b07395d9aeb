#include "app/plots/quantities.h"

#include "core/error.h"
#include "core/safe_text.h"
#include "scene/toml/error_text.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>

namespace tumble {
namespace {

struct SceneQuantity {
    std::string_view name, label, panel;
    double (*value)(const Measurement&);
};
constexpr std::array scene_quantities{
    SceneQuantity{"kinetic", "kinetic", "energy (J)", [](const Measurement& m) { return m.kinetic; }},
    SceneQuantity{"potential", "potential", "energy (J)", [](const Measurement& m) { return m.potential; }},
    SceneQuantity{"total", "total", "energy (J)",
                  [](const Measurement& m) { return m.kinetic + m.potential + m.elastic; }},
    SceneQuantity{"momentum", "|P|", "momentum (kg m/s)", [](const Measurement& m) { return m.momentum.norm(); }},
    SceneQuantity{"angular-momentum", "|L|", "angular momentum (kg m²/s)",
                  [](const Measurement& m) { return m.angular_momentum.norm(); }},
    SceneQuantity{"contacts", "contacts", "contact points", [](const Measurement& m) { return double(m.contacts); }},
    SceneQuantity{"penetration", "penetration", "deepest penetration (m)",
                  [](const Measurement& m) { return m.max_penetration; }},
};

struct BodyQuantity {
    std::string_view name, panel;
    double (*value)(const BodyState&);
};
constexpr std::array body_quantities{
    BodyQuantity{"x", "x (m)", [](const BodyState& b) { return b.center_of_mass.x(); }},
    BodyQuantity{"y", "y (m)", [](const BodyState& b) { return b.center_of_mass.y(); }},
    BodyQuantity{"z", "z (m)", [](const BodyState& b) { return b.center_of_mass.z(); }},
    BodyQuantity{"vx", "v_x (m/s)", [](const BodyState& b) { return b.velocity.x(); }},
    BodyQuantity{"vy", "v_y (m/s)", [](const BodyState& b) { return b.velocity.y(); }},
    BodyQuantity{"vz", "v_z (m/s)", [](const BodyState& b) { return b.velocity.z(); }},
    BodyQuantity{"speed", "speed (m/s)", [](const BodyState& b) { return b.velocity.norm(); }},
    BodyQuantity{"wx", "ω_x (rad/s)", [](const BodyState& b) { return b.angular_velocity.x(); }},
    BodyQuantity{"wy", "ω_y (rad/s)", [](const BodyState& b) { return b.angular_velocity.y(); }},
    BodyQuantity{"wz", "ω_z (rad/s)", [](const BodyState& b) { return b.angular_velocity.z(); }},
    BodyQuantity{"spin", "|ω| (rad/s)", [](const BodyState& b) { return b.angular_velocity.norm(); }},
};

[[noreturn]] void fail(std::string_view name, const std::string& problem) {
    throw InputError(fmt::format("\"{}\": {}", safe_text(name), problem));
}

Quantity of_scene(const SceneQuantity& q) {
    return {std::string(q.label), std::string(q.panel),
            [value = q.value](const Sample& s) { return value(s.measurement); }, true};
}

/// "body.NAME.COMPONENT"; the name may have dots.
Quantity of_body(std::string_view text, const SceneDescription& scene) {
    const std::string_view path = text.substr(std::string_view("body.").size());
    const std::size_t dot = path.rfind('.');
    if (dot == std::string_view::npos || dot == 0) fail(text, "must be body.NAME.QUANTITY, as in body.ball.y");
    const std::string_view name = path.substr(0, dot), component = path.substr(dot + 1);
    const auto body = std::find_if(scene.bodies.begin(), scene.bodies.end(),
                                   [&](const BodyDescription& b) { return b.name == name; });
    if (body == scene.bodies.end()) {
        std::vector<std::string_view> names;
        for (const BodyDescription& b : scene.bodies) names.push_back(b.name);
        fail(text, fmt::format("no body has the name \"{}\"{}", safe_text(name), suggestion(name, names)));
    }
    const auto found = std::find_if(body_quantities.begin(), body_quantities.end(),
                                    [&](const BodyQuantity& q) { return q.name == component; });
    if (found == body_quantities.end()) {
        std::vector<std::string_view> names;
        for (const BodyQuantity& q : body_quantities) names.push_back(q.name);
        fail(text, fmt::format("a body has no quantity \"{}\"{}", safe_text(component), suggestion(component, names)));
    }
    const auto index = std::size_t(body - scene.bodies.begin());
    return {body->name, std::string(found->panel),
            [index, value = found->value](const Sample& s) { return value(s.snapshot.bodies[index]); }, false};
}

void add(std::string_view text, const SceneDescription& scene, std::vector<Quantity>& quantities) {
    if (text.starts_with("body.")) {
        quantities.push_back(of_body(text, scene));
        return;
    }
    bool known = false;
    for (const SceneQuantity& q : scene_quantities) {
        const bool part_of_energy = text == "energy" && q.panel == scene_quantities[0].panel;
        if (q.name != text && !part_of_energy) continue;
        quantities.push_back(of_scene(q));
        known = true;
    }
    if (known) return;
    std::vector<std::string_view> names{"energy"};
    for (const SceneQuantity& q : scene_quantities) names.push_back(q.name);
    fail(text, "unknown quantity" + suggestion(text, names) + "; of a body: body.NAME.y");
}

}  // namespace

std::vector<Quantity> parse_quantities(std::string_view list, const SceneDescription& scene) {
    std::vector<Quantity> quantities;
    while (true) {
        const std::size_t comma = list.find(',');
        const std::string_view text = list.substr(0, comma);
        if (text.empty()) fail(list, "has an empty name; write names separated by commas, as in energy,body.ball.y");
        add(text, scene, quantities);
        if (comma == std::string_view::npos) return quantities;
        list.remove_prefix(comma + 1);
    }
}

std::string quantity_help() {
    std::string of_scenes = "energy", of_bodies;
    for (const SceneQuantity& q : scene_quantities) of_scenes += fmt::format(" {}", q.name);
    for (const BodyQuantity& q : body_quantities) of_bodies += fmt::format(" {}", q.name);
    return fmt::format(
        "Quantities of a scene: {}\n(energy: kinetic, potential and total); of a body, body.NAME.{{...}}:{}", of_scenes,
        of_bodies);
}

}  // namespace tumble
