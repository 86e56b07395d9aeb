// Suites of golden images: their values, and the place of every mistake.
#include "app/golden/suite.h"
#include "core/error.h"
#include "support/folder.h"

#include <gtest/gtest.h>

#include <string>
#include <vector>

namespace tumble::golden_suite_test {
namespace {

const std::string head = "format = 1\n";

GoldenSuite suite_of(const std::string& text) { return parse_suite(text, "suites/golden.toml"); }

/// "LINE:COLUMN: message" of the mistake.
std::string mistake(const std::string& text) {
    try {
        suite_of(text);
    } catch (const InputError& error) {
        return std::string(error.what()).substr(std::string("suites/golden.toml:").size());
    }
    return "none";
}

TEST(GoldenSuite, HasTheValuesOfItsCasesAndOfTheDefaults) {
    const GoldenSuite suite = suite_of(head + R"(
references = "../pictures"
[defaults]
size = [160, 90]
fps = 30
frames = [0, 15]
[[case]]
scene = "a.toml"
[[case]]
name = "b.2"
scenes = ["x/a.toml", "/abs/b.toml"]
frames = [3]
size = [320, 180]
duration = 2.5
samples = 1
overlay = ["clock", "forces"]
plot = "energy"
plot_place = "below"
layout = "grid"
vary = ["body.x.mass=1,2"]
set = ["simulation.sleep=false"]
seed = 7
transparent = true
speed = 0.5
shutter = 180
blur_samples = 4
tolerances = { levels = 9 }
[[case]]
name = "p"
scene = "a.toml"
of = ["energy", "contacts"]
)");
    EXPECT_EQ(suite.references, "pictures");
    ASSERT_EQ(suite.cases.size(), 3u);
    const GoldenCase& a = suite.cases[0];
    EXPECT_EQ(a.name, "a");
    EXPECT_EQ(a.scenes, std::vector<std::filesystem::path>{"suites/a.toml"});
    EXPECT_EQ(a.frames, (std::vector<std::int64_t>{0, 15}));
    EXPECT_EQ(a.overrides.width, 160);
    EXPECT_EQ(a.overrides.fps, 30.0);
    EXPECT_EQ(a.image_name(15), "a_000015.png");
    const GoldenCase& b = suite.cases[1];
    EXPECT_EQ(b.name, "b.2");
    EXPECT_EQ(b.scenes, (std::vector<std::filesystem::path>{"suites/x/a.toml", "/abs/b.toml"}));
    EXPECT_EQ(b.overrides.height, 180);
    EXPECT_EQ(b.overrides.fps, 30.0);
    EXPECT_EQ(b.overrides.overlay, "clock,forces");
    EXPECT_EQ(b.overrides.plot_place, "below");
    EXPECT_EQ(b.overrides.set, (std::vector<std::string>{"simulation.sleep=false", "simulation.seed=7"}));
    EXPECT_EQ(b.arrangement, PanelArrangement::grid);
    EXPECT_TRUE(b.transparent);
    EXPECT_EQ(b.tolerances->of("b.2_000003.png").pixels.tolerance, 9);
    EXPECT_EQ(suite.cases[2].of, "energy,contacts");
    EXPECT_EQ(suite.cases[2].frames, std::vector<std::int64_t>{0});
}

TEST(GoldenSuite, NamesThePlaceOfEachMistake) {
    const std::string one = head + "[[case]]\nscene = \"a.toml\"\n";
    EXPECT_EQ(mistake(one), "none");
    EXPECT_EQ(mistake("[[case]]\n"), "1:1: error: a suite starts with \"format = 1\" (not given)");
    EXPECT_EQ(mistake("format = 2\n"), "1:10: error: format must be 1, the only one there is (given 2)");
    EXPECT_EQ(mistake(head), "1:1: error: a suite needs a case: [[case]] with scene = \"FILE\" (not given)");
    EXPECT_EQ(mistake(head + "[[case]]\n"), "2:1: error: a case needs \"scene\", the path of a scene file (not given)");
    EXPECT_EQ(mistake(head + "refrences = \"x\"\n"),
              "2:1: error: unknown key \"refrences\" in a suite (did you mean \"references\"?)");
    EXPECT_EQ(mistake(one + "frame = [1]\n"), "4:1: error: unknown key \"frame\" in a case (did you mean \"frames\"?)");
    EXPECT_EQ(mistake(one + "frames = []\n"), "4:10: error: frames must have 1 to 1000 numbers of frames (given [])");
    EXPECT_EQ(mistake(one + "frames = [3, 3]\n"),
              "4:14: error: frames must be larger than the number before it (given 3)");
    EXPECT_EQ(mistake(one + "size = [160]\n"),
              "4:8: error: size must be an array of 2 whole numbers, width and height (given [160])");
    EXPECT_EQ(mistake(one + "name = \"a/b\"\n").substr(0, 27), "4:8: error: name must have ");
    EXPECT_EQ(mistake(one + "scenes = [\"b.toml\"]\n").substr(0, 40), "4:10: error: scenes and scene exclude ea");
    EXPECT_EQ(mistake(one + "of = \"energy\"\nframes = [1]\n").substr(0, 40),
              "5:10: error: frames has no meaning in a ");
    EXPECT_EQ(mistake(one + "layout = \"ring\"\n"),
              "4:10: error: layout must be one of \"row\", \"grid\" (given \"ring\")");
    EXPECT_EQ(mistake(one + "[defaults]\nname = \"x\"\n").substr(0, 34), "5:1: error: unknown key \"name\" in ");
    EXPECT_EQ(mistake(one + "tolerances = { level = 3 }\n").substr(0, 34), "4:16: error: unknown key \"level\" i");
    EXPECT_EQ(mistake(one + "[[case]]\nscene = \"b/A.toml\"\n"),
              "4:1: error: there is another case \"A\"; give each a name of its own");
}

TEST(GoldenSuite, AnOptionOfACaseHasThePlaceOfItsKey) {
    const GoldenSuite suite = suite_of(head + "[[case]]\nscene = \"a.toml\"\nplot_place = \"above\"\n");
    const auto place = [&](const std::string& text) {
        try {
            with_place_of(suite.cases[0], [&] { throw InputError(text); });
        } catch (const InputError& error) {
            return std::string(error.what());
        }
        return std::string();
    };
    EXPECT_EQ(place("--plot-place: is wrong"), "suites/golden.toml:4:14: error: plot_place: is wrong");
    EXPECT_EQ(place("--set x=1: is wrong"), "suites/golden.toml:2:1: error: set x=1: is wrong");
    EXPECT_EQ(place("no rate"), "suites/golden.toml:2:1: error: no rate");
}

TEST(GoldenSuite, ANewCaseLeavesTheRestOfTheFile) {
    const TestFolder folder;
    const std::filesystem::path file = folder.path() / "golden.toml";
    NewCase added;
    added.scene = "/scenes/a \"b\".toml";
    added.frames = {0, 30};
    added.overrides.set = {"body.x.mass=2"};
    added.overrides.width = 64;
    added.overrides.height = 48;
    const std::string first = suite_text_with(file, added);
    EXPECT_EQ(first,
              "format = 1\nreferences = \"references\"   # folder of the accepted images\n\n[[case]]\n"
              "scene = \"/scenes/a \\\"b\\\".toml\"\nframes = [0, 30]\nsize = [64, 48]\nset = [\"body.x.mass=2\"]\n");
}

}  // namespace
}  // namespace tumble::golden_suite_test
