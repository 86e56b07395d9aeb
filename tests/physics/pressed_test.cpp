// Contacts under load with restitution: a support that pushes, forces and wind make no impact of a step's approach,
// however strong they are beside gravity, and contact forces carry the load. Impacts remain impacts.
#include "scene/load.h"
#include "sim/world.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>

namespace tumble::pressed_test {
namespace {

SceneDescription parse(const std::string& text) { return parse_scene("format = 1\n" + text, "scene.toml"); }

struct Load {
    std::size_t impacts = 0;            // rows
    double force = 0.0, overlap = 0.0;  // N, mean over the frames of the second half; m, the largest in them
};

Load measure(const SceneDescription& scene) {
    World world(scene);
    world.record_contacts();
    Load load;
    const std::int64_t frames = scene.frame_count() - 1, half = frames / 2;
    for (std::int64_t frame = 0; frame < frames; ++frame) {
        world.advance_frame();
        load.impacts += world.contact_records().impacts.size();
        if (frame < half) continue;
        for (const ContactRecord& r : world.contact_records().contacts)
            load.force += r.normal_force / double(frames - half);
        load.overlap = std::max(load.overlap, world.measure().max_penetration);
    }
    return load;
}

const char* const modes[] = {"stepped", "exact"};

// A crate of 2 kg on a plate that rises with a (m/s^2).
SceneDescription lift(double a, double e, const std::string& mode) {
    const double span = 1.0;  // beyond the duration: the end of the path is a kink
    std::string keys;
    for (int k = 0; k <= 120; ++k) {
        const double t = span * k / 120.0;
        keys += fmt::format("{{ time = {}, position = [0, {}, 0] }}, ", t, 0.5 * a * t * t);
    }
    return parse(fmt::format(R"(
[simulation]
duration = 0.5
impacts = "{}"
[[body]]
type = "kinematic"
shape = {{ type = "box", size = [2, 0.1, 2] }}
keyframes = [{}]
[[body]]
mass = 2
shape = {{ type = "box", size = [0.4, 0.3, 0.4] }}
position = [0, 0.2, 0]
restitution = {}
)",
                             mode, keys, e));
}

TEST(Pressed, ALiftThatAcceleratesCarriesItsLoad) {
    for (const char* mode : modes)
        for (const double g : {3.0, 10.0})
            for (const double e : {0.2, 0.5, 0.8}) {
                const Load load = measure(lift(9.81 * g, e, mode));
                EXPECT_NEAR(load.force / (2.0 * 9.81 * (1.0 + g)), 1.0, 0.01) << mode << ' ' << g << ' ' << e;
                EXPECT_LT(load.impacts, 20u) << mode << ' ' << g << ' ' << e;
                EXPECT_LT(load.overlap, 1e-4) << mode << ' ' << g << ' ' << e;
            }
}

// A box that 100 N press to a wall, without gravity.
TEST(Pressed, AForcePressesWithoutBounces) {
    for (const char* mode : modes)
        for (const double e : {0.0, 0.2, 0.5, 0.8}) {
            const Load load = measure(parse(fmt::format(R"(
[simulation]
duration = 1
gravity = [0, 0, 0]
impacts = "{}"
[[body]]
type = "fixed"
shape = {{ type = "box", size = [0.2, 4, 4] }}
[[body]]
name = "box"
mass = 2
shape = {{ type = "box", size = [0.4, 0.4, 0.4] }}
position = [0.3, 0, 0]
restitution = {}
[[force]]
body = "box"
force = [-100, 0, 0]
)",
                                                        mode, e)));
            EXPECT_NEAR(load.force, 100.0, 0.1) << mode << ' ' << e;
            EXPECT_LT(load.impacts, 20u) << mode << ' ' << e;
            EXPECT_LT(load.overlap, 1e-4) << mode << ' ' << e;
        }
}

// Wind of 27 N lands a ball on a wall, where it bounces until it rests.
TEST(Pressed, WindPressesAfterTheLastBounce) {
    for (const char* mode : modes) {
        const Load load = measure(parse(fmt::format(R"(
[simulation]
duration = 3
gravity = [0, 0, 0]
impacts = "{}"
[wind]
velocity = [-30, 0, 0]
[[body]]
type = "fixed"
shape = {{ type = "box", size = [0.2, 4, 4] }}
[[body]]
mass = 1
shape = {{ type = "sphere", radius = 0.2 }}
position = [0.5, 0, 0]
restitution = 0.5
)",
                                                    mode)));
        EXPECT_NEAR(load.force, 0.5 * 1.2 * std::numbers::pi * 0.04 * 900.0, 0.1) << mode;
        EXPECT_LT(load.overlap, 1e-4) << mode;
    }
}

// A ball at rest in the corner of a square drum that turns.
SceneDescription drum(double turns, bool gravity, const std::string& solver, const std::string& mode) {
    std::string keys;
    for (int k = 0; k <= int(4.0 * turns) + 2; ++k)
        keys +=
            fmt::format("{{ time = {}, rotation = {{ axis = [0, 0, 1], angle = {} }} }}, ", 0.25 * k / turns, 90 * k);
    const double w = 2.0 * std::numbers::pi * turns;
    return parse(fmt::format(R"(
[simulation]
duration = 1
gravity = [0, {}, 0]
contact_solver = "{}"
impacts = "{}"
[[body]]
type = "kinematic"
restitution = 0.2
friction = 0
shape = {{ type = "compound", parts = [
  {{ shape = {{ type = "box", size = [4, 0.5, 2] }}, position = [0, 2.25, 0] }},
  {{ shape = {{ type = "box", size = [4, 0.5, 2] }}, position = [0, -2.25, 0] }},
  {{ shape = {{ type = "box", size = [0.5, 4, 2] }}, position = [2.25, 0, 0] }},
  {{ shape = {{ type = "box", size = [0.5, 4, 2] }}, position = [-2.25, 0, 0] }} ] }}
interpolation = "linear"
keyframes = [{}]
[[body]]
mass = 1
shape = {{ type = "sphere", radius = 0.14 }}
position = [1.86, 1.86, 0]
velocity = [{}, {}, 0]
angular_velocity = [0, 0, {}]
friction = 0
restitution = 0.2
)",
                             gravity ? -9.81 : 0.0, solver, mode, keys, -w * 1.86, w * 1.86, w));
}

// In a frame that turns with the drum the ball is pressed to two walls by w^2 r, and by gravity.
TEST(Pressed, ATurningDrumHoldsABall) {
    for (const double rpm : {10.0, 60.0, 120.0})
        for (const bool gravity : {false, true})
            for (const char* solver : {"by-island", "soft"})
                for (const char* mode : modes) {
                    if (gravity && rpm < 60.0) continue;  // it falls from the upper corner
                    const Load load = measure(drum(rpm / 60.0, gravity, solver, mode));
                    const double w = rpm / 60.0 * 2.0 * std::numbers::pi;
                    const std::string which = fmt::format("{} rpm, gravity {}, {}, {}", rpm, gravity, solver, mode);
                    EXPECT_LT(load.impacts, 10u) << which;
                    EXPECT_LT(load.overlap, 1e-3) << which;
                    if (!gravity) {
                        EXPECT_NEAR(load.force / (2.0 * w * w * 1.86), 1.0, 0.02) << which;
                    }
                }
}

}  // namespace
}  // namespace tumble::pressed_test
