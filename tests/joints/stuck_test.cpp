// A step in which no solution is found: overlaps that a limit with restitution holds, heavy on light.
#include "scene/load.h"
#include "sim/world.h"

#include <gtest/gtest.h>

namespace tumble {

// Where Newton's method stalls in its first round, the ends of the bodies are those of the velocities it has reached:
// the limit looked for its impact at the ends of another island, or of none.
TEST(StuckJoints, LookForImpactsOfLimitsAtTheEndsOfTheirOwnBodies) {
    World world(parse_scene(R"(
format = 1
[[body]]
shape = { type = "sphere", radius = 1.5 }
density = 7800
[[body]]
type = "fixed"
shape = { type = "plane", normal = [0, 3, 4], offset = 0.5 }
[[body]]
type = "kinematic"
shape = { type = "box", size = [1, 1, 1] }
[[body]]
name = "plate"
shape = { type = "compound", parts = [{ shape = { type = "box", size = [1, 1, 2] }, position = [0, 0, 1], rotation = [0, 0, 1, 0], density = 70 }] }
[[body]]
shape = { type = "box", size = [0.5, 0.5, 0.5] }
grid = { count = [2, 1, 2], spacing = 0.75, jitter = 0.05, tilt = 10 }
scale = [0.5, 0.9]
[[joint]]
type = "6dof"
bodies = ["plate", "world"]
anchor = [0, 5, 0]
move_x = { limits = [-1, 1], limit_restitution = 0.25, spring = { stiffness = 2 }, motor = { speed = 1 }, friction = 3 }
move_y = "free"
move_z = [-3, 3]
turn_y = [-5, 5]
)",
                            "stuck.toml"));
    for (int frame = 0; frame < 12; ++frame) world.advance_frame();
    for (const BodyState& body : world.snapshot().bodies) EXPECT_TRUE(body.center_of_mass.allFinite());
}

}  // namespace tumble
