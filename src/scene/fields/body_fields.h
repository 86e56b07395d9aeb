// Fields of [materials.NAME], [[body]] with its keyframes and parts, [[force]] and [[cord]].
#pragma once

#include "scene/fields/choices.h"
#include "scene/fields/field.h"
#include "scene/fields/fracture_fields.h"
#include "scene/toml/limits.h"

#include <memory>
#include <optional>

namespace tumble {

/// Properties given by a material, or by a body itself. Missing ones stay empty, because the defaults of planes differ.
struct Material {
    std::optional<Color> color;
    std::optional<double> density;  // kg/m^3
    std::optional<double> restitution;
    std::optional<double> friction;
    std::optional<double> rolling_friction;
    std::optional<double> spinning_friction;  // m
    std::optional<double> roughness;
    std::optional<double> metallic;
    std::optional<Pattern> pattern;
    std::optional<Color> pattern_color;
    std::optional<double> pattern_scale;     // m
    std::shared_ptr<const Texture> texture;  // null: none
    std::optional<double> texture_scale;     // m
    std::optional<TextureFilter> texture_filter;
    std::shared_ptr<const Texture> normal_map, roughness_map;  // null: none
    std::optional<double> opacity;
    std::optional<Color> emission;
    std::optional<double> reflection;
    std::optional<SoundMaterial> sound;
    FractureMaterial fracture;
};

template <class Visitor, class Self>
void visit_fields(Of<Material>, Visitor& field, Self& self) {
    field(self.color, "color", ByType(), {{}, "`\"#cf9a5b\"`, planes `\"#d6d8da\"`, with a texture white"});
    field(self.density, "density", limits::density, {{}, "1000"});
    field(self.restitution, "restitution", limits::restitution,
          {"ratio of normal speeds after and before an impact. The default is for dynamic bodies; fixed and kinematic "
           "ones "
           "take that of the other body. A pair uses the larger of two values, or another [rule](#contact)",
           "0.5"});
    field(self.friction, "friction", limits::friction,
          {"Coulomb's coefficient. Default as for the restitution. A pair uses √(a·b) of two values, or another "
           "[rule](#contact)",
           "0"});
    field(self.rolling_friction, "rolling_friction", limits::rolling_friction,
          {"c: a ball of radius r that carries the load N is braked by the torque c·N·r, see "
           "[rolling and spinning friction](../explanation/contact-solver.md#rolling-and-spinning-friction). Default "
           "and value of a pair as for the friction",
           "0"});
    field(self.spinning_friction, "spinning_friction", limits::size_or_zero,
          {"s: a spin about the contact's normal is braked by the torque s·N, in addition to that of the contact's "
           "area. Default and value of a pair as for the friction",
           "0"});
    field(self.roughness, "roughness", limits::fraction,
          {"0: mirror, 1: matte; it multiplies a roughness_map", "0.6, with a roughness_map 1"});
    field(self.metallic, "metallic", limits::fraction, {"1: metal", "0"});
    field(self.pattern, "pattern", ByType(),
          {"see [patterns and textures](#patterns-and-textures)", "`\"panel\"`, planes `\"grid\"`"});
    field(self.pattern_color, "pattern_color", ByType(), {"second color of the pattern", "the color, darker"});
    field(self.pattern_scale, "pattern_scale", limits::size, {"of a cell of the pattern", "by the size of the body"});
    field(self.texture, "texture", ByCode(),
          {"PNG or JPEG file, relative to the folder of the scene; the color multiplies it", "none", {}, "string"});
    field(self.texture_scale, "texture_scale", limits::size,
          {"length that the image covers once", "a face of a box, the way around a sphere, 1 m of a plane"});
    field(self.texture_filter, "texture_filter", ByType(), {"magnified texels: blended, or squares", "`\"linear\"`"});
    field(self.normal_map, "normal_map", ByCode(),
          {"PNG or JPEG file with directions of the surface, of OpenGL's kind (green upward): bumps that light shows",
           "none",
           {},
           "string"});
    field(self.roughness_map, "roughness_map", ByCode(),
          {"PNG or JPEG file whose gray value, as it is, multiplies the roughness", "none", {}, "string"});
    field(self.opacity, "opacity", limits::fraction,
          {"share of the background that the body hides, see [opacity and emission](#opacity-and-emission); planes are "
           "opaque",
           "1"});
    field(self.emission, "emission", ByType(), {"own light, which no shadow dims", "`\"#000000\"`, none"});
    field(self.reflection, "reflection", limits::fraction,
          {"of a plane: share of what it mirrors, as polished stone or still water", "0"});
    field(self.sound, "sound", ByType(),
          {"the material that it sounds of, with `--sound`; `\"none\"` is silent", "`\"wood\"`"});
    if constexpr (requires { self.fracture; }) field.inner(self.fracture);  // its keys: Of<FractureMaterial>
}

template <class Visitor, class Self>
void visit_fields(Of<Appearance>, Visitor& field, Self& self) {
    field(self.color, "color", ByType());
    field(self.roughness, "roughness", limits::fraction);
    field(self.metallic, "metallic", limits::fraction);
    field(self.pattern, "pattern", ByType());
    field(self.visible, "visible", ByType());
    field.since(self.pattern_color.has_value(), self.pattern_color);  // other scenes keep their hash
    field.since(self.pattern_scale != 0.0, self.pattern_scale);
    field.since(self.texture != nullptr, self.texture, self.texture_scale, self.texture_filter);
    field.since(!self.texture && self.has_image(), self.texture_scale, self.texture_filter);
    field.since(self.normal_map != nullptr, std::string_view("normal_map"), self.normal_map);
    field.since(self.roughness_map != nullptr, std::string_view("roughness_map"), self.roughness_map);
    field.since(self.opacity != 1.0, std::string_view("opacity"), self.opacity);
    field.since(self.emission != Color{0, 0, 0}, std::string_view("emission"), self.emission);
    field.since(self.reflection != 0.0, std::string_view("reflection"), self.reflection);
}

/// A body of the interface has its visibility itself, that of a description in its appearance.
auto& visibility_in(auto& body) {
    if constexpr (requires { body.appearance; })
        return body.appearance.visible;
    else
        return body.visible;
}

template <class Visitor, class Self>
void visit_fields(Of<BodyDescription>, Visitor& field, Self& self) {
    field(self.name, "name", NotEmpty(),
          {"for tables of results, forces and cords", "its index in the list", "unique, not empty"});
    field(self.type, "type", ByType(),
          {"`\"dynamic\"` moves by forces and contacts; `\"fixed\"` never moves; `\"kinematic\"` follows its keyframes "
           "and "
           "ignores forces and contacts"});
    field(self.shape, "shape", Required(ByCode()), {.text = "see [shapes](#shapes)", .type = "table"});
    field.key("material", {"its keys in the body's own table override it", "none: the defaults",
                           "a material of the file", "string"});
    field.alias(visibility_in(self), "visible", ByType(), {"an invisible body is simulated and not drawn"});
    if constexpr (requires { self.density; }) field.inner(self.density);
    field(self.mass, "mass", limits::mass, {"in place of the density; only for dynamic bodies", "from the density"});
    if constexpr (requires { self.restitution; }) {
        field.instead(self.restitution, self.restitution_in_pair());
        field.instead(self.friction, self.friction_in_pair());
        field.since(self.rolling_friction || self.spinning_friction, self.rolling_friction, self.spinning_friction);
    }
    field(self.gravity_scale, "gravity_scale", limits::gravity_scale,
          {.text = "the body's weight is that times m·g: 0 floats, below 0 rises", .later = true});
    field(self.center_of_mass, "center_of_mass", limits::coordinate,
          {.text = "in place of the shape's, in the body's frame, from its origin; only for dynamic bodies",
           .standard = "of the shape",
           .later = true});
    field(
        self.inertia, "inertia", ByCode(),
        {.text = "in place of the shape's, about the center of mass, in the body's frame: `[xx, yy, zz, xy, xz, yz]`, "
                 "or the three moments with the [rotation](#rotations) of their axes. No moment may be larger than "
                 "the sum of the other two; only for dynamic bodies",
         .standard = "of the shape",
         .range = "above 0, to 1e30",
         .type = "six numbers, or `{ principal, rotation }`, kg m²",
         .later = true});
    field(self.layers, "layers", ByCode(),
          {.text = "names of layers that the body belongs to, see [layers](#layers)",
           .standard = "`[]`",
           .range = "63 in a scene",
           .type = "array of strings",
           .later = true});
    field(self.collide_with, "collide_with", ByCode(),
          {.text = "layers of the bodies that it collides with, see [layers](#layers)",
           .standard = "all bodies",
           .range = "layers of bodies",
           .type = "array of strings",
           .later = true});
    field(self.position, "position", limits::coordinate,
          {"of the body's origin: the center of a box or sphere, the origin of a mesh file or of a compound's parts"});
    field(self.rotation, "rotation", ByType(), {"see [rotations](#rotations)"});
    field(self.velocity, "velocity", limits::velocity, {"of the center of mass, at time 0; dynamic bodies"});
    field(self.angular_velocity, "angular_velocity", limits::angular_velocity,
          {"world frame, at time 0; dynamic bodies"});
    field(self.integrator, "integrator", ByCode(),
          {"for comparisons in one scene; the option `--integrator` replaces it for every body",
           "the simulation's",
           {},
           "string"});
    field(self.keyframes, "keyframes", ByCode(), {"see [keyframes](#keyframes)", "none", {}, "array of tables"});
    field(self.interpolation, "interpolation", ByType(), {"see [keyframes](#keyframes)"});
    field(self.water_drag, "water_drag", limits::drag,
          {.text = "drag coefficient in [water](#water)", .standard = "that of the water", .later = true});
    for (const char* one : {"grid", "scatter", "poses"})
        field.key(one, {"see [many bodies from one table](#many-bodies-from-one-table)", "none"});
    field.key("fracture", {"see [fracture](#fracture)", "none: it never breaks", {}, "table"});
    if constexpr (requires { self.appearance; }) {
        field.shown(self.appearance);
        field.since(self.sound != SoundMaterial::wood, self.sound);
        field.since(self.fracture != nullptr, std::string_view("fracture"), self.fracture);
        field.since(self.piece_of.has_value(), self.piece_of);
    }
}

template <class Visitor, class Self>
void visit_fields(Of<Keyframe>, Visitor& field, Self& self) {
    field(self.time, "time", Required(limits::time), {"each later than the one before"});
    field(self.position, "position", limits::coordinate, {"of the body's origin", "the body's"});
    field(self.rotation, "rotation", ByType(), {{}, "the body's"});
}

template <class Visitor, class Self>
void visit_fields(Of<CompoundPart>, Visitor& field, Self& self) {
    field(self.shape, "shape", Required(ByCode()),
          {.text =
               "a box, a sphere, a mesh (which collides as its convex hull, in fixed bodies too), or a compound (whose "
               "parts become parts of this body); not a plane or a height field",
           .type = "table"});
    field(self.position, "position", limits::coordinate, {"of the part's origin, in the body's frame"});
    field(self.rotation, "rotation", ByType(), {"of the part, in the body's frame"});
    field(self.density, "density", limits::density, {{}, "the body's"});
    field(self.color, "color", ByType(), {.standard = "the body's", .picture = true});
    field(self.collide, "collide", ByType(),
          {.text = "false: nothing touches the part, which has its mass all the same", .later = true});
    field(self.visible, "visible", ByType(),
          {.text = "an invisible part is simulated and not drawn", .picture = true, .later = true});
}

template <class Visitor, class Self>
void visit_fields(Of<ForceDescription>, Visitor& field, Self& self) {
    field(
        self.body, "body", Required(ByCode()),
        {.text = "the body's name (or its index, as text); for copies, one of them: `\"crate.0\"`", .type = "string"});
    field(self.point, "point", limits::coordinate, {"in the body's frame, from its origin"});
    field(self.force, "force", Required(limits::force));
    field(self.body_frame, "frame", Words{"world", "body"},
          {"`\"body\"`: the force turns with the body, like a thruster"});
    field(self.start, "start", limits::time);
    field(self.end, "end", limits::time, {{}, "none: the force does not end", "after `start`"});
}

template <class Visitor, class Self>
void visit_fields(Of<CordDescription>, Visitor& field, Self& self) {
    field(self.body, "body", ByCode(), {"as in a force", "required without `joint`", {}, "string"});
    field(self.point, "point", limits::coordinate, {"in the body's frame, from its origin"});
    field(self.anchor, "anchor", limits::coordinate, {"world frame", "required without `joint`"});
    field(self.radius, "radius", limits::size);
    field(self.color, "color", ByType());
    field.key("joint", {"a joint's name, in place of body, point and anchor", "none", {}, "string"});
    if constexpr (requires { self.anchor_body; }) {
        field.since(self.joint.has_value(), self.joint, self.anchor_body);
    }
}

}  // namespace tumble
