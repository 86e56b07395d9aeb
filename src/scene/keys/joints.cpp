#include "scene/keys/joints.h"

#include "core/deterministic_math.h"
#include "core/safe_text.h"
#include "scene/fields/joint_fields.h"
#include "scene/keys/body_index.h"
#include "scene/keys/joint_coordinates.h"
#include "scene/keys/joint_places.h"
#include "scene/keys/read_fields.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

namespace tumble {

namespace {

std::string names_of(std::uint32_t types) {
    std::vector<std::string_view> names;
    for (const auto& choice : choices<JointType>)
        if (types & bits_of(choice.value)) names.push_back(choice.name);
    return quoted_list(names);
}

void expect_keys_of(const TomlTable& table, JointType type, const KeyList& known) {
    for (std::size_t i = 0; i < known.keys.size(); ++i) {
        if ((known.joints[i] & bits_of(type)) || !table.has(known.keys[i])) continue;
        table.find(known.keys[i])
            ->origin()
            .fail(fmt::format("is a key of joints of another type: {} (given in a joint of type \"{}\")",
                              names_of(known.joints[i]), name_of(type)));
    }
}

}  // namespace

JointType read_joint_type(const TomlTable& table) {
    const KeyList known = list_keys<JointDescription>();
    table.expect_keys(known.keys);
    const TomlValue value = table.require("type");
    const JointType type = value.choice<JointType>(choices<JointType>);
    expect_keys_of(table, type, known);
    return type;
}

namespace {

using Motion = JointAxis::Motion;

// -- Bodies

void read_bodies_of(const TomlTable& table, const BodyIndex& index, const std::vector<BodyDescription>& bodies,
                    JointDescription& joint) {
    const TomlValue value = table.require("bodies");
    const auto side = value.items(2, "names of bodies, or one and \"world\"");
    joint.first = find_side(side[0], index);
    joint.second = find_side(side[1], index);
    if (joint.first == joint.second) value.fail("must be two different ones");
    const auto moves = [&](const std::optional<std::size_t>& body) {
        return body && bodies[*body].type == BodyType::dynamic;
    };
    if (!moves(joint.first) && !moves(joint.second))
        value.fail("must name at least one dynamic body: no joint moves another");
}

// -- Coordinates of each type

struct JointTable {
    const TomlTable& table;
    const std::vector<BodyDescription>& bodies;
    bool snap;
    StartCoordinates start;
};

void set_motion(std::array<JointAxis, 3>& axes, Motion motion) {
    for (JointAxis& axis : axes) axis.motion = motion;
}

/// The restitution of all limits of the joint.
void read_restitution(const TomlTable& table, JointDescription& joint) {
    const auto value = table.find("limit_restitution");
    if (!value) return;
    const double restitution = value->number(limits::restitution);
    bool limited = joint.swing.has_value();
    for (auto* axes : {&joint.move, &joint.turn})
        for (JointAxis& axis : *axes) {
            const bool swings = joint.swing && axes == &joint.turn;
            if (axis.motion == Motion::limited || swings) axis.restitution = restitution;
            limited = limited || axis.motion == Motion::limited;
        }
    if (!limited) value->origin().fail("needs limits (not given)");
}

void read_turn(const JointTable& given, const CoordinateKeys& keys, std::size_t k, const char* remedy,
               JointDescription& joint) {
    read_coordinate(given.table, keys, angle_unit, {given.start.turn[k], given.snap, remedy}, joint.turn[k]);
}

void read_slide(const JointTable& given, JointDescription& joint) {
    const CoordinateStart start{given.start.move[0], given.snap,
                                "give start_position, or other limits, or snap = true"};
    read_coordinate(given.table, {"limits", "spring", "motor", "friction"}, length_unit, start, joint.move[0]);
}

constexpr const char* angle_remedy = "give start_angle, or other limits, or snap = true";
constexpr const char* limits_remedy = "give other limits, or snap = true";

std::array<double, 2> read_swing(const TomlValue& value) {
    const auto half_angle = [](const TomlValue& one) {
        const double angle = one.number(limits::angle);
        if (angle <= 0.0 || angle >= 180.0) {
            one.fail("must be above 0 and below 180 degrees: a hinge does not swing, and a ball without swing is free");
        }
        return angle * pi / 180.0;
    };
    if (value.is_number()) return {half_angle(value), half_angle(value)};
    const auto angle = value.items(2, "half angles, about the axes y and z of the joint (or one number)");
    return {half_angle(angle[0]), half_angle(angle[1])};
}

/// The same spring and the same friction about all axes; a cone for the swing and limits of the twist.
void read_ball(const JointTable& given, JointDescription& joint) {
    set_motion(joint.turn, Motion::free);
    if (const auto value = given.table.find("swing")) {
        joint.swing = read_swing(*value);
        const double share =
            hypotenuse(given.start.turn[1] / (*joint.swing)[0], given.start.turn[2] / (*joint.swing)[1]);
        if (share > 1.0 + limits::start_tolerance && !given.snap) {
            value->fail(fmt::format("must contain the start, {:.6g} degrees; give a wider cone, or snap = true",
                                    hypotenuse(given.start.turn[1], given.start.turn[2]) * 180.0 / pi));
        }
    }
    if (const auto value = given.table.find("twist")) {
        const std::array<double, 2> range = read_limits(*value, angle_unit, limits::half_turn);
        check_start(*value, range, angle_unit, {given.start.turn[0], given.snap, limits_remedy});
        joint.turn[0].motion = Motion::limited;
        joint.turn[0].lower = range[0];
        joint.turn[0].upper = range[1];
    }
    for (std::size_t k = 0; k < 3; ++k) {
        if (const auto spring = given.table.find("spring")) {
            if (const auto rest = spring->table().find("rest"))
                rest->origin().fail("is for joints with one coordinate: the spring of a ball pulls to its start");
            joint.turn[k].spring = read_spring(*spring, angle_unit, 0.0);
        }
        if (const auto friction = given.table.find("friction"))
            joint.turn[k].friction = friction->number(limits::joint_torque);
    }
}

void read_universal(const JointTable& given, JointDescription& joint) {
    read_turn(given, {"limits", "spring", nullptr, "friction"}, 0, limits_remedy, joint);
    read_turn(given, {"second_limits", "spring", nullptr, "friction"}, 1, limits_remedy, joint);
}

void read_planar(const JointTable& given, JointDescription& joint) {
    joint.turn[0].motion = Motion::free;
    for (std::size_t k = 1; k < 3; ++k)
        read_coordinate(given.table, {nullptr, nullptr, nullptr, "friction"}, length_unit, {}, joint.move[k]);
}

void read_six(const JointTable& given, JointDescription& joint) {
    constexpr const char* move_keys[] = {"move_x", "move_y", "move_z"};
    constexpr const char* turn_keys[] = {"turn_x", "turn_y", "turn_z"};
    const CoordinateUnit& length = length_unit;
    CoordinateUnit angle = angle_unit;
    angle.value = limits::half_turn;
    const auto check_locked = [&](const JointAxis& axis, double start, const char* key) {
        if (given.snap || axis.motion != Motion::locked || given.table.has(key)) return;
        const bool is_move = key[0] == 'm';
        const double tolerance = is_move && start != 0.0 ? limits::anchor_tolerance * smaller_size(given.bodies, joint)
                                                         : limits::axis_tolerance;
        if (std::fabs(start) <= tolerance) return;
        given.table.find(is_move ? "anchors" : "axes")
            ->origin()
            .fail(fmt::format("must meet at the start where {} is locked: give one anchor and axis, or snap = true "
                              "(given {:.6g} {})",
                              key, is_move ? start : start * 180.0 / pi, is_move ? "m" : "degrees"));
    };
    for (std::size_t k = 0; k < 3; ++k) {
        if (const auto value = given.table.find(move_keys[k]))
            read_free_form_coordinate(*value, length, {given.start.move[k], given.snap, limits_remedy}, joint.move[k]);
        if (const auto value = given.table.find(turn_keys[k]))
            read_free_form_coordinate(*value, angle, {given.start.turn[k], given.snap, limits_remedy}, joint.turn[k]);
        check_locked(joint.move[k], given.start.move[k], move_keys[k]);
        check_locked(joint.turn[k], given.start.turn[k], turn_keys[k]);
    }
}

/// A rod of one length, a rope of at most one, or a spring.
void read_distance(const JointTable& given, JointDescription& joint) {
    const TomlTable& table = given.table;
    set_motion(joint.move, Motion::free);
    set_motion(joint.turn, Motion::free);
    JointAxis& axis = joint.move[0];
    const double start = given.start.move[0];
    const auto least = table.find("min_length"), most = table.find("max_length"), length = table.find("length");
    for (const auto& one : {least, most})
        if (length && one)
            length->origin().fail(fmt::format("and {} exclude each other: give one of them", one->origin().name));
    const bool is_rod = length || (!least && !most && !table.has("spring") && !table.has("motor"));
    if (is_rod) {
        axis.motion = Motion::locked;
        joint.length = length ? length->number(limits::size_or_zero) : start;
        for (const char* key : {"spring", "motor", "friction"})
            if (const auto value = table.find(key))
                value->origin().fail("needs a length that changes: give min_length or max_length, and no length");
        if (length && !given.snap &&
            std::fabs(start - joint.length) > limits::anchor_tolerance * smaller_size(given.bodies, joint)) {
            length->fail(
                fmt::format("must be the distance at the start, {:.6g} m: leave it out, or give snap = true", start));
        }
        return;
    }
    if (least || most) {
        axis.motion = Motion::limited;
        if (least) axis.lower = least->number(limits::size_or_zero);
        if (most) axis.upper = most->number(limits::size_or_zero);
        if (axis.lower >= axis.upper) most->fail("must be above min_length");
        check_start(most ? *most : *least, {axis.lower, axis.upper}, length_unit, {start, given.snap, limits_remedy});
    }
    if (const auto spring = table.find("spring")) axis.spring = read_spring(*spring, length_unit, start);
    if (const auto motor = table.find("motor")) axis.motor = read_motor(*motor, length_unit);
    table.read("friction", axis.friction, limits::joint_force);
}

void read_coordinates(const JointTable& given, JointDescription& joint) {
    switch (joint.type) {
        case JointType::fixed:
            break;
        case JointType::hinge:
            read_turn(given, {"limits", "spring", "motor", "friction"}, 0, angle_remedy, joint);
            break;
        case JointType::slider:
            read_slide(given, joint);
            break;
        case JointType::cylindrical:
            read_slide(given, joint);
            read_turn(given, {"turn_limits", "turn_spring", "turn_motor", "turn_friction"}, 0, angle_remedy, joint);
            break;
        case JointType::ball:
            read_ball(given, joint);
            break;
        case JointType::universal:
            read_universal(given, joint);
            break;
        case JointType::planar:
            read_planar(given, joint);
            break;
        case JointType::distance:
            read_distance(given, joint);
            break;
        case JointType::six_dof:
            read_six(given, joint);
            break;
        case JointType::gear:
            break;
    }
    read_restitution(given.table, joint);
}

// -- Keys of all types

void check_bearing(const TomlTable& table, const JointDescription& joint) {
    const auto coefficient = table.find("friction_coefficient"), radius = table.find("bearing_radius");
    if (radius && !coefficient) radius->origin().fail("needs a friction_coefficient (not given)");
    const bool only_slides = joint.type == JointType::slider || joint.type == JointType::planar;
    if (coefficient && !radius && !only_slides)
        coefficient->origin().fail("needs a bearing_radius for joints that turn (not given)");
}

void check_breaking(const TomlTable& table, const JointDescription& joint) {
    if (joint.type != JointType::distance || joint.move[0].motion != Motion::locked || joint.length > 0.0) return;
    for (const char* key : {"break_force", "break_impulse"})
        if (const auto value = table.find(key))
            value->origin().fail("needs a distance joint with a length above 0: use a ball");
}

void read_span(const TomlTable& table, JointDescription& joint) {
    const auto value = table.find("enabled");
    if (!value) return;
    const auto time = value->items();
    if (time.empty() || time.size() > 2) value->fail("must be an array of one or two numbers, from and until");
    joint.start = time[0].number(limits::time);
    if (time.size() == 1) return;
    joint.end = time[1].number(limits::time);
    if (joint.end <= joint.start) value->fail("must end after it starts");
}

/// All keys except the type, the bodies and the position.
void read_laws(const JointTable& given, JointDescription& joint) {
    joint.collide = joint.type == JointType::distance;
    read_coordinates(given, joint);
    read_fields(given.table, joint);
    check_bearing(given.table, joint);
    check_breaking(given.table, joint);
    read_span(given.table, joint);
}

JointDescription read_joint(const TomlTable& table, const BodyIndex& index,
                            const std::vector<BodyDescription>& bodies) {
    JointDescription joint;
    joint.type = read_joint_type(table);
    if (joint.type == JointType::gear) {
        read_laws({table, bodies, false, {}}, joint);
        return joint;
    }
    read_bodies_of(table, index, bodies, joint);
    JointTable given{table, bodies, false, {}};
    table.read("snap", given.snap);
    given.start = read_places(table, bodies, given.snap, joint);
    read_laws(given, joint);
    return joint;
}

/// The two joints of a gear: hinges or sliders.
void read_geared(const TomlTable& table, const std::vector<JointDescription>& joints, JointDescription& gear) {
    const TomlValue value = table.require("joints");
    const auto side = value.items(2, "names of joints, hinges or sliders");
    for (std::size_t s = 0; s < 2; ++s) {
        const JointDescription& joint = find_joint(side[s], joints);
        if (joint.type != JointType::hinge && joint.type != JointType::slider) {
            side[s].fail(fmt::format("must name a hinge or a slider: a gear couples no joint of type \"{}\"",
                                     name_of(joint.type)));
        }
        gear.geared[s] = std::size_t(&joint - joints.data());
    }
    if (gear.geared[0] == gear.geared[1]) value.fail("must name two different ones");
    const TomlValue ratio = table.require("ratio");
    gear.ratio = ratio.number(limits::gear_ratio);
    if (std::fabs(gear.ratio) < limits::least_gear_ratio)
        ratio.fail("must not be zero, 1e-9 or more in size: theta_1 + ratio * theta_2 is constant");
    for (const char* key : {"break_force", "break_torque"}) {
        const bool turns = joints[gear.geared[0]].type == JointType::hinge;
        const auto strength = table.find(key);
        if (strength && turns != (key == std::string_view("break_torque")))
            strength->origin().fail(fmt::format("is not the strength at the first joint, which is a {}: give {}",
                                                turns ? "hinge" : "slider", turns ? "break_torque" : "break_force"));
    }
}

}  // namespace

JointNames::JointNames(const std::vector<JointDescription>& joints) {
    for (const JointDescription& joint : joints) taken_.insert(joint.name);
}

void JointNames::take(const std::string& name, const SourcePosition& origin) {
    if (!taken_.insert(name).second)
        origin.fail(fmt::format("must be unique, and another joint has it (given \"{}\")", safe_text(name)));
}

std::string JointNames::give(const TomlTable& table, std::size_t index) {
    if (const auto given = table.find("name")) {
        const std::string name = given->text();
        if (name.empty()) given->fail("must not be empty");
        take(name, given->origin());
        return name;
    }
    std::string name = fmt::format("joint {}", index);
    while (!taken_.insert(name).second) name += "'";
    return name;
}

std::optional<std::size_t> find_side(const TomlValue& name, const BodyIndex& index) {
    if (name.text() != "world") return index.find(name);
    if (index.has("world")) name.fail("is the world in a joint, and a body has this name: give the body another one");
    return std::nullopt;
}

void check_number_of_joints(std::size_t number, const SourcePosition& origin) {
    if (number > std::size_t(limits::joints)) {
        origin.fail(
            fmt::format("makes too many joints: the limit of a scene is {} (given {} so far)", limits::joints, number));
    }
}

const JointDescription& find_joint(const TomlValue& name, const std::vector<JointDescription>& joints) {
    const std::string wanted = name.text();
    std::vector<std::string_view> known;
    for (const JointDescription& joint : joints) {
        if (joint.name == wanted) return joint;
        known.push_back(joint.name);
    }
    name.origin().fail(fmt::format("\"{}\" is not the name of a joint{}", safe_text(wanted),
                                   known.empty() ? ": there is none" : suggestion(wanted, known)));
}

JointDescription read_placed_joint(const TomlTable& table, const JointDescription& between, const JointPlace& place,
                                   const std::vector<BodyDescription>& bodies) {
    JointDescription joint = between;
    set_place(place, bodies, joint);
    read_laws({table, bodies, false, {}}, joint);
    return joint;
}

void read_joints(const TomlTable& root, const std::vector<BodyDescription>& bodies,
                 std::vector<JointDescription>& joints) {
    const auto list = root.find("joint");
    if (!list) return;
    const BodyIndex index(bodies);
    JointNames names(joints);
    std::vector<TomlTable> tables = list->tables("; write [[joint]] for each");
    const std::size_t first = joints.size();
    for (TomlTable& table : tables) {
        table.set_title("[[joint]]");
        check_number_of_joints(joints.size() + 1, table.origin());
        joints.push_back(read_joint(table, index, bodies));
        joints.back().name = names.give(table, joints.size() - 1);
    }
    for (std::size_t i = 0; i < tables.size(); ++i)  // gears come before or after their joints
        if (joints[first + i].type == JointType::gear) read_geared(tables[i], joints, joints[first + i]);
}

}  // namespace tumble
