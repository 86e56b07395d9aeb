// Fields of [[speed]], [simulation], [output], [light], [environment], [wind] and [contact].
#pragma once

#include "scene/fields/choices.h"
#include "scene/fields/field.h"
#include "scene/toml/limits.h"

namespace tumble {

template <class Visitor, class Self>
void visit_fields(Of<SimulationSettings>, Visitor& field, Self& self) {
    field(self.duration, "duration", limits::duration, {"0 gives a single frame"});
    field(self.steps_per_frame, "steps_per_frame", Whole{1, limits::steps_per_frame},
          {"the fixed step is 1 / (fps · steps_per_frame)"});
    field.key("step", {"the step, in place of `steps_per_frame`", "none", "above 0", "number, s"});
    field(self.gravity, "gravity", limits::acceleration);
    field(self.method, "method", ByType(),
          {"`\"notes\"`: the course notes to the letter, for teaching; see "
           "[the method of the notes](../explanation/physics.md#the-method-of-the-notes)"});
    field(self.push_out, "push_out", ByType(),
          {"with `method = \"notes\"` only: overlapping bodies are moved apart in each step"});
    field(self.integrator, "integrator", ByType(), {"see [integrators](#integrators)"});
    field(
        self.impacts, "impacts", ByType(),
        {"`\"stepped\"` (time-stepping): impacts are resolved at the step that finds them, hits of balls at their own "
         "times within it. `\"exact\"` (event-driven): each impact is resolved at its own time, and ballistic motion "
         "is "
         "exact whatever the integrator"});
    field(self.impact_law, "impact_law", ByType(), {"the law for impacts with several contacts"});
    field(
        self.contact_solver, "contact_solver", ByType(),
        {"`\"by-island\"`: each island (group of touching bodies) gets one of two solvers by a "
         "[rule](../explanation/contact-solver.md#solver-selection). `\"soft\"` and `\"direct\"`: that solver for all "
         "islands, for comparisons; `\"soft\"` takes [sweeps](scene-joints.md#joints-in-sweeps) for joined bodies too, "
         "`\"direct\"` none"});
    field(self.rotation, "rotation", ByType(), {"the representation of rotations in the state"});
    field(self.sleep, "sleep", ByType(), {"islands at rest are not simulated until something touches them"});
    field(self.seed, "seed", Whole{0, INT64_MAX}, {"seed of the random numbers of grids and scatters"});
}

template <class Visitor, class Self>
void visit_fields(Of<OutputSettings>, Visitor& field, Self& self) {
    field.key("size", {"width and height", "`[1280, 720]`", "1 to 16384 each", "two whole numbers, pixels"});
    field(self.fps, "fps", ByCode(),
          {"a fraction has two whole numbers from 1 to 1,000,000: `\"24000/1001\"`",
           {},
           "1e-9 to 1e6",
           "number, frames/s; or a fraction as text"});
    field.shown(self.width, self.height);
    field(self.samples, "samples", ByCode(),
          {.text = "1: aliased edges; 2 or 4: antialiased edges", .type = "1, 2 or 4", .picture = true});
    field(self.exposure, "exposure", limits::exposure,
          {.text = "1 makes all light twice as bright, -1 half", .standard = "0", .picture = true, .later = true});
    field(self.tone, "tone", ByType(),
          {.text = "`\"filmic\"`: bright light approaches white; `\"linear\"`: it is cut off, and all below has its "
                   "exact sRGB value",
           .standard = "`\"filmic\"`",
           .picture = true,
           .later = true});
}

template <class Visitor, class Self>
void visit_fields(Of<LightDescription>, Visitor& field, Self& self) {
    field(
        self.direction, "direction", Direction(),
        {"the direction in which the light travels. If the light comes from below a fixed plane with a slope below 60 "
         "degrees, only ambient sky light is left"});
    field(self.shadows, "shadows", ByType());
}

template <class Visitor, class Self>
void visit_fields(Of<LampDescription>, Visitor& field, Self& self) {
    field(self.type, "type", ByType(),
          {"`\"sun\"`: everywhere from one direction; `\"point\"`: to all sides, by the inverse square of the "
           "distance; `\"spot\"`: such a light within a cone"});
    field(self.direction, "direction", Direction(), {"the direction in which the light of a sun or spot travels"});
    field(self.position, "position", limits::coordinate, {"of a point or spot", "required for these"});
    field(self.color, "color", ByType());
    field(self.intensity, "intensity", limits::light,
          {"1 is the light of `[light]`; of a point or spot at a distance of 1 m"});
    field(self.angle, "angle", limits::cone_angle, {"degrees, of the whole cone of a spot; its rim is soft"});
    field(self.shadows, "shadows", ByType(),
          {"two lights at most may cast shadows, suns or spots; the second one costs 6 ms of a frame of 1280 x 720",
           "`true` for the first sun, if no other light says so"});
}

template <class Visitor, class Self>
void visit_fields(Of<EnvironmentDescription>, Visitor& field, Self& self) {
    field.key(
        "preset",
        {"light from all sides that needs no file: `\"studio\"`, `\"overcast\"` or `\"dusk\"`", "none", {}, "string"});
    field.key("image",
              {"the same from a file beside the scene: `.hdr`, `.exr`, PNG or JPEG, equirectangular, up to 4096 pixels "
               "a side",
               "none: the light of the sky",
               {},
               "string"});
    field.key("background",
              {"`\"sky\"`, `\"image\"` (of the preset or file), a color, or two colors: of the horizon and "
               "straight up",
               "`\"image\"` where there is one, or else `\"sky\"`",
               {},
               "string; or array of two colors"});
    if constexpr (requires { self.sun; }) field.shown(self.background, self.low, self.high, self.image, self.sun);
    field(self.rotation, "rotation", limits::angle,
          {"of the image about the y axis, counter-clockwise seen from above"});
    field(self.intensity, "intensity", limits::environment_light, {"factor on the light of the image"});
    field(self.blur, "blur", limits::fraction, {"of the image as background; its light stays the same"});
    field(self.ground_shadow, "ground_shadow", ByType(),
          {"planes are not drawn, only the shadows on them, over the background or with `--transparent`"});
}

template <class Visitor, class Self>
void visit_fields(Of<WindDescription>, Visitor& field, Self& self) {
    field(self.velocity, "velocity", limits::velocity);
    field(self.density, "density", limits::air_density);
    field(self.drag, "drag", limits::drag, {"drag coefficient"});
}

template <class Visitor, class Self>
void visit_fields(Of<PairRules>, Visitor& field, Self& self) {
    auto& [restitution, friction] = self;
    field(restitution, "restitution_rule", ByType(),
          {"how the restitution of a pair follows from the restitutions of its two bodies"});
    field(friction, "friction_rule", ByType(), {"the same of the friction"});
}

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
