// Fields of [camera] and its keyframes.
#pragma once

#include "scene/fields/choices.h"
#include "scene/fields/field.h"
#include "scene/toml/limits.h"

namespace tumble {

template <class Visitor, class Self>
void visit_fields(Of<CameraDescription>, Visitor& field, Self& self) {
    field(self.eye, "eye", ByCode(), {"the position of the camera", "chosen", "±1e9", "vector, m"});
    field(self.target, "target", ByCode(), {"the point at the center of the frame", "chosen", "±1e9", "vector, m"});
    field(self.up, "up", Direction(),
          {"the direction that is up in the frame; when a moving camera passes straight over its target, the view "
           "turns by "
           "half a turn"});
    field(self.vertical_fov, "vertical_fov", limits::field_of_view,
          {"the angle between the top and the bottom of the frame"});
    if constexpr (requires { self.dof; }) {  // not in the C++ interface
        field(self.dof, "dof", ByCode(),
              {.text = "a [lens](#depth-of-field): all that is nearer or farther than its focus is blurred",
               .standard = "none: all is sharp",
               .type = "table",
               .picture = true,
               .later = true});
    }
    field.section("motion");
    field(self.keyframes, "keyframes", ByCode(),
          {"positions at given times; constant before the first and after the last", "none", {}, "array of tables"});
    field(self.interpolation, "interpolation", ByType(), {"as for [bodies](#keyframes); only with keyframes"});
    field(self.orbit, "orbit", limits::orbit,
          {"turns the eye about the target, around `up`; positive: counterclockwise seen from above"});
    field(self.follow, "follow", ByCode(),
          {"eye and target move with the body's center of mass (not with its rotation), so that the body keeps its "
           "position "
           "in the frame; without a `target`, the camera looks at the body",
           "none", "the name of a body that is not fixed", "string"});
    field(self.follow_time, "follow_time", limits::follow_time,
          {.text = "the time in which the camera comes up with the body (critically damped): 0.3 is smooth; 0: it "
                   "moves as the body does. With `follow` only",
           .standard = "0",
           .later = true});
    field(self.fit, "fit", ByType(),
          {.text = "the motion that a camera without `eye` or `target` shows: the simulated one in the file's "
                   "`duration`, or a guess from the bodies at the start, which needs no simulation. A camera with "
                   "`keyframes` or `follow` is placed by the start",
           .later = true});
    if constexpr (requires { self.follow_start; }) {
        field.inner(self.follow_start, self.follow_start_rotation);
        field.since(self.fits_motion(), self.own_eye, self.own_target, self.fitted_time);
        field.since(!self.shots.empty(), self.shots);
        field.since(!self.insets.empty(), self.insets);
    }
}

template <class Visitor, class Self>
void visit_fields(Of<DepthOfField>, Visitor& field, Self& self) {
    field(self.aperture, "aperture", Required(limits::aperture), {"the diameter of the lens"});
    field.key("focus", {"the distance that is sharp, from the eye along the view; or the name of a body, whose center "
                        "of mass is sharp",
                        "required", "above 0, to 1e9", "number, m; or string"});
    field.inner(self.focus, self.body);
    field(self.samples, "samples", Whole{4, limits::lens_samples},
          {"the points of the lens; a frame is the mean of that many images, and takes that much longer"});
}

template <class Visitor, class Self>
void visit_fields(Of<CameraShot>, Visitor& field, Self& self) {
    field.key("camera", {"the name of one of `[cameras]`", "required", {}, "string"});
    field(self.start, "from", limits::time, {"the time of the scene from which the camera is used"});
    field(self.end, "to", ByCode(),
          {"where it ends; then the next shot or `[camera]` follows", "the next shot, or the end of the clip",
           "above `from`, to 1e9", "number, s"});
    field(self.move, "move", limits::time, {"in which the view goes over from the camera before; 0: a cut"});
    field.inner(self.camera);
}

template <class Visitor, class Self>
void visit_fields(Of<CameraKeyframe>, Visitor& field, Self& self) {
    field(self.time, "time", Required(limits::time), {"each later than the one before"});
    field(self.eye, "eye", limits::coordinate, {{}, "the camera's"});
    field(self.target, "target", limits::coordinate, {{}, "the camera's"});
    field(self.vertical_fov, "vertical_fov", limits::field_of_view, {"zoom", "the camera's"});
}

}  // namespace tumble
