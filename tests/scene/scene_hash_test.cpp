// The hash of a scene: equal for equal content, different after a change of any key of the format.
#include "scene/hash/scene_hash.h"

#include "scene/all_fields.h"
#include "scene/load.h"
#include "scene/scene_changes.h"
#include "support/folder.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <map>
#include <regex>
#include <set>
#include <sstream>

namespace tumble::scene_hash_test {
namespace {

namespace fs = std::filesystem;

const fs::path source = TUMBLE_SOURCE_DIR;
const std::string scene_path = (source / "assets/scenes/scene.toml").string();

const std::string own_lines = R"(
format = 1
title = "Everything"
[simulation]
duration = 2
steps_per_frame = 8
gravity = [0.0, -1.62, 0.5]
method = "tumble"
integrator = "explicit-euler"
impacts = "stepped"
impact_law = "simultaneous"
contact_solver = "soft"
rotation = "matrix"
sleep = false
seed = 42
[output]
size = [640, 360]
fps = 30
samples = 2
[camera]
eye = [1, 2, 3]
target = [4, 5, 6]
up = [0, 0, 2]
vertical_fov = 55.5
interpolation = "linear"
orbit = 3
follow = "ball"
keyframes = [{ time = 0, eye = [1, 1, 1] }, { time = 1, target = [0, 0, 1], vertical_fov = 21 }]
[light]
direction = [0, -2, 1]
shadows = false
[environment]
preset = "studio"
background = ["#102030", "#405060"]
rotation = 20
intensity = 0.9
blur = 0.3
[wind]
velocity = [3, 0, -1]
density = 1.1
drag = 0.8
[contact]
restitution_rule = "average"
friction_rule = "minimum"
[materials.steel]
color = "#8090A0"
density = 7800
restitution = 0.91
friction = 0.11
roughness = 0.2
metallic = 1
pattern = "checker"
[[body]]
name = "plain steel"
material = "steel"
shape = { type = "sphere", radius = 1.5 }
[[body]]
name = "floor"
type = "fixed"
material = "steel"
shape = { type = "plane", normal = [0, 3, 4], offset = 0.5 }
[[body]]
name = "ball"
shape = { type = "sphere", radius = 0.25 }
restitution = 0.4
friction = 0.7
color = "#ff0080"
visible = false
position = [1, 2, 3]
rotation = { axis = [0, 0, 10], angle = 90 }
velocity = [4, 5, 6]
angular_velocity = [7, 8, 9]
mass = 3
[[body]]
shape = { type = "box", size = [1, 2, 3] }
density = 501
roughness = 0.9
metallic = 0.25
pattern = "grid"
integrator = "symplectic-euler"
[[body]]
name = "paddle"
type = "kinematic"
shape = { type = "box", size = [1, 1, 1] }
interpolation = "smooth"
keyframes = [{ time = 0.5, rotation = [0, 1, 0, 0] }, { time = 1.5, position = [1, 0, 0] }]
[[body]]
name = "stone"
shape = { type = "mesh", file = "../meshes/gem.obj", scale = 0.7 }
[[body]]
name = "table"
shape = { type = "compound", parts = [{ shape = { type = "box", size = [1, 1, 2] }, position = [0, 0, 1], rotation = [0, 0, 1, 0], density = 70, color = "#7c4a24" }, { shape = { type = "sphere", radius = 0.4 } }] }
[[body]]
name = "hills"
type = "fixed"
shape = { type = "heightfield", file = "../../tests/scene/heights.csv", size = [4, 3], height = 0.5, base = 0.25 }
[[body]]
name = "wedge"
shape = { type = "hull", points = [[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]] }
[[body]]
name = "tin"
shape = { type = "cylinder", radius = 0.3, height = 0.8 }
[[body]]
name = "hat"
shape = { type = "cone", radius = 0.35, height = 0.85, top_radius = 0.2 }
[[body]]
name = "egg"
shape = { type = "ellipsoid", radii = [0.3, 0.4, 0.3] }
[[body]]
name = "crate"
shape = { type = "box", size = [0.5, 0.5, 0.5] }
grid = { count = [2, 1, 2], spacing = 0.75, jitter = 0.05, tilt = 10 }
scale = [0.5, 0.9]
colors = ["#c8853c", "#a86b2d"]
[[body]]
name = "cloud"
shape = { type = "sphere", radius = 0.125 }
position = [0, 12, 0]
scatter = { count = 4, size = [6, 4, 6], rotation = "random", clearance = 0.01 }
[[force]]
body = "ball"
point = [0, 0.25, 0]
force = [10, 0, 0]
frame = "body"
start = 0.5
end = 1.5
[[cord]]
body = "paddle"
point = [0, 0.5, 0]
anchor = [0, 5, 0]
radius = 0.02
color = "#010203"
[overlay]
show = ["contacts"]
bodies = ["floor"]
start = 0.1
end = 1.9
impulse_time = 0.26
trail_time = 4
trail_points = [{ body = "table", point = [0, 0, 3], color = "#ffd040" }]
ghost_every = 11
legend = false
scale = { force = 1, impulse = 2, velocity = 3, omega = 4, momentum = 5, angular-momentum = 6, torque = 7 }
color = { force = "#000001" }
plot = ["kinetic_energy"]
plot_place = "beside"
[[caption]]
text = "Hello"
start = 0.2
end = 0.3
[cameras.side]
eye = [9, 1, 1]
target = [0, 1, 1]
[cameras.other]
eye = [9, 9, 1]
target = [0, 1, 1]
[[shot]]
camera = "side"
from = 0.5
to = 1.5
move = 0.25
[[inset]]
camera = "side"
corner = "top-left"
size = 0.2
margin = 0.05
border = 3
border_color = "#102030"
from = 0.25
to = 1.25
[[label]]
text = "{name}: {speed:.1f} m/s"
body = "ball"
offset = [0, 1, 0]
size = 18
color = "#ffe080"
leader = false
from = 0.125
to = 1.75
[logo]
image = "../../tests/fuzz/corpus/texture/rgb.png"
corner = "bottom-left"
width = 0.1
margin = 0.02
opacity = 0.75
[[speed]]
time = 0.5
factor = 0.5
hold = 0.125
easing = "linear"
)";

std::string base() { return own_lines + joint_lines; }

const std::vector<std::vector<Change>> own_tables = {
    {{"title", "", "title = \"Everything\"", "title = \"All\"", false},
     {"format", "", "", "", false},  // one value only
     {"simulation", "[simulation]", "duration = 2", "duration = 3", true},
     {"output", "[output]", "fps = 30", "fps = 60", true},
     {"camera", "[camera]", "eye = [1, 2, 3]", "eye = [1, 2, 4]", false},
     {"light", "[light]", "shadows = false", "", false},
     {"environment", "",
      "[environment]\npreset = \"studio\"\nbackground = [\"#102030\", \"#405060\"]\nrotation = 20\nintensity = 0.9\n"
      "blur = 0.3\n",
      "", false},
     {"wind", "", "[wind]\nvelocity = [3, 0, -1]\ndensity = 1.1\ndrag = 0.8\n", "", true},
     {"contact", "", "[contact]\nrestitution_rule = \"average\"\nfriction_rule = \"minimum\"\n", "", true},
     {"materials", "[materials", "density = 7800", "", true},
     {"body", "", "[[body]]\nname = \"floor\"",
      "[[body]]\nshape = { type = \"sphere\", radius = 1 }\n[[body]]\nname = \"floor\"", true},
     {"force", "", "[[force]]\nbody = \"ball\"",
      "[[force]]\nbody = \"ball\"\nforce = [1, 0, 0]\n[[force]]\nbody = \"ball\"", true},
     {"field", "", "[[cord]]", "[[field]]\ntype = \"uniform\"\nacceleration = [1, 0, 0]\n[[cord]]", true},
     {"pair_force", "", "[[cord]]", "[[pair_force]]\ntype = \"gravity\"\nbodies = [\"ball\", \"stone\"]\n[[cord]]",
      true},
     {"explosion", "", "[[cord]]", "[[explosion]]\ncenter = [0, 1, 0]\nimpulse = 1\n[[cord]]", true},
     {"water", "", "", "", true},  // field_hash_test.cpp
     {"cord", "", "[[cord]]\nbody = \"paddle\"",
      "[[cord]]\nbody = \"ball\"\nanchor = [1, 0, 0]\n[[cord]]\nbody = \"paddle\"", false},
     {"joint", "", "[[joint]]", "[[joint]]\ntype = \"fixed\"\nbodies = [\"ball\", \"world\"]\n[[joint]]", true},
     {"chain", "", "[[chain]]",
      "[[chain]]\nname = \"bar\"\nlinks = 1\nshape = { type = \"sphere\", radius = 1 }\nfrom = [0, 40, 0]\n"
      "to = [1, 40, 0]\n[[chain]]",
      true},
     {"template", "[template.door]", "size = [1, 2, 0.1]", "size = [1, 2, 0.2]", true},
     {"instance", "", "[[instance]]", "[[instance]]\ntemplate = \"door\"\nname = \"third\"\n[[instance]]", true},
     {"overlay", "[overlay]", "start = 0.1", "", false},
     {"caption", "", "[[caption]]", "[[caption]]\ntext = \"\"\n[[caption]]", false},
     {"cameras", "[cameras.side]", "eye = [9, 1, 1]", "eye = [9, 1, 2]", false},
     {"shot", "", "[[shot]]\ncamera = \"side\"\nfrom = 0.5\nto = 1.5\nmove = 0.25\n", "", false},
     {"inset", "",
      "[[inset]]\ncamera = \"side\"\ncorner = \"top-left\"\nsize = 0.2\nmargin = 0.05\nborder = 3\n"
      "border_color = \"#102030\"\nfrom = 0.25\nto = 1.25\n",
      "", false},
     {"label", "", "[[label]]", "[[label]]\nbody = \"ball\"\ntext = \"\"\n[[label]]", false},
     {"logo", "[logo]", "opacity = 0.75", "opacity = 0.5", false},
     {"speed", "", "[[speed]]\ntime = 0.5\nfactor = 0.5\nhold = 0.125\neasing = \"linear\"\n", "", false}},
    {{"duration", "[simulation]", "duration = 2", "duration = 2.5", true},
     {"steps_per_frame", "[simulation]", "steps_per_frame = 8", "steps_per_frame = 9", true},
     {"step", "[simulation]", "steps_per_frame = 8", "step = 0.00333333333333333", true},
     {"gravity", "[simulation]", "0.5]", "0.25]", true},
     {"method", "[simulation]", "method = \"tumble\"\n", "method = \"notes\"\n", true},
     {"push_out", "[simulation]", "method = \"tumble\"\n", "method = \"notes\"\npush_out = true\n", true},
     {"integrator", "[simulation]", "explicit-euler", "rk4", true},
     {"impacts", "[simulation]", "stepped", "exact", true},
     {"impact_law", "[simulation]", "simultaneous", "propagating", true},
     {"contact_solver", "[simulation]", "soft", "direct", true},
     {"rotation", "[simulation]", "matrix", "quaternion", true},
     {"sleep", "[simulation]", "sleep = false", "sleep = true", true},
     {"seed", "[simulation]", "seed = 42", "seed = 43", true}},
    {{"size", "[output]", "size = [640, 360]", "size = [640, 361]", false},
     {"fps", "[output]", "fps = 30", "fps = 31", true},
     {"samples", "[output]", "samples = 2", "samples = 4", false},
     {"exposure", "[output]", "samples = 2", "samples = 2\nexposure = 0.5", false},
     {"tone", "[output]", "samples = 2", "samples = 2\ntone = \"linear\"", false}},
    {{"velocity", "[wind]", "velocity = [3, 0, -1]", "velocity = [3, 0, 1]", true},
     {"density", "[wind]", "density = 1.1", "density = 1.2", true},
     {"drag", "[wind]", "drag = 0.8", "drag = 0.9", true}},
    {{"restitution_rule", "[contact]", "average", "geometric", true},
     {"friction_rule", "[contact]", "minimum", "multiply", true}},
    {{"color", "[materials", "#8090A0", "#8090A1", false},
     {"density", "[materials", "density = 7800", "density = 7801", true},
     {"restitution", "[materials", "restitution = 0.91", "restitution = 0.92", true},
     {"friction", "[materials", "friction = 0.11", "friction = 0.12", true},
     {"rolling_friction", "[materials", "friction = 0.11", "friction = 0.11\nrolling_friction = 0.1", true},
     {"spinning_friction", "[materials", "friction = 0.11", "friction = 0.11\nspinning_friction = 0.1", true},
     {"roughness", "[materials", "roughness = 0.2", "roughness = 0.25", false},
     {"metallic", "[materials", "metallic = 1", "metallic = 0", false},
     {"pattern", "[materials", "checker", "plain", false},
     {"pattern_color", "[materials", "pattern = ", "pattern_color = \"#102030\"\npattern = ", false},
     {"pattern_scale", "[materials", "pattern = ", "pattern_scale = 0.3\npattern = ", false},
     {"texture", "[materials", "pattern = \"checker\"", texture_line(), false},
     {"texture_scale", "[materials", "pattern = \"checker\"", texture_line() + "texture_scale = 2\n", false},
     {"texture_filter", "[materials", "pattern = \"checker\"", texture_line() + "texture_filter = \"nearest\"\n",
      false},
     {"normal_map", "[materials", "pattern = \"checker\"", image_line("normal_map"), false},
     {"roughness_map", "[materials", "pattern = \"checker\"", image_line("roughness_map"), false},
     {"opacity", "[materials", "pattern = ", "opacity = 0.3\npattern = ", false},
     {"emission", "[materials", "pattern = ", "emission = \"#102030\"\npattern = ", false},
     {"reflection", "[materials", "pattern = ", "reflection = 0.2\npattern = ", false},
     {"sound", "[materials", "pattern = ", "sound = \"metal\"\npattern = ", true}},
    {{"name", "", "name = \"stone\"", "name = \"rock\"", true},
     {"type", "", "name = \"crate\"", "name = \"crate\"\ntype = \"fixed\"", true},
     {"shape", "name = \"crate\"", "size = [0.5, 0.5, 0.5]", "size = [0.5, 0.5, 0.6]", true},
     {"material", "", "material = \"steel\"", "", true},
     {"color", "name = \"ball\"", "#ff0080", "#ff0081", false},
     {"density", "", "density = 501", "density = 502", true},
     {"restitution", "name = \"ball\"", "restitution = 0.4", "restitution = 0.5", true},
     {"friction", "name = \"ball\"", "friction = 0.7", "friction = 0.8", true},
     {"rolling_friction", "name = \"ball\"", "friction = 0.7", "friction = 0.7\nrolling_friction = 0.1", true},
     {"spinning_friction", "name = \"ball\"", "friction = 0.7", "friction = 0.7\nspinning_friction = 0.1", true},
     {"sound", "name = \"ball\"", "friction = 0.7", "friction = 0.7\nsound = \"glass\"", true},
     {"gravity_scale", "", "mass = 3", "mass = 3\ngravity_scale = 0.5", true},
     {"center_of_mass", "", "mass = 3", "mass = 3\ncenter_of_mass = [0, 0, 0]", true},
     {"inertia", "", "mass = 3", "mass = 3\ninertia = [1, 1, 1, 0, 0, 0]", true},
     {"water_drag", "", "mass = 3", "mass = 3\nwater_drag = 0.3", true},
     {"layers", "", "mass = 3", "mass = 3\nlayers = [\"a\"]", true},
     {"collide_with", "", "mass = 3", "mass = 3\ncollide_with = []", true},
     {"fracture", "", "mass = 3", "mass = 3\nstrength = 1\nfracture = {}", true},
     {"strength", "", "", "", true},  // fracture_test.cpp, up to the inner color
     {"shear_strength", "", "", "", true},
     {"compressive_strength", "", "", "", true},
     {"stiffness", "", "", "", true},
     {"toughness", "", "", "", true},
     {"blow_time", "", "", "", true},
     {"inner_color", "", "", "", false},
     {"roughness", "", "roughness = 0.9", "roughness = 0.8", false},
     {"metallic", "", "metallic = 0.25", "metallic = 0.5", false},
     {"pattern", "", "pattern = \"grid\"", "pattern = \"checker\"", false},
     {"pattern_color", "", "pattern = \"grid\"", "pattern = \"grid\"\npattern_color = \"#405060\"", false},
     {"pattern_scale", "", "pattern = \"grid\"", "pattern = \"grid\"\npattern_scale = 2", false},
     {"texture", "", "pattern = \"grid\"", texture_line(), false},
     {"texture_scale", "", "pattern = \"grid\"", texture_line() + "texture_scale = 3\n", false},
     {"texture_filter", "", "pattern = \"grid\"", texture_line() + "texture_filter = \"nearest\"\n", false},
     {"normal_map", "", "pattern = \"grid\"", image_line("normal_map"), false},
     {"roughness_map", "", "pattern = \"grid\"", image_line("roughness_map"), false},
     {"opacity", "", "mass = 3", "mass = 3\nopacity = 0.3", false},
     {"emission", "", "mass = 3", "mass = 3\nemission = \"#102030\"", false},
     {"reflection", "name = \"floor\"", "type = \"fixed\"", "type = \"fixed\"\nreflection = 0.5", false},
     {"mass", "", "mass = 3", "mass = 4", true},
     {"visible", "", "visible = false", "visible = true", false},
     {"position", "name = \"ball\"", "position = [1, 2, 3]", "position = [1, 2, 4]", true},
     {"rotation", "name = \"ball\"", "angle = 90", "angle = 91", true},
     {"velocity", "name = \"ball\"", "velocity = [4, 5, 6]", "velocity = [4, 5, 7]", true},
     {"angular_velocity", "name = \"ball\"", "angular_velocity = [7, 8, 9]", "angular_velocity = [7, 8, 0]", true},
     {"integrator", "", "integrator = \"symplectic-euler\"", "", true},
     {"keyframes", "name = \"paddle\"", ", { time = 1.5, position = [1, 0, 0] }", "", true},
     {"interpolation", "name = \"paddle\"", "smooth", "linear", true},
     {"grid", "", "grid = { count = [2, 1, 2]", "grid = { count = [2, 2, 2]", true},
     {"scatter", "", "scatter = { count = 4", "scatter = { count = 5", true},
     {"scale", "name = \"crate\"", "scale = [0.5, 0.9]", "scale = [0.5, 0.8]", true},
     {"colors", "name = \"crate\"", "\"#c8853c\", \"#a86b2d\"", "\"#c8853d\", \"#a86b2e\"", false},
     {"poses", "name = \"stone\"", "scale = 0.7 }", "scale = 0.7 }\nposes = \"../../tests/scene/poses.csv\"", true}},
    {{"axis", "name = \"ball\"", "axis = [0, 0, 10]", "axis = [0, 1, 10]", true},
     {"angle", "name = \"ball\"", "angle = 90", "angle = 89", true}},
    {{"time", "name = \"paddle\"", "time = 1.5", "time = 1.6", true},
     {"position", "name = \"paddle\"", "position = [1, 0, 0]", "position = [2, 0, 0]", true},
     {"rotation", "name = \"paddle\"", "rotation = [0, 1, 0, 0]", "rotation = [0, 0, 1, 0]", true}},
    {{"type", "name = \"floor\"", "type = \"plane\", normal = [0, 3, 4], offset = 0.5",
      "type = \"box\", size = [1, 1, 1]", true},
     {"normal", "name = \"floor\"", "normal = [0, 3, 4]", "normal = [0, 3, 5]", true},
     {"offset", "name = \"floor\"", "offset = 0.5", "offset = 0.6", true}},
    {{"type", "name = \"paddle\"", "type = \"box\", size = [1, 1, 1]", "type = \"sphere\", radius = 1", true},
     {"size", "name = \"paddle\"", "size = [1, 1, 1]", "size = [1, 1, 3]", true}},
    {{"type", "name = \"cloud\"", "type = \"sphere\", radius = 0.125", "type = \"box\", size = [1, 1, 1]", true},
     {"radius", "name = \"cloud\"", "radius = 0.125", "radius = 0.126", true}},
    {{"type", "name = \"stone\"", "type = \"mesh\", file = \"../meshes/gem.obj\", scale = 0.7",
      "type = \"box\", size = [1, 1, 1]", true},
     {"file", "name = \"stone\"", "gem.obj", "torus.obj", true},
     {"scale", "name = \"stone\"", "scale = 0.7", "scale = 0.75", true},
     {"unit", "name = \"stone\"", "scale = 0.7", "scale = 0.7, unit = \"ft\"", true},
     {"up", "name = \"stone\"", "scale = 0.7", "scale = 0.7, up = \"z\"", true},
     {"mass_from", "name = \"stone\"", "scale = 0.7", "scale = 0.7, mass_from = \"hull\"", true},
     {"thickness", "name = \"stone\"", "scale = 0.7", "scale = 0.7, mass_from = \"shell\", thickness = 0.1", true},
     {"parts", "name = \"stone\"", "scale = 0.7", "scale = 0.7, parts = \"objects\"", true}},
    {{"type", "name = \"table\"", "", "", true},  // by the shapes above
     {"parts", "name = \"table\"", "parts = [", "parts = [{ shape = { type = \"sphere\", radius = 1 } }, ", true}},
    {{"shape", "name = \"table\"", "size = [1, 1, 2]", "size = [1, 1, 3]", true},
     {"position", "name = \"table\"", "position = [0, 0, 1]", "position = [0, 0, 2]", true},
     {"rotation", "name = \"table\"", "rotation = [0, 0, 1, 0]", "rotation = [0, 1, 0, 0]", true},
     {"density", "name = \"table\"", "density = 70", "density = 71", true},
     {"collide", "name = \"table\"", "density = 70", "density = 70, collide = false", true},
     {"visible", "name = \"table\"", "density = 70", "density = 70, visible = false", false},
     {"color", "name = \"table\"", "#7c4a24", "#7c4a25", false}},
    {{"type", "name = \"hills\"", "", "", true},  // by the shapes above
     {"file", "name = \"hills\"", "heights.csv", "more_heights.csv", true},
     {"size", "name = \"hills\"", "size = [4, 3]", "size = [4, 3.5]", true},
     {"height", "name = \"hills\"", "height = 0.5", "height = 0.6", true},
     {"base", "name = \"hills\"", "base = 0.25", "base = 0.3", true}},
    {{"type", "name = \"wedge\"", "", "", true},  // by the shapes above
     {"points", "name = \"wedge\"", "[0, 0, 1]]", "[0, 0, 2]]", true}},
    {{"type", "name = \"tin\"", "cylinder", "capsule", true},
     {"radius", "name = \"tin\"", "radius = 0.3", "radius = 0.31", true},
     {"height", "name = \"tin\"", "height = 0.8", "height = 0.81", true}},
    {{"type", "name = \"hat\"", "", "", true},  // by the shape above
     {"radius", "name = \"hat\"", "radius = 0.35", "radius = 0.36", true},
     {"height", "name = \"hat\"", "height = 0.85", "height = 0.86", true},
     {"top_radius", "name = \"hat\"", "top_radius = 0.2", "top_radius = 0.21", true}},
    {{"type", "name = \"egg\"", "", "", true},
     {"radii", "name = \"egg\"", "[0.3, 0.4, 0.3]", "[0.3, 0.45, 0.3]", true}},
    {{"principal", "", "mass = 3", "mass = 3\ninertia = { principal = [1, 1, 1] }", true},
     {"rotation", "", "mass = 3", "mass = 3\ninertia = { principal = [1, 2, 2], rotation = [0, 1, 0, 0] }", true}},
    {{"count", "name = \"crate\"", "count = [2, 1, 2]", "count = [2, 1, 3]", true},
     {"spacing", "name = \"crate\"", "spacing = 0.75", "spacing = 0.8", true},
     {"jitter", "name = \"crate\"", "jitter = 0.05", "jitter = 0.06", true},
     {"tilt", "name = \"crate\"", "tilt = 10", "tilt = 11", true}},
    {{"count", "name = \"cloud\"", "count = 4", "count = 3", true},
     {"size", "name = \"cloud\"", "size = [6, 4, 6]", "size = [6, 4, 7]", true},
     {"rotation", "name = \"cloud\"", "random", "none", true},
     {"clearance", "", "clearance = 0.01", "clearance = 2.5", true}},
    {{"body", "[[force]]", "ball", "stone", true},
     {"point", "[[force]]", "0.25", "0.5", true},
     {"force", "[[force]]", "[10, 0, 0]", "[11, 0, 0]", true},
     {"frame", "[[force]]", "\"body\"", "\"world\"", true},
     {"start", "[[force]]", "start = 0.5", "start = 0.6", true},
     {"end", "[[force]]", "end = 1.5", "end = 1.6", true}},
    {{"body", "[[cord]]", "paddle", "stone", false},
     {"joint", "[[cord]]", "body = \"paddle\"\npoint = [0, 0.5, 0]\nanchor = [0, 5, 0]", "joint = \"rod\"", false},
     {"point", "[[cord]]", "0.5", "0.6", false},
     {"anchor", "[[cord]]", "[0, 5, 0]", "[0, 6, 0]", false},
     {"radius", "[[cord]]", "0.02", "0.03", false},
     {"color", "[[cord]]", "#010203", "#010204", false}}};

std::vector<std::vector<Change>> all_tables() {
    std::vector<std::vector<Change>> all = own_tables;
    for (const auto* more : {&picture_changes, &joint_changes}) all.insert(all.end(), more->begin(), more->end());
    return all;
}

SceneDescription parse(const std::string& text, const std::string& file = scene_path) {
    return parse_scene(text, file);
}

std::string changed(const Change& change) {
    std::string text = base();
    const std::size_t from = change.after.empty() ? 0 : text.find(change.after);
    const std::size_t place = from == std::string::npos ? from : text.find(change.old_text, from);
    EXPECT_NE(place, std::string::npos) << change.key << ": " << change.old_text;
    return place == std::string::npos ? text : text.replace(place, change.old_text.size(), change.new_text);
}

/// The scene without tables that join bodies: the method of the notes has no joints.
std::string without_joints(const std::string& text) {
    std::string kept, table;
    const auto flush = [&] {
        const bool joins = table.starts_with("[[joint") || table.starts_with("[[chain") ||
                           table.starts_with("[[instance") || table.starts_with("[template") ||
                           table.starts_with("[[template") || table.find("\njoint = ") != std::string::npos;
        if (!joins) kept += table;
        table.clear();
    };
    std::istringstream lines(text);
    for (std::string line; std::getline(lines, line);) {
        if (line.starts_with('[')) flush();
        table += line + "\n";
    }
    flush();
    return kept;
}

TEST(SceneHash, EveryKeyOfTheFormatChangesIt) {
    const SceneDescription scene = parse(base()), unjoined = parse(without_joints(base()));
    std::map<std::string, std::string> seen;  // a hash and the change that made it
    for (const std::vector<Change>& table : all_tables())
        for (const Change& change : table) {
            if (change.old_text.empty()) continue;
            SCOPED_TRACE(change.key + " after " + change.after + ": " + change.new_text);
            const bool notes = change.new_text.find("\"notes\"") != std::string::npos;
            const SceneDescription other = parse(notes ? without_joints(changed(change)) : changed(change));
            const SceneDescription& before = notes ? unjoined : scene;
            EXPECT_NE(scene_hash(other), scene_hash(before));
            EXPECT_EQ(motion_hash(other) != motion_hash(before), change.motion);
        }
}

TEST(SceneHash, HasEachValueOfALight) {
    std::set<std::string> hashes;
    const std::vector<std::string> lights = {"",
                                             "direction = [0, -2, 1]",
                                             "color = \"#ff8040\"",
                                             "intensity = 2",
                                             "shadows = false",
                                             "type = \"point\"\nposition = [0, 1, 0]",
                                             "type = \"point\"\nposition = [0, 2, 0]",
                                             "type = \"spot\"\nposition = [0, 2, 0]",
                                             "type = \"spot\"\nposition = [0, 2, 0]\nangle = 20"};
    for (const std::string& light : lights) hashes.insert(scene_hash(parse("format = 1\n[[light]]\n" + light)));
    hashes.insert(scene_hash(parse("format = 1\n")));
    EXPECT_EQ(hashes.size(), lights.size() + 1);
}

TEST(SceneHash, TheListOfChangesHasEveryKeyOfTheReader) {
    std::multiset<std::set<std::string>> changed_keys, known_keys;
    for (const std::vector<Change>& table : all_tables()) {
        std::set<std::string> keys;
        for (const Change& change : table) keys.insert(change.key);
        changed_keys.insert(keys);
    }
    const std::regex call("expect_keys\\(\\s*\\{([^}]*)\\}\\)"), word("\"([^\"]*)\"");
    for (const auto& entry : fs::recursive_directory_iterator(source / "src/scene")) {
        if (entry.path().extension() != ".cpp") continue;
        std::ifstream file(entry.path());
        std::stringstream content;
        content << file.rdbuf();
        const std::string text = content.str();
        for (std::sregex_iterator one(text.begin(), text.end(), call), end; one != end; ++one) {
            const std::string list = (*one)[1];
            std::set<std::string> keys;
            for (std::sregex_iterator w(list.begin(), list.end(), word); w != end; ++w) keys.insert((*w)[1]);
            known_keys.insert(keys);
        }
    }
    for_all_fields([&]<class Struct>(const char*) {
        if (std::is_same_v<Struct, CopyLooks>) return;  // keys of a body
        if (std::is_same_v<Struct, PoseRow>) return;    // columns: posed_bodies_test.cpp
        KeyList list = std::is_same_v<Struct, BodyDescription>
                           ? list_keys<Struct, CopyLooks, Material, FractureMaterial>()
                       : std::is_same_v<Struct, ChainRequest> ? list_keys<Struct, Material>()
                                                              : list_keys<Struct>();
        if (std::is_same_v<Struct, ChainRequest>) std::erase(list.keys, "reflection");  // of planes; a link is none
        known_keys.emplace(list.keys.begin(), list.keys.end());
    });
    std::set<std::string> quantities;
    for (const auto& choice : choices<ArrowQuantity>) quantities.emplace(choice.name);
    known_keys.insert(quantities);  // scale and color of [overlay]
    EXPECT_EQ(changed_keys, known_keys);
}

// Hashes of scenes are in checkpoints and in records of golden frames.
TEST(SceneHash, NewerKeysThatAreNotGivenLeaveIt) {
    const std::string text =
        "format = 1\ntitle = \"s\"\n[[body]]\nshape = { type = \"sphere\", radius = 0.5 }\nposition = [0, 1, 0]\n";
    EXPECT_EQ(scene_hash(parse(text)), "3e143296116792ffa5cfb12b3ca21bad58668abc059b19cdee74917864e2d965");
    EXPECT_EQ(scene_hash(parse(text + "gravity_scale = 1\nlayers = []\n")), scene_hash(parse(text)));
}

TEST(SceneHash, HasTheTexelsOfATextureAndItsPlaceOnTheBody) {
    const TestFolder folder;
    const fs::path images = source / "tests/fuzz/corpus/texture";
    fs::copy_file(images / "rgb.png", folder / "one.png");
    fs::copy_file(images / "rgb.png", folder / "same.png");
    fs::copy_file(images / "holes.png", folder / "other.png");
    const auto hash_of = [&](const std::string& lines) {
        return scene_hash(parse("format = 1\n[[body]]\nshape = { type = \"box\", size = [1, 1, 1] }\n" + lines,
                                folder / "scene.toml"));
    };
    const std::string one = hash_of("texture = \"one.png\"");
    EXPECT_EQ(hash_of("texture = \"same.png\""), one);
    EXPECT_EQ(hash_of("texture = \"same.png\"\ntexture_filter = \"linear\""), one);
    EXPECT_NE(hash_of("texture = \"other.png\""), one);
    EXPECT_NE(hash_of("texture = \"one.png\"\ntexture_scale = 1"), one);
    EXPECT_NE(hash_of("texture = \"one.png\"\ntexture_filter = \"nearest\""), one);
}

/// Scenes without the keys of patterns and textures keep the hash that they had.
TEST(SceneHash, CallsTheGroovesOfABoxByTheNumberOfNoPattern) {
    EXPECT_EQ(int(Pattern::panel), 0);
    EXPECT_EQ(int(Pattern::grid), 1);
    EXPECT_EQ(int(Pattern::checker), 2);
}

TEST(SceneHash, CommentsOrderAndSpellingDoNotMatter) {
    const std::string text =
        "format = 1\n[simulation]\nduration = 2\nseed = 3\n[[body]]\nshape = { type = \"sphere\", "
        "radius = 0.5 }\nposition = [0, 1, 0]\n";
    const std::string same =
        "# a comment\nformat = 1\n[[body]]\nposition = [0.0, 1.0, 0]\nshape = { radius = 5e-1, type = "
        "\"sphere\" }\n[simulation]\nseed = 0x3\nduration = 2.0\n";
    EXPECT_EQ(scene_hash(parse(text)), scene_hash(parse(same, "/elsewhere/other.toml")));
}

TEST(SceneHash, TheNameOfTheFileCountsWhereItIsShown) {
    const std::string text =
        "format = 1\n[[body]]\nshape = { type = \"sphere\", radius = 0.5 }\n[overlay]\nshow = [\"title\"]\n";
    EXPECT_NE(scene_hash(parse(text, "a.toml")), scene_hash(parse(text, "b.toml")));
    EXPECT_EQ(scene_hash(parse(text, "a.toml")), scene_hash(parse(text, "folder/a.toml")));
    EXPECT_EQ(motion_hash(parse(text, "a.toml")), motion_hash(parse(text, "b.toml")));
    const std::string titled = "title = \"A\"\n" + text;
    EXPECT_EQ(scene_hash(parse(titled, "a.toml")), scene_hash(parse(titled, "b.toml")));
}

}  // namespace
}  // namespace tumble::scene_hash_test
