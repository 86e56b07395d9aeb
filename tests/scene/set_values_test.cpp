// Values of the command line by their paths (--set): every kind of place in a scene, and the messages for wrong ones.
#include "core/error.h"
#include "scene/load.h"

#include <gtest/gtest.h>

#include <string>
#include <vector>

namespace tumble::set_values_test {
namespace {

const std::string scene_text = R"(format = 1
[simulation]
duration = 2
[[body]]
name = "floor"
type = "fixed"
shape = { type = "plane" }
[[body]]
name = "crate.1"
shape = { type = "box", size = [1, 2, 3] }
position = [0, 3, 0]
)";

SceneDescription with(const std::vector<std::string>& values) {
    SceneOverrides overrides;
    overrides.set = values;
    return parse_scene(scene_text, "scene.toml", overrides);
}

std::string error_of(const std::string& value) {
    try {
        with({value});
    } catch (const InputError& error) {
        return error.what();
    }
    return "no error";
}

TEST(SetValues, ReplacesAndAddsKeys) {
    const SceneDescription scene = with({"simulation.duration=7.5", "output.fps=25", "title=Two words",
                                         "simulation.gravity=[0, -1.62, 0]", "simulation.sleep=false"});
    EXPECT_EQ(scene.simulation.duration, 7.5);
    EXPECT_EQ(scene.output.fps, 25.0);
    EXPECT_EQ(scene.title, "Two words");
    EXPECT_EQ(scene.simulation.gravity, Vec3(0.0, -1.62, 0.0));
    EXPECT_FALSE(scene.simulation.sleep);
}

TEST(SetValues, FindsBodiesByNameAndByNumber) {
    const SceneDescription scene = with({"body.floor.restitution=0.25", "body.1.friction=0.75",
                                         R"(body."crate.1".position.1=9)", "body.1.shape.size=[2, 2, 2]"});
    EXPECT_EQ(scene.bodies[0].restitution, 0.25);
    EXPECT_EQ(scene.bodies[1].friction, 0.75);
    EXPECT_EQ(scene.bodies[1].position, Vec3(0.0, 9.0, 0.0));
    EXPECT_EQ(std::get<BoxShape>(scene.bodies[1].shape).size, Vec3(2.0, 2.0, 2.0));
}

TEST(SetValues, LaterOnesReplaceEarlierOnes) {
    EXPECT_EQ(with({"simulation.duration=1", "simulation.duration=3"}).simulation.duration, 3.0);
}

TEST(SetValues, ErrorsNameTheOptionAndSuggest) {
    EXPECT_EQ(
        error_of("simulation.durration=2"),
        "error: --set simulation.durration: unknown key \"durration\" in [simulation] (did you mean \"duration\"?)");
    EXPECT_EQ(error_of("simulaton.duration=2"),
              "error: --set simulaton: unknown key \"simulaton\" in a scene (did you mean \"simulation\"?)");
    EXPECT_EQ(error_of("body.flor.mass=2"),
              "error: --set body.flor.mass=2: there is no element \"flor\" in an array of 2 (did you mean \"floor\"?)");
    EXPECT_EQ(error_of("body.7.mass=2"),
              "error: --set body.7.mass=2: there is no element \"7\" in an array of 2 (known: "
              "\"floor\", \"crate.1\")");
    EXPECT_EQ(error_of("simulation.duration=-1").find("error: --set simulation.duration: must be"), 0u);
    EXPECT_EQ(error_of("simulation.gravity=[0, 1]"),
              "error: --set simulation.gravity: must be an array of 3 numbers (given [0, 1])");
    EXPECT_EQ(error_of("title.x=1"), "error: --set title: must be a string (given a table)");
    EXPECT_EQ(error_of("simulation.duration"),
              "error: --set simulation.duration: has no value; write PATH=VALUE, as in simulation.duration=2");
    EXPECT_EQ(error_of(".duration=2"),
              "error: --set .duration=2: has an empty key in its path; write PATH=VALUE, as in "
              "simulation.duration=2");
}

}  // namespace
}  // namespace tumble::set_values_test
