// Fields of [water] and its waves.
#pragma once

#include "scene/description/water.h"
#include "scene/fields/field.h"
#include "scene/toml/limits.h"

namespace tumble {

template <class Visitor, class Self>
void visit_fields(Of<WaterDescription>, Visitor& field, Self& self) {
    field(self.level, "level", limits::coordinate, {"y of the still surface; water is everywhere below"});
    field(self.density, "density", limits::density);
    field(self.drag, "drag", limits::drag, {"drag coefficient of bodies without a `water_drag`"});
    field(self.viscosity, "viscosity", limits::viscosity,
          {"drag in proportion to the speed, 6π·viscosity·r v with r the radius of a ball of the wet volume"});
    field(self.added_mass, "added_mass", ByType(), {"a body that speeds up sets water in motion with it"});
    field(self.current, "current", limits::velocity, {"of the water, horizontal; it carries the waves"});
    field(self.color, "color", ByType(), {.picture = true});
    field(self.visible_in_aov, "visible_in_aov", ByType(),
          {.text = "false: AOVs show the bodies below the surface", .picture = true});
    field(self.waves, "waves", ByCode(), {"see [waves](#waves)", "none: still water", "16 at most", "array of tables"});
}

template <class Visitor, class Self>
void visit_fields(Of<WaterWave>, Visitor& field, Self& self) {
    field(self.height, "height", Required(limits::size), {"from trough to crest"});
    field(self.length, "length", Required(limits::size), {"from crest to crest"});
    field(self.direction, "direction", Direction{}, {"in which the wave travels, horizontal"});
    field(self.phase, "phase", limits::angle, {"0: a crest at the origin of the world at time 0"});
}

}  // namespace tumble
