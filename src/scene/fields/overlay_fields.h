// Fields of [overlay], its points of trails, and [[caption]].
#pragma once

#include "scene/fields/choices.h"
#include "scene/fields/field.h"
#include "scene/toml/limits.h"

namespace tumble {

template <class Visitor, class Self>
void visit_fields(Of<OverlayDescription>, Visitor& field, Self& self) {
    field(self.show, "show", ByCode(),
          {"the names of [overlays](overlays.md); `--overlay` replaces them", "`[]`", {}, "array of strings"});
    field(self.bodies, "bodies", ByCode(),
          {"that overlays show: names, indices as text, or the name of a grid or scatter for all its copies",
           "all moving bodies that are `visible`",
           {},
           "array of strings"});
    field(self.start, "start", limits::time, {"overlays are shown from this time on; text always"});
    field(self.end, "end", limits::time, {{}, "none: to the end", "after `start`"});
    field(self.impulse_time, "impulse_time", limits::time, {"an impulse stays visible this long"});
    field(self.trail_time, "trail_time", limits::time, {"of a path that stays visible", "none: the whole path"});
    field(self.trail_points, "trail_points", ByCode(), {"points of bodies", "centers of mass", {}, "array of tables"});
    field(self.ghost_every, "ghost_every", Whole{1, limits::frames}, {"frames between two ghosts"});
    field(self.legend, "legend", ByType(), {"the meaning of marks and the scales of arrows"});
    field(self.scale, "scale", ByCode(),
          {"m of arrow for an SI unit, by quantity: `force`, `impulse`, `velocity`, `omega`, `momentum`, "
           "`angular-momentum`, `torque`",
           "[found from the clip](overlays.md#arrows)", "above 0, to 1e15 each", "table"});
    field(self.color, "color", ByCode(),
          {"colors of arrows, by quantity", "the color of each [overlay](overlays.md)", {}, "table"});
    field(self.plot, "plot", ByCode(),
          {"quantities, as in [`tumble plot --of`](../how-to/plots.md); `--plot` replaces them",
           "`[]`",
           {},
           "array of strings"});
    field(self.plot_place, "plot_place", ByType());
    field(self.fade_in, "fade_in", limits::time,
          {.text = "the clip brightens from black for this long", .standard = "none", .later = true});
    field(self.fade_out, "fade_out", limits::time,
          {.text = "it darkens to black for this long at its end", .standard = "none", .later = true});
    field.inner(self.captions);
    field.since(!self.labels.empty(), self.labels);
    field.since(self.logo.has_value(), self.logo);
}

template <class Visitor, class Self>
void visit_fields(Of<TrailPoint>, Visitor& field, Self& self) {
    field(self.body, "body", Required(ByCode()), {.text = "as in a force", .type = "string"});
    field(self.point, "point", limits::coordinate, {"in the body's frame, from its origin"});
    field(self.color, "color", ByType(), {"of the path", "a light one of the body's"});
}

template <class Visitor, class Self>
void visit_fields(Of<Caption>, Visitor& field, Self& self) {
    field(self.text, "text", Required(ByType()), {"a line break in it starts a new line"});
    field(self.start, "start", limits::time);
    field(self.end, "end", limits::time, {{}, "none: to the end of the clip", "after `start`"});
}

}  // namespace tumble
