// Fields of [[speed]].
#pragma once

#include "scene/fields/choices.h"
#include "scene/fields/field.h"
#include "scene/toml/limits.h"

namespace tumble {

template <class Visitor, class Self>
void visit_fields(Of<SpeedKeyframe>, Visitor& field, Self& self) {
    field(self.time, "time", Required(ByCode()),
          {"the time of the scene, or `\"impact:A,B\"`: the first impact of two bodies. Each later than the keyframe "
           "before",
           {},
           "0 to 1e9",
           "number, s, or string"});
    field.key("after", {"added to the time of the impact; below 0: before it", "`0`", "±1e9", "number, s"});
    field(self.factor, "factor", limits::clip_speed,
          {"seconds of the motion in a second of the clip: 0.25 is slow motion. `--speed` multiplies it"});
    field(self.hold, "hold", limits::time, {"of the clip, in which the motion stands still at that time"});
    field(self.easing, "easing", ByType(), {"how the factor changes up to the next keyframe"});
    if constexpr (requires { self.impact; }) field.inner(self.impact);
}

}  // namespace tumble
