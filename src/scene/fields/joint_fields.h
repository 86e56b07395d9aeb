// Fields of [[joint]], and of its springs, motors and coordinates.
#pragma once

#include "scene/fields/choices.h"
#include "scene/fields/field.h"
#include "scene/toml/limits.h"

namespace tumble {

constexpr std::uint32_t bits_of(auto... types) { return ((1u << unsigned(types)) | ...); }

template <class Visitor, class Self>
void visit_fields(Of<JointDescription>, Visitor& field, Self& self) {
    using enum JointType;
    constexpr std::uint32_t placed = ~bits_of(gear), angles = bits_of(hinge, cylindrical),
                            slides = bits_of(slider, cylindrical);
    constexpr std::uint32_t one_axis = angles | slides, limited = one_axis | bits_of(ball, universal, distance);
    constexpr std::uint32_t with_axis = placed & ~bits_of(fixed, distance);
    constexpr std::uint32_t bearings = one_axis | bits_of(ball, universal, planar);

    field(self.name, "name", ByCode(),
          {"for tables, cords and poses", "`joint N` with its index", "unique, not empty", "string"});
    field(self.type, "type", Required(ByCode()), {"see [types](#types-of-joints)", {}, {}, "string"});
    field.key("bodies",
              {"as in a force; `\"world\"` for the world. The second one moves relative to the first",
               "required, but for a [gear](#gears)", "two different ones, one of them dynamic", "two strings", placed});
    field.inner(self.first, self.second);

    field.section("places");
    field.key("anchor", {{},
                         "required; the origin of the second body for `\"fixed\"`, `\"slider\"` and `\"planar\"`",
                         "±1e9",
                         "vector, m",
                         placed & ~bits_of(distance)});
    field.key("axis",
              {"the axis of a hinge or a slider, the normal of a plane, the twist axis of a ball, x of `\"6dof\"`",
               "required for hinge, slider, universal, cylindrical, planar and for a ball with limits", "not zero",
               "vector", with_axis});
    field.key("second_axis", {"the axis in the second body; y of `\"6dof\"`", "required for `\"universal\"`",
                              "square to `axis` within 1e-6 rad", "vector", bits_of(universal, six_dof)});
    field.key("frame",
              {"the frame of the three above; `\"first\"` or `\"second\"`: in the frame of that body, from its origin",
               "`\"world\"`",
               {},
               "string",
               placed & ~bits_of(distance)});
    field.key("anchors", {"in place of `anchor`: one in the frame of each body, from its origin",
                          {},
                          "within 1e-6 of the smaller body's size at the start",
                          "two vectors, m",
                          placed});
    field.key("axes", {"in place of `axis`: one in the frame of each body. Universal: the first axis, and the second "
                       "one square to it. Ball: the angle between them is the swing at the start",
                       {},
                       "parallel within 1e-6 rad",
                       "two vectors",
                       with_axis});
    field.key("snap",
              {"accepts a gap of the anchors or the axes, and a start outside of limits; the simulation closes it",
               "false",
               {},
               "boolean",
               placed});
    field.key("start_angle", {"hinge, cylindrical: the angle at the start", "0", "±180", "number, degrees", angles});
    field.key("start_position",
              {"slider, cylindrical: the displacement at the start; with `anchors` their places give it", "0", "±1e9",
               "number, m", slides});
    field.inner(self.anchor_first, self.anchor_second, self.frame_first, self.frame_second);

    field.section("coordinates");
    field.key("limits", {"the start is inside", "none", "±36,000 degrees, ±1e9 m; lower < upper",
                         "`[lower, upper]`, degrees or m", one_axis | bits_of(universal)});
    field.key("turn_limits", {"of the angle of a cylindrical joint", "none", {}, {}, bits_of(cylindrical)});
    field.key("second_limits", {"of the angle about the second axis", "none", {}, {}, bits_of(universal)});
    field.key("limit_restitution", {"of an impact at a limit", "0", "0 to 1", "number", limited});
    field.key("twist", {"limits of the angle about x", "none", "±180", "`[lower, upper]`, degrees", bits_of(ball)});
    field.key("spring", {"see [springs and motors](#springs-and-motors)", "none", {}, "table", limited});
    field.key("turn_spring", {"of the angle", "none", {}, "table", bits_of(cylindrical)});
    field.key("motor",
              {"see [springs and motors](#springs-and-motors)", "none", {}, "table", one_axis | bits_of(distance)});
    field.key("turn_motor", {"of the angle", "none", {}, "table", bits_of(cylindrical)});
    field.key("friction",
              {"largest force of dry friction. Hinges, sliders and universal joints of trees in flight keep the order "
               "of the `integrator` with it ([Friction in flight](../explanation/joints.md#friction-in-flight))",
               "0", "0 to 1e15", "number, N or N m", limited | bits_of(planar)});
    field.key("turn_friction", {"of the angle", "0", "0 to 1e15", "number, N m", bits_of(cylindrical)});
    for (const char* one : {"move_x", "move_y", "move_z", "turn_x", "turn_y", "turn_z"})
        field.key(one, {"a coordinate of a `\"6dof\"` joint", "`\"locked\"`", {}, {}, bits_of(six_dof)});
    field.inner(self.move, self.turn);
    field(self.swing, "swing", ByCode(),
          {"half angle of the cone of the x axis, or half angles about y and z", "none", "above 0, below 180",
           "number or two numbers, degrees", bits_of(ball)});
    field(self.length, "length", ByCode(),
          {"a rod; it must be the distance at the start, or needs `snap`", "the distance at the start", "0 to 1e9",
           "number, m", bits_of(distance)});
    for (const char* one : {"min_length", "max_length"})
        field.key(one, {"`max_length` alone is a rope", "none", "0 to 1e9", "number, m", bits_of(distance)});
    field(self.friction_coefficient, "friction_coefficient", limits::friction,
          {"friction of a bearing: coefficient times load, times radius for an angle", "none", {}, {}, bearings});
    field(self.bearing_radius, "bearing_radius", limits::size,
          {"with a `friction_coefficient`", "none", {}, {}, bearings & ~bits_of(slider)});

    field(self.armature, "armature", limits::armature,
          {.text = "inertia along the coordinate alone, as of the rotor of a geared motor: it resists a change of the "
                   "relative speed of the two bodies",
           .standard = "none",
           .type = "number, kg m² or kg",
           .joints = bits_of(hinge, slider),
           .later = true});

    field.section("strength");
    field(self.break_force, "break_force", limits::strength_force,
          {"the joint breaks where it carries more, as a mean over a step; trees with `exact` or `rk4` at the "
           "[moment](../explanation/joints.md#breaks-in-flight), but for `break_impulse`",
           "none"});
    field(self.break_torque, "break_torque", limits::strength_torque, {{}, "none", {}, {}, ~bits_of(distance)});
    field(self.break_impulse, "break_impulse", limits::strength_impulse, {{}, "none", {}, {}, placed});
    field(self.collide, "collide", ByType(),
          {"true if the two bodies collide with each other", "false; true for `\"distance\"`"});
    field.key("enabled", {"the joint holds in this span", "the whole clip", "0 to 1e9, `until` after `from`",
                          "`[from]` or `[from, until]`, s"});
    field.inner(self.start, self.end);

    field.section("gear");
    field.key("joints", {"names of joints, before or after the gear, or of a chain or an instance", "required",
                         "hinges or sliders, two different ones", "two strings", bits_of(gear)});
    field.key("ratio", {"two hinges: dimensionless. Slider and hinge: m/rad; hinge and slider: rad/m", "required",
                        "±1e9, not 0", "number: unit of θ₁ over unit of θ₂", bits_of(gear)});
    field.since(self.type == gear, self.geared, self.ratio);

    field.section("strength");
    field(self.visible, "visible", ByType(),
          {"the joint is drawn, without effect on the motion. Hinge: its axle; universal: its cross; ball: a pin; "
           "slider and cylindrical: a rod over the way of the limits; distance: a [cord](scene-format.md#cord) between "
           "its anchors",
           {},
           {},
           {},
           one_axis | bits_of(ball, universal, distance),
           true});
}

template <class Visitor, class Self>
void visit_fields(Of<JointSpring>, Visitor& field, Self& self) {
    field(self.stiffness, "stiffness", limits::stiffness);
    field(self.damping, "damping", limits::damping);
    field(self.frequency, "frequency", limits::frequency,
          {"in place of the two above: for the effective mass of the joint at the start", "none"});
    field(self.damping_ratio, "damping_ratio", limits::damping_ratio, {"with `frequency`; 1 is critical"});
    field(self.rest, "rest", ByCode(), {"not for a ball", {}, "as limits", "number, m or degrees"});
}

template <class Visitor, class Self>
void visit_fields(Of<JointMotor>, Visitor& field, Self& self) {
    field(self.speed, "speed", ByCode(), {{}, "none", "±1e9", "number, m/s or rad/s"});
    field.key("target", {{}, "none", "as limits", "number, m or degrees"});
    field.key("keyframes",
              {"a target that moves from value to value; it stands still before the first and after the last", "none",
               "times increase", "array of `{ time, value }`"});
    field.inner(self.targets);
    field(self.interpolation, "interpolation", ByType(),
          {"of the path through the keyframes, as for [bodies](scene-format.md#keyframes)"});
    field(self.stiffness, "stiffness", limits::stiffness, {{}, "required with a target"});
    field(self.damping, "damping", limits::damping);
    for (const char* one : {"max_force", "max_torque"})
        field.key(one, {"`max_force` for displacements and distances, `max_torque` for angles", "none",
                        "above 0, to 1e15", "number, N or N m"});
    field.inner(self.max_force);
}

template <class Visitor, class Self>
void visit_fields(Of<JointTarget>, Visitor& field, Self& self) {
    field(self.time, "time", Required(limits::time), {"each later than the one before"});
    field(self.value, "value", Required(ByCode()), {{}, {}, "as limits", "number, m or degrees"});
}

template <class Visitor, class Self>
void visit_fields(Of<JointAxis>, Visitor& field, Self& self) {
    field.inner(self.motion);
    field.key("limits");
    field.inner(self.lower, self.upper);
    field(self.restitution, "limit_restitution", limits::restitution);
    field(self.spring, "spring", ByCode());
    field(self.motor, "motor", ByCode());
    field(self.friction, "friction", ByCode());
}

}  // namespace tumble
