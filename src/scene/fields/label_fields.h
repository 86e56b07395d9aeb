// Fields of [[label]], [logo] and [[inset]].
#pragma once

#include "scene/fields/choices.h"
#include "scene/fields/field.h"
#include "scene/toml/limits.h"

namespace tumble {

template <class Visitor, class Self>
void visit_fields(Of<LabelDescription>, Visitor& field, Self& self) {
    field(self.text, "text", Required(ByType()),
          {"with [placeholders](overlays.md#labels): `\"m = {mass} kg\"`; a line break in it starts a new line"});
    field(self.body, "body", Required(ByCode()), {"the body that it belongs to", {}, {}, "string"});
    field(self.offset, "offset", limits::coordinate,
          {"from the body's center of mass to the middle of the label's lower edge, in the world frame",
           "above the body"});
    field(self.size, "size", limits::label_size, {"height of the letters"});
    field(self.color, "color", ByType(), {"of the text and the leader"});
    field(self.leader, "leader", ByType(), {"a line from the label to the body's center of mass"});
    field(self.start, "from", limits::time, {"the time of the scene from which the label is shown"});
    field(self.end, "to", limits::time, {{}, "none: to the end of the clip", "after `from`"});
}

template <class Visitor, class Self>
void visit_fields(Of<LogoDescription>, Visitor& field, Self& self) {
    field(self.image, "image", Required(ByCode()),
          {"a PNG or JPEG file beside the scene; alpha is kept", {}, {}, "string"});
    field(self.corner, "corner", ByType());
    field(self.width, "width", limits::frame_share, {"share of the width of the frame"});
    field(self.margin, "margin", limits::frame_margin, {"to the edges of the frame, share of its height"});
    field(self.opacity, "opacity", limits::fraction);
}

template <class Visitor, class Self>
void visit_fields(Of<CameraInset>, Visitor& field, Self& self) {
    field.key("camera", {"the name of one of `[cameras]`", "required", {}, "string"});
    field(self.corner, "corner", ByType());
    field(self.size, "size", limits::frame_share, {"share of the width and of the height of the frame"});
    field(self.margin, "margin", limits::frame_margin, {"to the edges of the frame, share of its height"});
    field(self.rectangle, "rectangle", ByCode(),
          {"left, top, width and height as shares of the frame, in place of `corner`, `size` and `margin`", "none",
           "inside the frame", "array of four numbers"});
    field(self.border, "border", limits::border, {"width of the line around it"});
    field(self.border_color, "border_color", ByType());
    field(self.start, "from", limits::time, {"the time of the scene from which it is shown"});
    field(self.end, "to", ByCode(), {{}, "none: to the end of the clip", "above `from`, to 1e9", "number, s"});
    field.inner(self.camera);
}

}  // namespace tumble
