#include "scene/keys/joint_keys.h"

#include "scene/fields/choices.h"

#include <fmt/format.h>

#include <string>
#include <vector>

namespace tumble {
namespace {

// -- Keys of each type

constexpr unsigned bit(JointType type) { return 1u << unsigned(type); }

constexpr unsigned all_types = (bit(JointType::six_dof) << 1) - 1;  // but gears, which have no place
constexpr unsigned of_fixed = bit(JointType::fixed), of_hinge = bit(JointType::hinge), of_ball = bit(JointType::ball),
                   of_slider = bit(JointType::slider), of_universal = bit(JointType::universal),
                   of_cylindrical = bit(JointType::cylindrical), of_planar = bit(JointType::planar),
                   of_distance = bit(JointType::distance), of_six_dof = bit(JointType::six_dof),
                   of_gear = bit(JointType::gear);

struct KeyOfTypes {
    std::string_view key;
    unsigned types;
};

constexpr KeyOfTypes joint_keys[] = {
    {"name", all_types | of_gear},
    {"type", all_types | of_gear},
    {"joints", of_gear},
    {"ratio", of_gear},
    {"bodies", all_types},
    {"anchor", all_types & ~of_distance},
    {"anchors", all_types},
    {"axis", all_types & ~(of_fixed | of_distance)},
    {"axes", all_types & ~(of_fixed | of_distance)},
    {"second_axis", of_universal | of_six_dof},
    {"frame", all_types & ~of_distance},
    {"snap", all_types},
    {"start_angle", of_hinge | of_cylindrical},
    {"start_position", of_slider | of_cylindrical},
    {"limits", of_hinge | of_slider | of_universal | of_cylindrical},
    {"turn_limits", of_cylindrical},
    {"second_limits", of_universal},
    {"swing", of_ball},
    {"twist", of_ball},
    {"limit_restitution", of_hinge | of_slider | of_ball | of_universal | of_cylindrical | of_distance},
    {"spring", of_hinge | of_slider | of_ball | of_universal | of_cylindrical | of_distance},
    {"turn_spring", of_cylindrical},
    {"motor", of_hinge | of_slider | of_cylindrical | of_distance},
    {"turn_motor", of_cylindrical},
    {"friction", of_hinge | of_slider | of_ball | of_universal | of_cylindrical | of_planar | of_distance},
    {"turn_friction", of_cylindrical},
    {"friction_coefficient", of_hinge | of_slider | of_ball | of_universal | of_cylindrical | of_planar},
    {"bearing_radius", of_hinge | of_ball | of_universal | of_cylindrical | of_planar},
    {"length", of_distance},
    {"min_length", of_distance},
    {"max_length", of_distance},
    {"move_x", of_six_dof},
    {"move_y", of_six_dof},
    {"move_z", of_six_dof},
    {"turn_x", of_six_dof},
    {"turn_y", of_six_dof},
    {"turn_z", of_six_dof},
    {"break_force", all_types | of_gear},
    {"break_torque", of_gear | (all_types & ~of_distance)},
    {"break_impulse", all_types},
    {"collide", all_types | of_gear},
    {"enabled", all_types | of_gear},
    {"visible", of_hinge | of_ball | of_slider | of_universal | of_cylindrical | of_distance},
};

std::string names_of(unsigned types) {
    std::vector<std::string_view> names;
    for (const auto& choice : choices<JointType>)
        if (types & bit(choice.value)) names.push_back(choice.name);
    return quoted_list(names);
}

void expect_keys_of(const TomlTable& table, JointType type) {
    for (const KeyOfTypes& known : joint_keys) {
        if ((known.types & bit(type)) || !table.has(known.key)) continue;
        table.find(known.key)->origin().fail(
            fmt::format("is a key of joints of another type: {} (given in a joint of type \"{}\")",
                        names_of(known.types), name_of(type)));
    }
}

}  // namespace

JointType read_joint_type(const TomlTable& table) {
    std::vector<std::string_view> known;
    for (const KeyOfTypes& key : joint_keys) known.push_back(key.key);
    table.expect_keys(known);
    const TomlValue value = table.require("type");
    const JointType type = value.choice<JointType>(choices<JointType>);
    expect_keys_of(table, type);
    return type;
}

}  // namespace tumble
