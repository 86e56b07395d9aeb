#include "scene/scene_changes.h"

namespace tumble {

const std::string joint_lines = R"(
[[joint]]
name = "elbow"
type = "hinge"
bodies = ["ball", "cloud.0"]
anchor = [1, 0, 0]
axis = [0, 0, 1]
frame = "first"
start_angle = 5
limits = [-10, 140]
limit_restitution = 0.5
spring = { stiffness = 50, damping = 2, rest = 3 }
motor = { target = 45, stiffness = 11, damping = 12, max_torque = 13 }
friction = 0.1
friction_coefficient = 0.3
bearing_radius = 0.02
break_force = 500
break_torque = 20
break_impulse = 7
collide = false
enabled = [0.5, 1.5]
[[joint]]
name = "rail"
type = "cylindrical"
bodies = ["ball", "table"]
anchor = [0, 1, 0]
axis = [0, 1, 0]
start_position = 0.25
limits = [-1, 2]
turn_limits = [-60, 50]
spring = { frequency = 3, damping_ratio = 0.5 }
turn_spring = { stiffness = 4 }
motor = { speed = 0.5, max_force = 6 }
turn_motor = { keyframes = [{ time = 0.5, value = 0 }, { time = 1.5, value = 30 }], stiffness = 8 }
turn_friction = 0.2
[[joint]]
name = "shoulder"
type = "ball"
bodies = ["ball", "cloud.1"]
anchors = [[0, 0, 0], [0, 0, 0]]
snap = true
axes = [[1, 0, 0], [0, 1, 0]]
swing = [60, 30]
twist = [-20, 25]
[[joint]]
name = "cross"
type = "universal"
bodies = ["cloud.2", "world"]
anchor = [0, 3, 0]
axis = [1, 0, 0]
second_axis = [0, 1, 0]
second_limits = [-40, 40]
[[joint]]
name = "rod"
type = "distance"
bodies = ["cloud.0", "world"]
anchors = [[0, 0, 0], [0, 9, 0]]
snap = true
length = 2
[[joint]]
name = "rope"
type = "distance"
bodies = ["cloud.0", "cloud.1"]
anchors = [[0, 0, 0], [0, 0, 0]]
snap = true
min_length = 1
max_length = 20
visible = false
[[joint]]
name = "free"
type = "6dof"
bodies = ["table", "world"]
anchor = [0, 5, 0]
move_x = { limits = [-1, 1], limit_restitution = 0.25, spring = { stiffness = 2 }, motor = { speed = 1 }, friction = 3 }
move_y = "free"
move_z = [-3, 3]
turn_x = [-4, 4]
turn_y = [-5, 5]
turn_z = "locked"
[[joint]]
name = "flap"
type = "hinge"
bodies = ["cloud.1", "world"]
anchor = [0, 0, 0]
axis = [0, 1, 0]
[[joint]]
name = "drawer"
type = "slider"
bodies = ["cloud.2", "world"]
axis = [0, 1, 0]
[[joint]]
name = "gear"
type = "gear"
joints = ["flap", "drawer"]
ratio = 2.5
[[chain]]
name = "rope"
links = 5
from = [0, 20, 0]
to = [3, 20, 0]
sag = 0.5
joint = { type = "ball", friction = 0.75 }
twist = 30
ends = ["table", "free"]
shape = { type = "box", size = [0.6, 0.1, 0.2] }
material = "steel"
color = "#030201"
visible = false
friction = 0.25
velocity = [0, 0, 1]
[[chain]]
name = "ring"
links = 6
from = [0, 30, 0]
to = [3, 30, 0]
loop = true
normal = [0, 1, 0]
shape = { type = "sphere", radius = 0.5 }
colors = ["#030303", "#040404"]
[template.door]
[[template.door.body]]
name = "frame"
shape = { type = "box", size = [0.2, 2, 0.2] }
[[template.door.body]]
name = "leaf"
shape = { type = "box", size = [1, 2, 0.1] }
position = [0.6, 0, 0]
[[template.door.joint]]
name = "pin"
type = "hinge"
bodies = ["frame", "leaf"]
anchor = [0.1, 0, 0]
axis = [0, 1, 0]
[[template.door.chain]]
name = "lock"
links = 2
from = [0, 1.5, 0]
to = [1, 1.5, 0]
shape = { type = "box", size = [0.3, 0.1, 0.1] }
ends = ["frame", "leaf"]
[template.other]
[[template.other.body]]
name = "leaf"
shape = { type = "sphere", radius = 1 }
[[template.other.joint]]
name = "pin"
type = "hinge"
bodies = ["leaf", "world"]
anchor = [0, 0, 0]
axis = [0, 1, 0]
[[instance]]
template = "door"
name = "gate"
position = [20, 0, 0]
rotation = { axis = [0, 1, 0], angle = 45 }
scale = 2
mass = 70
velocity = [0, 0, 0.5]
angular_velocity = [0, 0.25, 0]
grid = { count = [1, 2, 1], spacing = 9 }
colors = ["#050505"]
[[instance]]
template = "other"
name = "sign"
pose = { pin = 20 }
color = "#070707"
)";

const std::vector<std::vector<Change>> joint_changes = {
    {{"body", "", "[[template.other.body]]",
      "[[template.other.body]]\nshape = { type = \"sphere\", radius = 2 }\n[[template.other.body]]", true},
     {"joint", "[[template.door.joint]]", "axis = [0, 1, 0]", "axis = [0, 1, 1]", true},
     {"chain", "[[template.door.chain]]", "links = 2", "links = 3", true},
     {"file", "", "", "", true}},  // TemplatesInFiles
    {{"format", "", "", "", true},
     {"title", "", "", "", true},
     {"materials", "", "", "", true},
     {"body", "", "", "", true},
     {"joint", "", "", "", true},
     {"chain", "", "", "", true}},  // of a template's file
    {{"template", "[[instance]]", "template = \"door\"", "template = \"other\"", true},
     {"name", "[[instance]]", "name = \"gate\"", "name = \"fence\"", true},
     {"position", "[[instance]]", "position = [20, 0, 0]", "position = [21, 0, 0]", true},
     {"rotation", "[[instance]]", "angle = 45", "angle = 46", true},
     {"scale", "[[instance]]", "scale = 2", "scale = 3", true},
     {"mass", "[[instance]]", "mass = 70", "mass = 71", true},
     {"velocity", "[[instance]]", "velocity = [0, 0, 0.5]", "velocity = [0, 0, 0.25]", true},
     {"angular_velocity", "[[instance]]", "angular_velocity = [0, 0.25, 0]", "angular_velocity = [0, 0.5, 0]", true},
     {"pose", "[[instance]]", "pose = { pin = 20 }", "pose = { pin = 21 }", true},
     {"grid", "[[instance]]", "spacing = 9", "spacing = 8", true},
     {"scatter", "[[instance]]", "grid = { count = [1, 2, 1], spacing = 9 }",
      "scatter = { count = 2, size = [99, 99, 99] }", true},
     {"color", "[[instance]]", "#070707", "#080808", false},
     {"colors", "[[instance]]", "#050505", "#060606", false}},
    {{"name", "[[chain]]", "name = \"rope\"", "name = \"string\"", true},
     {"links", "[[chain]]", "links = 5", "links = 6", true},
     {"shape", "[[chain]]", "size = [0.6, 0.1, 0.2]", "size = [0.6, 0.1, 0.1]", true},
     {"from", "[[chain]]", "from = [0, 20, 0]", "from = [0.1, 20, 0]", true},
     {"to", "[[chain]]", "to = [3, 20, 0]", "to = [3, 20, 1]", true},
     {"sag", "[[chain]]", "sag = 0.5", "sag = 0.6", true},
     {"length", "[[chain]]", "sag = 0.5", "length = 4", true},
     {"loop", "name = \"ring\"", "loop = true\nnormal = [0, 1, 0]", "", true},
     {"normal", "name = \"ring\"", "normal = [0, 1, 0]", "normal = [0, 1, 1]", true},
     {"twist", "[[chain]]", "twist = 30", "twist = 31", true},
     {"joint", "[[chain]]", "friction = 0.75", "friction = 0.8", true},
     {"ends", "[[chain]]", "\"table\"", "\"world\"", true},
     {"material", "[[chain]]", "material = \"steel\"", "", true},
     {"color", "[[chain]]", "#030201", "#030202", false},
     {"colors", "name = \"ring\"", "\"#040404\"", "\"#040405\"", false},
     {"roughness", "[[chain]]", "twist = 30", "twist = 30\nroughness = 0.125", false},
     {"metallic", "[[chain]]", "twist = 30", "twist = 30\nmetallic = 0.125", false},
     {"pattern", "[[chain]]", "twist = 30", "twist = 30\npattern = \"grid\"", false},
     {"pattern_color", "[[chain]]", "twist = 30", "twist = 30\npattern_color = \"#405060\"", false},
     {"pattern_scale", "[[chain]]", "twist = 30", "twist = 30\npattern_scale = 2", false},
     {"texture", "[[chain]]", "twist = 30", "twist = 30\n" + texture_line(), false},
     {"texture_scale", "[[chain]]", "twist = 30", "twist = 30\ntexture_scale = 3\n" + texture_line(), false},
     {"normal_map", "[[chain]]", "twist = 30", "twist = 30\n" + image_line("normal_map"), false},
     {"roughness_map", "[[chain]]", "twist = 30", "twist = 30\n" + image_line("roughness_map"), false},
     {"opacity", "[[chain]]", "twist = 30", "twist = 30\nopacity = 0.5", false},
     {"emission", "[[chain]]", "twist = 30", "twist = 30\nemission = \"#101010\"", false},
     {"texture_filter", "[[chain]]", "twist = 30", "twist = 30\ntexture_filter = \"nearest\"\n" + texture_line(),
      false},
     {"visible", "[[chain]]", "visible = false", "visible = true", false},
     {"density", "[[chain]]", "twist = 30", "twist = 30\ndensity = 20", true},
     {"mass", "[[chain]]", "twist = 30", "twist = 30\nmass = 20", true},
     {"restitution", "[[chain]]", "twist = 30", "twist = 30\nrestitution = 0.125", true},
     {"friction", "[[chain]]", "friction = 0.25", "friction = 0.5", true},
     {"rolling_friction", "[[chain]]", "twist = 30", "twist = 30\nrolling_friction = 0.25", true},
     {"spinning_friction", "[[chain]]", "twist = 30", "twist = 30\nspinning_friction = 0.25", true},
     {"sound", "[[chain]]", "twist = 30", "twist = 30\nsound = \"glass\"", true},
     {"velocity", "[[chain]]", "velocity = [0, 0, 1]", "velocity = [0, 0, 2]", true},
     {"integrator", "[[chain]]", "twist = 30", "twist = 30\nintegrator = \"rk4\"", true}},
    {{"name", "[[joint]]", "elbow", "knee", true},
     {"type", "\"cross\"",
      "type = \"universal\"\nbodies = [\"cloud.2\", \"world\"]\nanchor = [0, 3, 0]\naxis = [1, 0, 0]\n"
      "second_axis = [0, 1, 0]\nsecond_limits = [-40, 40]",
      "type = \"ball\"\nbodies = [\"cloud.2\", \"world\"]\nanchor = [0, 3, 0]", true},
     {"joints", "\"gear\"", "\"drawer\"", "\"elbow\"", true},
     {"ratio", "\"gear\"", "ratio = 2.5", "ratio = -2.5", true},
     {"bodies", "[[joint]]", "\"cloud.0\"", "\"world\"", true},
     {"anchor", "[[joint]]", "anchor = [1, 0, 0]", "anchor = [2, 0, 0]", true},
     {"anchors", "\"shoulder\"", "[[0, 0, 0]", "[[0, 1, 0]", true},
     {"axis", "[[joint]]", "axis = [0, 0, 1]", "axis = [0, 1, 1]", true},
     {"axes", "\"shoulder\"", "axes = [[1, 0, 0]", "axes = [[2, 1, 0]", true},
     {"second_axis", "\"cross\"", "second_axis = [0, 1, 0]", "second_axis = [0, 1, 1]", true},
     {"frame", "[[joint]]", "frame = \"first\"", "frame = \"second\"", true},
     {"snap", "\"rail\"", "anchor = [0, 1, 0]", "anchor = [0, 1.5, 0]\nsnap = true", true},
     {"start_angle", "[[joint]]", "start_angle = 5", "start_angle = 6", true},
     {"start_position", "\"rail\"", "start_position = 0.25", "start_position = 0.5", true},
     {"limits", "[[joint]]", "[-10, 140]", "[-11, 140]", true},
     {"turn_limits", "\"rail\"", "turn_limits = [-60, 50]", "turn_limits = [-60, 51]", true},
     {"second_limits", "\"cross\"", "[-40, 40]", "[-40, 41]", true},
     {"swing", "\"shoulder\"", "swing = [60, 30]", "swing = 60", true},
     {"twist", "\"shoulder\"", "twist = [-20, 25]", "", true},
     {"limit_restitution", "[[joint]]", "limit_restitution = 0.5", "", true},
     {"spring", "[[joint]]", "spring = { stiffness = 50, damping = 2, rest = 3 }", "", true},
     {"turn_spring", "\"rail\"", "turn_spring = { stiffness = 4 }", "", true},
     {"motor", "\"rail\"", "motor = { speed = 0.5, max_force = 6 }", "", true},
     {"turn_motor", "\"rail\"", "turn_motor = {", "turn_motor = { damping = 3,", true},
     {"friction", "[[joint]]", "friction = 0.1", "friction = 0.2", true},
     {"turn_friction", "\"rail\"", "turn_friction = 0.2", "turn_friction = 0.3", true},
     {"friction_coefficient", "[[joint]]", "friction_coefficient = 0.3", "friction_coefficient = 0.4", true},
     {"bearing_radius", "[[joint]]", "bearing_radius = 0.02", "bearing_radius = 0.03", true},
     {"armature", "[[joint]]", "bearing_radius = 0.02", "bearing_radius = 0.02\narmature = 0.1", true},
     {"length", "\"rod\"", "length = 2", "length = 3", true},
     {"min_length", "\"rope\"", "min_length = 1", "", true},
     {"max_length", "\"rope\"", "max_length = 20", "max_length = 21", true},
     {"move_x", "\"free\"", "limits = [-1, 1], limit_restitution = 0.25, ", "", true},
     {"move_y", "\"free\"", "move_y = \"free\"", "", true},
     {"move_z", "\"free\"", "move_z = [-3, 3]", "move_z = [-4, 3]", true},
     {"turn_x", "\"free\"", "turn_x = [-4, 4]", "turn_x = \"free\"", true},
     {"turn_y", "\"free\"", "turn_y = [-5, 5]", "turn_y = [-6, 5]", true},
     {"turn_z", "\"free\"", "turn_z = \"locked\"", "turn_z = \"free\"", true},
     {"break_force", "[[joint]]", "break_force = 500", "", true},
     {"break_torque", "[[joint]]", "break_torque = 20", "", true},
     {"break_impulse", "[[joint]]", "break_impulse = 7", "", true},
     {"collide", "[[joint]]", "collide = false", "collide = true", true},
     {"enabled", "[[joint]]", "enabled = [0.5, 1.5]", "enabled = [0.5]", true},
     {"visible", "\"rope\"", "visible = false", "visible = true", false}},
    {{"stiffness", "[[joint]]", "stiffness = 50", "stiffness = 51", true},
     {"damping", "[[joint]]", "damping = 2", "damping = 3", true},
     {"frequency", "\"rail\"", "frequency = 3", "frequency = 4", true},
     {"damping_ratio", "\"rail\"", "damping_ratio = 0.5", "damping_ratio = 0.6", true},
     {"rest", "[[joint]]", "rest = 3", "rest = 4", true}},
    {{"speed", "\"rail\"", "speed = 0.5", "speed = 0.6", true},
     {"target", "[[joint]]", "target = 45", "target = 46", true},
     {"keyframes", "\"rail\"", "{ time = 0.5, value = 0 }, ", "", true},
     {"interpolation", "\"rail\"", "stiffness = 8", "stiffness = 8, interpolation = \"linear\"", true},
     {"stiffness", "[[joint]]", "stiffness = 11", "stiffness = 12", true},
     {"damping", "[[joint]]", "damping = 12", "damping = 14", true},
     {"max_torque", "[[joint]]", "max_torque = 13", "max_torque = 14", true},
     {"max_force", "\"rail\"", "max_force = 6", "max_force = 7", true}},
    {{"time", "\"rail\"", "time = 1.5", "time = 1.6", true}, {"value", "\"rail\"", "value = 30", "value = 31", true}},
    {{"limits", "\"free\"", "limits = [-1, 1]", "limits = [-1, 2]", true},
     {"limit_restitution", "\"free\"", "limit_restitution = 0.25", "limit_restitution = 0.5", true},
     {"spring", "\"free\"", "spring = { stiffness = 2 }, ", "", true},
     {"motor", "\"free\"", "motor = { speed = 1 }, ", "", true},
     {"friction", "\"free\"", "friction = 3", "friction = 4", true}},
};

}  // namespace tumble
