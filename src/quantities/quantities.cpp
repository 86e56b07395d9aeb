#include "quantities/quantities.h"

#include "core/error.h"
#include "core/safe_text.h"
#include "quantities/quantity_texts.h"
#include "scene/toml/error_text.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <optional>

namespace tumble {
namespace {

// Names, texts and units are in quantity_texts.json, which pages have as well. A name that is not there does not
// compile.
template <class Item, std::size_t n>
consteval Item texts_of(const Item (&items)[n], std::string_view name) {
    for (const Item& item : items)
        if (item.name == name) return item;
    throw "not in quantity_texts.json";
}

template <class Item>
std::string panel_of(const Item& texts) {
    return texts.unit.empty() ? std::string(texts.axis) : fmt::format("{} ({})", texts.axis, texts.unit);
}

struct SceneQuantity : style::scene_quantities_item {
    double (*value)(const Measurement&);
};
consteval auto scene(std::string_view name) { return texts_of(style::scene_quantities, name); }
constexpr std::array scene_quantities{
    SceneQuantity{scene("kinetic"), [](const Measurement& m) { return m.kinetic; }},
    SceneQuantity{scene("potential"), [](const Measurement& m) { return m.potential; }},
    SceneQuantity{scene("total"), [](const Measurement& m) { return m.kinetic + m.potential + m.elastic; }},
    SceneQuantity{scene("momentum"), [](const Measurement& m) { return m.momentum.norm(); }},
    SceneQuantity{scene("angular-momentum"), [](const Measurement& m) { return m.angular_momentum.norm(); }},
    SceneQuantity{scene("contacts"), [](const Measurement& m) { return double(m.contacts); }},
    SceneQuantity{scene("penetration"), [](const Measurement& m) { return m.max_penetration; }},
};

struct BodyQuantity : style::body_quantities_item {
    double (*value)(const BodyState&);
};
consteval auto body(std::string_view name) { return texts_of(style::body_quantities, name); }
constexpr std::array body_quantities{
    BodyQuantity{body("x"), [](const BodyState& b) { return b.center_of_mass.x(); }},
    BodyQuantity{body("y"), [](const BodyState& b) { return b.center_of_mass.y(); }},
    BodyQuantity{body("z"), [](const BodyState& b) { return b.center_of_mass.z(); }},
    BodyQuantity{body("vx"), [](const BodyState& b) { return b.velocity.x(); }},
    BodyQuantity{body("vy"), [](const BodyState& b) { return b.velocity.y(); }},
    BodyQuantity{body("vz"), [](const BodyState& b) { return b.velocity.z(); }},
    BodyQuantity{body("speed"), [](const BodyState& b) { return b.velocity.norm(); }},
    BodyQuantity{body("wx"), [](const BodyState& b) { return b.angular_velocity.x(); }},
    BodyQuantity{body("wy"), [](const BodyState& b) { return b.angular_velocity.y(); }},
    BodyQuantity{body("wz"), [](const BodyState& b) { return b.angular_velocity.z(); }},
    BodyQuantity{body("spin"), [](const BodyState& b) { return b.angular_velocity.norm(); }},
};

struct JointQuantity : style::joint_quantities_item {
    double (*value)(const JointState&);
    std::optional<std::size_t> coordinate = {};  // index into JointState::free
    bool mean_of_frame = false;
};
consteval auto joint(std::string_view name) { return texts_of(style::joint_quantities, name); }
// The columns of `simulate --joints`, and the lengths of force and torque.
constexpr std::array joint_quantities{
    JointQuantity{joint("move_x"), [](const JointState& j) { return j.position[0]; }, 0},
    JointQuantity{joint("move_y"), [](const JointState& j) { return j.position[1]; }, 1},
    JointQuantity{joint("move_z"), [](const JointState& j) { return j.position[2]; }, 2},
    JointQuantity{joint("turn_x"), [](const JointState& j) { return j.position[3]; }, 3},
    JointQuantity{joint("turn_y"), [](const JointState& j) { return j.position[4]; }, 4},
    JointQuantity{joint("turn_z"), [](const JointState& j) { return j.position[5]; }, 5},
    JointQuantity{joint("move_x_speed"), [](const JointState& j) { return j.speed[0]; }, 0},
    JointQuantity{joint("move_y_speed"), [](const JointState& j) { return j.speed[1]; }, 1},
    JointQuantity{joint("move_z_speed"), [](const JointState& j) { return j.speed[2]; }, 2},
    JointQuantity{joint("turn_x_speed"), [](const JointState& j) { return j.speed[3]; }, 3},
    JointQuantity{joint("turn_y_speed"), [](const JointState& j) { return j.speed[4]; }, 4},
    JointQuantity{joint("turn_z_speed"), [](const JointState& j) { return j.speed[5]; }, 5},
    JointQuantity{joint("force"), [](const JointState& j) { return j.mean_force.norm(); }, {}, true},
    JointQuantity{joint("fx"), [](const JointState& j) { return j.mean_force.x(); }, {}, true},
    JointQuantity{joint("fy"), [](const JointState& j) { return j.mean_force.y(); }, {}, true},
    JointQuantity{joint("fz"), [](const JointState& j) { return j.mean_force.z(); }, {}, true},
    JointQuantity{joint("torque"), [](const JointState& j) { return j.mean_torque.norm(); }, {}, true},
    JointQuantity{joint("tx"), [](const JointState& j) { return j.mean_torque.x(); }, {}, true},
    JointQuantity{joint("ty"), [](const JointState& j) { return j.mean_torque.y(); }, {}, true},
    JointQuantity{joint("tz"), [](const JointState& j) { return j.mean_torque.z(); }, {}, true},
    JointQuantity{joint("gap"), [](const JointState& j) { return j.gap; }},
};

[[noreturn]] void fail(std::string_view name, const std::string& problem) {
    throw InputError(fmt::format("\"{}\": {}", safe_text(name), problem));
}

template <class Items>
std::vector<std::string_view> names_of(const Items& items) {
    std::vector<std::string_view> names;
    for (const auto& item : items) names.push_back(item.name);
    return names;
}

Quantity of_scene(const SceneQuantity& q) {
    return {.name = std::string(q.name),
            .label = std::string(q.curve),
            .panel = panel_of(q),
            .value = [value = q.value](const Sample& s) { return value(s.survey.measurement); },
            .needs = {.measurement = true}};
}

template <class Part, class PartQuantity>
struct Found {
    std::size_t index;  // of the body or joint
    const Part& part;
    const PartQuantity& quantity;
};

/// "KIND.NAME.QUANTITY"; the name may have dots.
template <class Part, class PartQuantity, std::size_t n>
Found<Part, PartQuantity> find_part(std::string_view text, std::string_view kind, const std::vector<Part>& parts,
                                    const std::array<PartQuantity, n>& quantities) {
    const std::string_view path = text.substr(kind.size() + 1);
    const std::size_t dot = path.rfind('.');
    if (dot == std::string_view::npos || dot == 0)
        fail(text, fmt::format("must be {0}.NAME.QUANTITY, as in {0}.{1}.{2}", kind,
                               parts.empty() ? "NAME" : safe_text(parts.front().name), quantities[0].name));
    const std::string_view name = path.substr(0, dot), component = path.substr(dot + 1);
    const auto part = std::ranges::find(parts, name, &Part::name);
    if (part == parts.end())
        fail(text,
             fmt::format("no {} has the name \"{}\"{}", kind, safe_text(name), suggestion(name, names_of(parts))));
    const auto quantity = std::ranges::find(quantities, component, &PartQuantity::name);
    if (quantity == quantities.end())
        fail(text, fmt::format("a {} has no quantity \"{}\"{}", kind, safe_text(component),
                               suggestion(component, names_of(quantities))));
    return {std::size_t(part - parts.begin()), *part, *quantity};
}

Quantity of_body(std::string_view text, const SceneDescription& scene) {
    const auto found = find_part(text, "body", scene.bodies, body_quantities);
    return {.name = std::string(text),
            .label = found.part.name,
            .panel = panel_of(found.quantity),
            .value = [index = found.index,
                      value = found.quantity.value](const Sample& s) { return value(s.snapshot.bodies[index]); },
            .needs = {},
            .of_part = true};
}

bool is_free(const JointDescription& joint, std::size_t coordinate) {
    const JointAxis& axis = coordinate < 3 ? joint.move[coordinate] : joint.turn[coordinate - 3];
    return axis.motion != JointAxis::Motion::locked;
}

Quantity of_joint(std::string_view text, const SceneDescription& scene) {
    const auto found = find_part(text, "joint", scene.joints, joint_quantities);
    if (const auto coordinate = found.quantity.coordinate; coordinate && !is_free(found.part, *coordinate)) {
        std::string free;
        for (std::size_t k = 0; k < 6; ++k)
            if (is_free(found.part, k)) free += fmt::format("{}{}", free.empty() ? "" : ", ", joint_quantities[k].name);
        fail(text, fmt::format("this joint locks the coordinate; its free ones: {}", free.empty() ? "none" : free));
    }
    return {.name = std::string(text),
            .label = found.part.name,
            .panel = panel_of(found.quantity),
            .value = [index = found.index,
                      value = found.quantity.value](const Sample& s) { return value(s.survey.joints[index]); },
            .needs = {.joints = true},
            .of_part = true,
            .mean_of_frame = found.quantity.mean_of_frame};
}

void add(std::string_view text, const SceneDescription& scene, std::vector<Quantity>& quantities) {
    if (text.starts_with("body.")) {
        quantities.push_back(of_body(text, scene));
        return;
    }
    if (text.starts_with("joint.")) {
        quantities.push_back(of_joint(text, scene));
        return;
    }
    bool known = false;
    for (const SceneQuantity& q : scene_quantities) {
        const bool part_of_energy = text == "energy" && q.axis == scene_quantities[0].axis;
        if (q.name != text && !part_of_energy) continue;
        quantities.push_back(of_scene(q));
        known = true;
    }
    if (known) return;
    std::vector<std::string_view> names{"energy"};
    for (const SceneQuantity& q : scene_quantities) names.push_back(q.name);
    fail(text, "unknown quantity" + suggestion(text, names) + "; of a body: body.NAME.y; of a joint: joint.NAME.force");
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
    const auto list = [](const auto& quantities) { return fmt::format("{}", fmt::join(names_of(quantities), " ")); };
    return fmt::format(
        "Quantities of a scene: energy {}\n(energy: kinetic, potential and total)\nOf a body, body.NAME.{{...}}: {}\n"
        "Of a joint, joint.NAME.{{...}}: {}",
        list(scene_quantities), list(body_quantities), list(joint_quantities));
}

}  // namespace tumble
