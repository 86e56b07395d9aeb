// Small scenes that together have every kind of state of a checkpoint.
#pragma once

#include <string_view>

namespace tumble::testing {

struct CheckpointScene {
    bool records;  // of contacts
    const char* text;
};

// A pile that falls asleep under a ball that comes later.
inline constexpr const char* sleeping_pile = R"(format = 1
[simulation]
steps_per_frame = 4
duration = 5
[[body]]
type = "fixed"
shape = { type = "plane" }
restitution = 0
[[body]]
shape = { type = "box", size = [1, 0.5, 1] }
position = [0, 0.25, 0]
[[body]]
shape = { type = "box", size = [0.6, 0.5, 0.6] }
position = [0, 0.75, 0]
[[body]]
shape = { type = "sphere", radius = 0.2 }
position = [-2.5, 0.2, 0]
velocity = [2, 0, 0]
)";

// A bar on two supports that breaks under a ball, and a spring on one of its pieces.
inline constexpr const char* breaking_bar = R"(format = 1
[[body]]
type = "fixed"
shape = { type = "box", size = [0.2, 0.4, 1] }
position = [-0.9, 0.2, 0]
[[body]]
type = "fixed"
shape = { type = "box", size = [0.2, 0.4, 1] }
position = [0.9, 0.2, 0]
[[body]]
name = "bar"
strength = 1e5
stiffness = 1e9
toughness = 1
shape = { type = "box", size = [2, 0.1, 0.2] }
position = [0, 0.45, 0]
fracture = { cells = 6, pattern = "slabs" }
[[body]]
shape = { type = "sphere", radius = 0.2 }
position = [0.1, 0.75, 0]
velocity = [0, -6, 0]
[[joint]]
type = "ball"
bodies = ["world", "bar"]
anchor = [-0.9, 0.5, 0]
)";

inline constexpr CheckpointScene checkpoint_scenes[] = {
    {false, sleeping_pile},
    {true, sleeping_pile},
    {true, breaking_bar},
    {false, R"(format = 1
[simulation]
integrator = "exact"
[[body]]
type = "fixed"
shape = { type = "box", size = [4, 1, 4] }
position = [0, -0.5, 0]
[[body]]
type = "kinematic"
shape = { type = "box", size = [1, 0.2, 1] }
position = [0, 0.1, 0]
keyframes = [{ time = 0, position = [0, 0.1, 0] }, { time = 1, position = [1, 0.1, 0] }]
[[body]]
shape = { type = "compound", parts = [
  { shape = { type = "box", size = [0.5, 0.1, 0.1] } }, { shape = { type = "sphere", radius = 0.1 }, position = [0.2, 0, 0] }] }
position = [0, 0.4, 0]
angular_velocity = [0.3, 1, 2]
[[body]]
shape = { type = "sphere", radius = 0.2 }
position = [0.2, 3, 0]
velocity = [0, -40, 0]
)"},
    {true, R"(format = 1
[simulation]
impacts = "exact"
duration = 5
[[body]]
type = "fixed"
shape = { type = "plane" }
restitution = 0.8
[[body]]
shape = { type = "sphere", radius = 0.2 }
position = [0, 0.5, 0]
restitution = 0.9
[[body]]
shape = { type = "sphere", radius = 0.2 }
position = [0.1, 1.2, 0]
restitution = 0.9
[[body]]
shape = { type = "box", size = [0.4, 0.2, 0.3] }
position = [1, 0.4, 0]
angular_velocity = [1, 2, 3]
restitution = 0.3
[[body]]
type = "fixed"
shape = { type = "box", size = [0.2, 1, 1] }
position = [2, 0.5, 0]
)"},
    {true, R"(format = 1
[[body]]
type = "fixed"
shape = { type = "plane" }
[[body]]
name = "a"
shape = { type = "box", size = [0.6, 0.1, 0.1] }
position = [0.3, 2, 0]
[[body]]
name = "b"
shape = { type = "box", size = [0.6, 0.1, 0.1] }
position = [0.9, 2, 0]
[[body]]
name = "c"
shape = { type = "sphere", radius = 0.1 }
position = [1.5, 2, 0]
[[joint]]
type = "hinge"
bodies = ["world", "a"]
anchor = [0, 2, 0]
axis = [0, 0, 1]
motor = { keyframes = [{ time = 0, value = 0 }, { time = 1, value = 90 }], stiffness = 3, damping = 1, max_torque = 9 }
[[joint]]
type = "ball"
bodies = ["a", "b"]
anchor = [0.6, 2, 0]
axis = [1, 0, 0]
swing = 40
[[joint]]
type = "distance"
bodies = ["b", "c"]
anchors = [[0.3, 0, 0], [0, 0, 0]]
max_length = 0.5
break_force = 50
)"},
    {false, R"(format = 1
[simulation]
impacts = "exact"
[[body]]
type = "fixed"
shape = { type = "plane" }
[[body]]
name = "a"
shape = { type = "box", size = [0.6, 0.1, 0.1] }
position = [0.3, 1, 0]
[[body]]
name = "b"
shape = { type = "box", size = [0.6, 0.1, 0.1] }
position = [0.9, 1, 0]
[[joint]]
type = "hinge"
bodies = ["a", "b"]
anchor = [0.6, 1, 0]
axis = [0, 0, 1]
[[joint]]
type = "ball"
bodies = ["world", "b"]
anchor = [1.2, 1, 0]
)"},
    {false, R"(format = 1
[simulation]
method = "notes"
steps_per_frame = 4
[[body]]
type = "fixed"
shape = { type = "plane" }
[[body]]
shape = { type = "box", size = [0.4, 0.2, 0.3] }
position = [1, 0.3, 0]
angular_velocity = [1, 2, 3]
)"},
};

}  // namespace tumble::testing
