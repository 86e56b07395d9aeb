// Fields of [[field]], its region, [[pair_force]] and [[explosion]].
#pragma once

#include "scene/fields/choices.h"
#include "scene/fields/field.h"
#include "scene/toml/limits.h"

namespace tumble {

template <class Visitor, class Self>
void visit_fields(Of<FieldRegion>, Visitor& field, Self& self) {
    if constexpr (requires { self.kind; }) {
        field.inner(self.kind);
        field(self.size, "box", limits::size, {"edge lengths of a box along the axes of the world", "none"});
        field(self.radius, "sphere", limits::size, {"radius of a ball, in place of the box", "none"});
    } else {
        field(self.box, "box", limits::size);
        field(self.sphere, "sphere", limits::size);
    }
    field(self.center, "center", limits::coordinate);
}

template <class Visitor, class Self>
void visit_fields(Of<FieldDescription>, Visitor& field, Self& self) {
    field(self.type, "type", Required(ByType()), {"see the table of types"});
    field(self.acceleration, "acceleration", limits::acceleration, {"uniform: required"});
    field(self.center, "center", limits::coordinate, {"point, vortex: the center, a point of the axis"});
    field(self.axis, "axis", Direction{}, {"vortex"});
    field(self.strength, "strength", limits::field_strength, {"point, vortex: required. Negative: the other way"});
    field(self.softening, "softening", limits::size_or_zero, {"point, vortex: smooths the center"});
    field(self.velocity, "velocity", limits::velocity, {"drag: of the medium"});
    field(self.linear, "linear", limits::drag_linear, {"drag"});
    field(self.quadratic, "quadratic", limits::drag_quadratic, {"drag"});
    field.key("region", {"bodies whose center of mass is inside feel the field: `{ box = [x, y, z], center = ... }` or "
                         "`{ sphere = r, center = ... }`",
                         "everywhere",
                         {},
                         "table"});
    if constexpr (requires { self.region.kind; }) field.inner(self.region);
    field.key("enabled", {"the field acts in this span", "the whole clip", "0 to 1e9, `until` after `from`",
                          "`[from]` or `[from, until]`, s"});
    field.inner(self.start, self.end);
}

template <class Visitor, class Self>
void visit_fields(Of<PairForceDescription>, Visitor& field, Self& self) {
    field(self.type, "type", Required(ByType()), {"see the table of types"});
    field(self.bodies, "bodies", Required(ByCode()),
          {"the force acts between each two of them; the name of a grid or a scatter stands for all of its copies",
           {},
           "two or more, one of them dynamic",
           "array of strings"});
    field(self.strength, "strength", limits::field_strength,
          {"not of springs. Negative: the other way",
           "6.6743e-11 of gravity, 8.9875517873681764e9 of charges, 1e-7 of dipoles; required "
           "for `\"1/r^2\"`",
           {},
           "number, m³/(kg s²), N m²/C², N m² or N/A²"});
    field(self.softening, "softening", limits::size_or_zero, {"not of springs"});
    field(self.charges, "charges", ByCode(),
          {"coulomb: required, one of each entry of `bodies`", "none", "±1e9", "array of numbers, C"});
    field(self.moments, "moments", ByCode(),
          {.text = "dipole: required, one of each entry of `bodies`, body frame",
           .standard = "none",
           .range = "±1e9, not all zero",
           .type = "array of vectors, A m²",
           .later = true});
    field(self.stiffness, "stiffness", limits::stiffness, {"spring: required"});
    field(self.damping, "damping", limits::damping, {"spring"});
    field(self.length, "length", limits::size_or_zero, {"spring: distance without force"});
    field.key("enabled",
              {"as of a field", "the whole clip", "0 to 1e9, `until` after `from`", "`[from]` or `[from, until]`, s"});
    field.inner(self.start, self.end);
}

template <class Visitor, class Self>
void visit_fields(Of<ExplosionDescription>, Visitor& field, Self& self) {
    field(self.center, "center", Required(limits::coordinate));
    field(self.time, "time", limits::time,
          {"it acts from then to the end of the step, for a quarter of a step at least"});
    field(self.impulse, "impulse", Required(limits::explosion_impulse),
          {"sum of the lengths over all directions. Negative: bodies are drawn in"});
    field(self.radius, "radius", limits::size,
          {"bodies whose center of mass is farther away feel nothing", "unbounded"});
}

}  // namespace tumble
