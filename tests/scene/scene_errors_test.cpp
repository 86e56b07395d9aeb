// Every violation of the format is reported with its position. In the texts below an @ marks that position (it is
// removed before parsing), and the phrase follows the location in the message.
#include "core/error.h"
#include "scene/load.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include <vector>

namespace tumble::scene_errors_test {
namespace {

using namespace std::string_literals;

struct Mistake {
    std::string text;
    std::string phrase;
};

std::string error_of(const std::string& text) {
    try {
        parse_scene(text, "dir/scene.toml");
    } catch (const InputError& error) {
        return error.what();
    }
    return "no error";
}

void expect_errors(const std::vector<Mistake>& mistakes) {
    for (const Mistake& mistake : mistakes) {
        const std::size_t mark = mistake.text.find('@');
        ASSERT_NE(mark, std::string::npos) << mistake.text;
        const std::string before = mistake.text.substr(0, mark), after = mistake.text.substr(mark + 1);
        const auto line = 1 + std::count(before.begin(), before.end(), '\n');
        const std::size_t column = mark - (before.rfind('\n') == std::string::npos ? 0 : before.rfind('\n') + 1) + 1;
        const std::string expected =
            "dir/scene.toml:" + std::to_string(line) + ":" + std::to_string(column) + ": error: ";
        const std::string error = error_of(before + after);
        EXPECT_EQ(error.substr(0, expected.size()), expected) << mistake.text << "\n" << error;
        EXPECT_NE(error.find(mistake.phrase), std::string::npos) << mistake.text << "\n" << error;
    }
}

/// A scene with one body whose table contains these lines.
std::string body(const std::string& lines) {
    return "format = 1\n[materials.wood]\n[materials.steel]\n[[body]]\nshape = { type = \"box\", size = [1, 1, 1] }\n" +
           lines;
}
std::string shape(const std::string& inside) { return "format = 1\n[[body]]\ntype = \"fixed\"\nshape = " + inside; }

TEST(SceneErrors, OfTheTextItself) {
    expect_errors({
        {"format = 1\nx = @= 2", "value"},
        {"format = 1\n[simulation]\nduration = 1\nduration = @2", "redefine"},
        {"format = 1\ntitle = \"open@", "end-of-file"},
        {"format = 1\n[@?]", "expected bare key"},
        {"@", "format = 1"},
        {"@title = \"x\"", "format = 1"},
        {"format = @2", "format must be 1, the only one there is (given 2)"},
        {"format = @\"1\"", "format must be a whole number (given \"1\")"},
        {"format = @1.0", "format must be a whole number (given 1)"},
    });
}

std::string repeated(const std::string& text, int count) {
    std::string result;
    for (int i = 0; i < count; ++i) result += text;
    return result;
}

// Each part of a key is a table in the one before: three hundred thousand of them overflowed the stack.
TEST(SceneErrors, OfDepth) {
    const std::string phrase = "more than 16 parts";
    expect_errors({
        {"format = 1\n" + repeated("a.", 15) + "a@." + repeated("a.", 300'000) + "a = 1", phrase},
        {"format = 1\n[" + repeated("a.", 15) + "a@." + repeated("a.", 300'000) + "a]", phrase},
        {"format = 1\n[[" + repeated("\"a\" . ", 15) + "'b'@.a]]", phrase},
        {"# .................\ntitle = \"\"\"..................\n\"\"\"\nb = { " + repeated("a.", 15) + "a@.a = 1 }",
         phrase},
    });
    for (const std::string& open : {"["s, "{a=["s, "{a="s, "{"s + repeated("a.", 15) + "a="s})
        EXPECT_NE(error_of("format = 1\nx = " + repeated(open, 200'000)).find("error: "), std::string::npos) << open;
    const std::string key = repeated("a.", 15) + "a", end = repeated("}", 200);
    EXPECT_NE(error_of("format = 1\n" + key + " = " + repeated("{" + key + "=", 200) + "1" + end).find("unknown key"),
              std::string::npos)
        << "as deep as the parser goes";
}

TEST(SceneErrors, DotsInStringsAndCommentsAreNoDepth) {
    for (const std::string& title : {"\"....................\\\"....\""s, "'....................'"s,
                                     "\"\"\"\n.....\\\"\"\".....\n...........\"\"\""s,
                                     "'''\n..........'..........\n'''"s, "\"x\" # ...................."s})
        EXPECT_EQ(error_of("format = 1\ntitle = " + title + "\n"), "no error") << title;
}

TEST(SceneErrors, LongTextsAreCutAndControlsShown) {
    const std::string endless(1'000'000, 'k');
    expect_errors({
        {"format = 1\n@" + endless + " = 1", "kk... (1000000 bytes)\" in a scene"},
        {"format = @\"" + endless + "\"", "kk... (1000000 bytes)\")"},
        {"format = @[" + repeated("1, ", 100'000) + "1]", "1, ... (100001 items)])"},
        {"format = 1\n@\"a\\u001b[2J\\n\\u202e\" = 1", "unknown key \"a\\x1b[2J\\n\\u202e\""},
        {"format = 1\n[materials.\"" + endless + "\"]\n@b = 1", "bytes)"},
        {"format = 1\n[simulation]\nintegrator = @\"" + endless + "\"", "(given \"kkk"},
    });
    EXPECT_LT(error_of("format = 1\n[materials.\"" + endless + "\"]\nb = 1").size(), 1000u);
}

TEST(SceneErrors, UnknownKeysNameTheNearest) {
    expect_errors({
        {"format = 1\n@titel = \"x\"", "unknown key \"titel\" in a scene (did you mean \"title\"?)"},
        {"format = 1\n[simulation]\ngravity = [0, 0, 0]\n  @duratoin = 5",
         "unknown key \"duratoin\" in [simulation] (did you mean \"duration\"?)"},
        {"format = 1\n[output]\n@xyz = 5",
         "unknown key \"xyz\" in [output] (known: \"size\", \"fps\", \"samples\", \"exposure\", \"tone\")"},
        {"format = 1\n[camera]\n@fov = 5",
         "(known: \"eye\", \"target\", \"up\", \"vertical_fov\", \"dof\", \"keyframes\""},
        {"format = 1\n[light]\n@shadow = true", "did you mean \"shadows\""},
        {"format = 1\n[wind]\n@speed = 1", "unknown key \"speed\" in [wind]"},
        {"format = 1\n[contact]\n@friction = 1",
         "unknown key \"friction\" in [contact] (known: \"restitution_rule\", \"friction_rule\")"},
        {"format = 1\n[materials.wood]\n@colour = \"#ffffff\"",
         "unknown key \"colour\" in [materials.wood] (did you mean \"color\"?)"},
        {body("@velocty = [0, 0, 0]"), "unknown key \"velocty\" in [[body]] (did you mean \"velocity\"?)"},
        {shape("{ type = \"box\", size = [1, 1, 1], @radius = 1 }"), "unknown key \"radius\" in a box"},
        {shape("{ type = \"sphere\", radius = 1, @size = 1 }"), "unknown key \"size\" in a sphere"},
        {"format = 1\n[[@bodys]]", "did you mean \"body\""},
        {body("rotation = { axis = [0, 0, 1], @angel = 3 }"), "did you mean \"angle\""},
    });
}

TEST(SceneErrors, OfTheSimulation) {
    expect_errors({
        {"format = 1\n[simulation]\nduration = @-1", "duration must be from 0 to 1000000000 s (given -1)"},
        {"format = 1\n[simulation]\nduration = @9223372036854775807", "(given 9.223372036854776e+18)"},
        {"format = 1\n[simulation]\nduration = @nan", "duration must be a finite number (given nan)"},
        {"format = 1\n[simulation]\nduration = @inf", "duration must be a finite number (given inf)"},
        {"format = 1\n[simulation]\nduration = @\"5\"", "duration must be a number (given \"5\")"},
        {"format = 1\n[simulation]\nduration = @1e7", "too many frames"},
        {"format = 1\n[simulation]\nsteps_per_frame = @0", "steps_per_frame must be from 1 to 1000000 (given 0)"},
        {"format = 1\n[simulation]\nsteps_per_frame = @2.5", "steps_per_frame must be a whole number (given 2.5)"},
        {"format = 1\n[simulation]\nsteps_per_frame = @1000001", "(given 1000001)"},
        {"format = 1\n[simulation]\nstep = 0.01\nsteps_per_frame = @2", "exclude each other"},
        {"format = 1\n[simulation]\nstep = @0.0005",
         "the nearest that does is 0.000505050505050505 s (given a step of 0.0005 s)"},
        {"format = 1\n[simulation]\nstep = @1", "the nearest that does is 0.016666666666666666 s"},
        {"format = 1\n[simulation]\nstep = @0", "step must be above 0"},
        {"format = 1\n[simulation]\nstep = @1e-9", "more than 1000000 steps a frame"},
        {"format = 1\n[simulation]\ngravity = @[0, -9.81]", "gravity must be an array of 3 numbers (given [0, -9.81])"},
        {"format = 1\n[simulation]\ngravity = [0, @inf, 0]", "gravity must be a finite number"},
        {"format = 1\n[simulation]\ngravity = [0, @\"g\", 0]", "gravity must be a number (given \"g\")"},
        {"format = 1\n[simulation]\nintegrator = @\"verlet\"",
         "integrator must be one of \"symplectic-euler\", \"explicit-euler\", \"exact\", \"splitting\", "
         "\"rk4\" (given \"verlet\")"},
        {"format = 1\n[simulation]\nimpacts = @\"continuous\"",
         "impacts must be one of \"stepped\", \"exact\" (given \"continuous\")"},
        {"format = 1\n[simulation]\nimpact_law = @\"newton\"",
         "impact_law must be one of \"propagating\", \"simultaneous\" (given \"newton\")"},
        {"format = 1\n[simulation]\nrotation = @\"euler\"", "rotation must be one of \"quaternion\", \"matrix\""},
        {"format = 1\n[simulation]\nsleep = @1", "sleep must be true or false (given 1)"},
        {"format = 1\n[simulation]\nseed = @-1", "seed must be from 0"},
        {"format = 1\n[simulation]\nintegrator = @\"exat\"", "(given \"exat\") (did you mean \"exact\"?)"},
        {"format = 1\ntitle = @\"a\\u0000b\"", "title must have no zero byte (given \"a\\x00b\")"},
        {"format = 1\nsimulation = @3", "simulation must be a table (given 3)"},
        {"format = 1\nsimulation.duration = @1979-05-27", "duration must be a number (given a date or time)"},
    });
}

TEST(SceneErrors, OfThePicture) {
    expect_errors({
        {"format = 1\n[output]\nfps = @0", "fps must be from 1e-09 to 1000000 frames per second (given 0)"},
        {"format = 1\n[output]\nfps = @1000001", "(given 1000001)"},
        {"format = 1\n[output]\nfps = @\"24000/0\"",
         "fps must be a number of frames per second, or a fraction of two whole numbers from 1 to 1000000, as in "
         "\"24000/1001\" (given \"24000/0\")"},
        {"format = 1\n[output]\nfps = @\"60\"", "fps must be a number"},
        {"format = 1\n[output]\nfps = @[24000, 1001]", "fps must be a number (given [24000, 1001])"},
        {"format = 1\n[output]\nsamples = @3", "samples must be 1, 2 or 4 (given 3)"},
        {"format = 1\n[output]\nsamples = @8", "samples must be 1, 2 or 4 (given 8)"},
        {"format = 1\n[output]\nsize = [@0, 100]", "size must be from 1 to 16384 (given 0)"},
        {"format = 1\n[output]\nsize = [100, @99999]", "(given 99999)"},
        {"format = 1\n[output]\nsize = [@1.5, 100]", "whole number"},
        {"format = 1\n[output]\nsize = @[100]",
         "size must be an array of 2 whole numbers, width and height (given [100])"},
        {"format = 1\n[camera]\neye = @[1, 2, 3]\ntarget = [1, 2, 3]", "eye must not be at the target"},
        {"format = 1\n[camera]\neye = @[0, 9, 0]\ntarget = [0, 0, 0]", "looks along its up direction"},
        {"format = 1\n[camera]\neye = [0, 0, 9]\ntarget = [0, 0, 0]\nup = @[0, 0, 1]", "looks along its up direction"},
        {"format = 1\n[camera]\nup = @[0, 0, 0]", "up must not be zero (given [0, 0, 0])"},
        {"format = 1\n[camera]\nvertical_fov = @180", "vertical_fov must be from 1 to 170 degrees (given 180)"},
        {"format = 1\n[camera]\norbit = @1e7", "orbit must be from -1000000 to 1000000 degrees/s (given 10000000)"},
        {"format = 1\n[camera]\norbit = @\"fast\"", "orbit must be a number"},
        {"format = 1\n[camera]\ninterpolation = @\"linear\"", "is for a camera with keyframes"},
        {"format = 1\n[camera]\nfollow_time = @0.5", "is for a camera that follows a body"},
        {"format = 1\n[camera]\nkeyframes = @[]", "must hold at least one keyframe"},
        {"format = 1\n[camera]\nkeyframes = [{ time = 1 }, { time = @1 }]",
         "must come after the keyframe before, at 1 s"},
        {"format = 1\n[camera]\nkeyframes = [{ time = 0, @position = [0, 0, 0] }]", "unknown key \"position\""},
        {"format = 1\n[camera]\nkeyframes = [{ time = 0, eye = @[1, 1, 1], target = [1, 1, 1] }]",
         "must not be at the target"},
        {"format = 1\n[camera]\nkeyframes = [{ time = 0, eye = @[0, 9, 0], target = [0, 0, 0] }]",
         "looks along its up direction"},
        {"format = 1\n[camera]\nkeyframes = [{ time = 0, vertical_fov = @0 }]",
         "vertical_fov must be from 1 to 170 degrees"},
        {"format = 1\n[camera]\nfollow = @\"bal\"\n[[body]]\nname = \"ball\"\nshape = { type = \"sphere\", radius = 1 "
         "}",
         "\"bal\" is not the name of a body (did you mean \"ball\"?)"},
        {"format = 1\n[camera]\nfollow = @\"wall\"\n[[body]]\nname = \"wall\"\ntype = \"fixed\"\nshape = { type = "
         "\"sphere\", radius = 1 }",
         "must be a body that moves"},
        {"format = 1\n[camera]\neye = [@1e300, 0, 0]", "eye must be from -1000000000 to 1000000000 m (given 1e+300)"},
        {"format = 1\n[light]\ndirection = @[0, 0, 0]", "direction must not be zero"},
        {"format = 1\n[wind]\ndrag = @-1", "drag must be from 0 to 1000 (given -1)"},
        {"format = 1\n[contact]\nfriction_rule = @\"mean\"", "friction_rule must be"},
        {"format = 1\n[contact]\nrestitution_rule = @1", "restitution_rule must be"},
    });
}

TEST(SceneErrors, OfMaterials) {
    expect_errors({
        {"format = 1\n[materials.wood]\ndensity = @0", "density must be above 0"},
        {"format = 1\n[materials.wood]\nrestitution = @1.5", "restitution must be from 0 to 1 (given 1.5)"},
        {"format = 1\n[materials.wood]\nfriction = @-0.1", "friction must be from 0 to 1000000 (given -0.1)"},
        {"format = 1\n[materials.wood]\ncolor = @\"red\"", "color must be a color \"#rrggbb\" (given \"red\")"},
        {"format = 1\n[materials.wood]\ncolor = @[1, 0, 0]", "color must be a color"},
        {"format = 1\n[materials.wood]\npattern = @\"spots\"",
         "pattern must be one of \"plain\", \"panel\", \"grid\", \"checker\", \"stripes\", \"dots\", \"noise\", "
         "\"wood\", \"marble\""},
        {"format = 1\n[materials.wood]\npattern_scale = @0", "pattern_scale must be"},
        {"format = 1\n[materials.wood]\npattern_color = @\"red\"", "pattern_color must be a color"},
        {"format = 1\n[materials.wood]\ntexture = @\"\"", "texture must not be empty"},
        {"format = 1\n[materials.wood]\ntexture = @\"missing.png\"", "texture \"missing.png\" does not exist"},
        {"format = 1\n[materials.wood]\ntexture = @\".\"", "texture \".\" "},
        {"format = 1\n[materials.wood]\nnormal_map = @\"missing.png\"", "normal_map \"missing.png\" does not exist"},
        {"format = 1\n[materials.wood]\nroughness_map = @\"/dev/null\"", "roughness_map \"/dev/null\" "},
        {"format = 1\n[materials.wood]\nnormal_map = @\"" TUMBLE_SOURCE_DIR "/web/test/surfaces/gloss.png\"",
         "is gray: a normal map has directions as colors"},
        {"format = 1\n[materials.wood]\nopacity = @1.5", "opacity must be from 0 to 1 (given 1.5)"},
        {"format = 1\n[materials.wood]\nemission = @\"red\"", "emission must be a color"},
        {"format = 1\n[materials.wood]\ntexture_filter = @\"cubic\"",
         "texture_filter must be one of \"linear\", \"nearest\""},
        {"format = 1\n[materials.wood]\npattern = @\"wood\"\ntexture = \"wood.png\"",
         "pattern and texture exclude each other"},
        {body("texture = @\"missing.png\""), "texture \"missing.png\" does not exist"},
        {"format = 1\n[materials]\nwood = @3", "wood must be a table"},
        {body("material = @\"wod\""), "material \"wod\" is not among the materials (did you mean \"wood\"?)"},
        {body("material = @\"rubber\""), "material \"rubber\" is not among the materials (known: \"steel\", \"wood\")"},
        {body("material = @3"), "material must be a string (given 3)"},
    });
}

TEST(SceneErrors, OfLenses) {
    const std::string bodies = "\n[[body]]\nname = \"floor\"\nshape = { type = \"plane\" }\ntype = \"fixed\"\n";
    expect_errors({
        {"format = 1\n[camera]\ndof = @3", "dof must be a table (given 3)"},
        {"format = 1\n[camera]\ndof = @{ aperture = 0.1 }", "focus"},
        {"format = 1\n[camera]\ndof = { aperture = @0, focus = 1 }", "aperture must be above 0"},
        {"format = 1\n[camera]\ndof = { aperture = 0.5, focus = @0.4 }", "focus must be at least the aperture"},
        {"format = 1\n[camera]\ndof = { aperture = 0.5, focus = 1, samples = @3 }", "samples must be from 4 to 256"},
        {"format = 1\n[camera]\ndof = { aperture = 0.5, focus = 1, @blades = 6 }", "unknown key \"blades\""},
        {"format = 1\n[camera]\ndof = { aperture = 0.5, focus = @\"flor\" }" + bodies, "did you mean \"floor\"?"},
        {"format = 1\n[camera]\ndof = { aperture = 0.5, focus = @\"floor\" }" + bodies, "focus must not be a plane"},
    });
}

TEST(SceneErrors, OfLights) {
    expect_errors({
        {"format = 1\n[[light]]\ntype = @\"lamp\"", "type must be one of \"sun\", \"point\", \"spot\""},
        {"format = 1\n@[[light]]\ntype = \"point\"", "position"},
        {"format = 1\n[[light]]\nposition = @[0, 1, 0]", "position has no effect on a sun light"},
        {"format = 1\n[[light]]\nangle = @30", "angle has no effect on a sun light"},
        {"format = 1\n[[light]]\nintensity = @-1", "intensity must be from 0 to 1000000 (given -1)"},
        {"format = 1\n[[light]]\ntype = \"point\"\nposition = [0, 1, 0]\nshadows = @true",
         "shadows is for suns and spots: the shadows of a point light would take six maps"},
        {"format = 1\n[[light]]\nshadows = true\n[[light]]\nshadows = true\n[[light]]\nshadows = @true",
         "shadows is on for two lights already: each shadow map costs 6 ms"},
        {"format = 1\n[[light]]\n[[light]]\n[[light]]\n[[light]]\n@[[light]]", "a scene has 4 lights at most"},
        {"format = 1\n[light]\n@intensity = 2", "unknown key \"intensity\""},
    });
}

TEST(SceneErrors, OfShapes) {
    expect_errors({
        {"format = 1\n@[[body]]\nname = \"a\"\n[[body]]\nname = \"b\"", "[[body]] needs \"shape\" (not given)"},
        {shape("@{ size = [1, 1, 1] }"), "a shape needs \"type\" (not given)"},
        {shape("{ type = @\"cube\", size = [1, 1, 1] }"),
         "type must be one of \"plane\", \"box\", \"sphere\", \"capsule\", \"cylinder\", \"cone\", \"ellipsoid\", "
         "\"mesh\", "
         "\"compound\", \"hull\", \"heightfield\" (given \"cube\")"},
        {shape("{ type = \"box\", size = [1, @0, 1] }"), "size must be from 1e-09 to 1000000000 m (given 0)"},
        {shape("{ type = \"box\", size = [1, 1, @nan] }"), "size must be a finite number (given nan)"},
        {shape("{ type = \"box\", size = [1, 1, @2e9] }"), "size must be"},
        {shape("{ type = \"box\", size = @1 }"), "size must be an array of 3 numbers (given 1)"},
        {shape("@{ type = \"sphere\" }"), "a sphere needs \"radius\" (not given)"},
        {shape("{ type = \"sphere\", radius = @-1 }"), "radius must be"},
        {shape("{ type = \"plane\", normal = @[0, 0, 0] }"), "normal must not be zero"},
        {shape("@\"box\""), "shape must be a table (given \"box\")"},
        {"format = 1\n[[body]]\nshape = { type = @\"plane\" }", "cannot move freely"},
        {shape("{ type = \"hull\", points = @[[0, 0, 0], [1, 0, 0], [0, 1, 0]] }"),
         "points must be 4 points at least "
         "(given 3)"},
        {shape("{ type = \"hull\", points = @[[0, 0, 0], [1, 0, 0], [0, 1, 0], [1, 1, 0]] }"),
         "points must not lie in one plane"},
        {shape("{ type = \"hull\", points = [[0, 0, 0], [1, @1e10, 0], [0, 1, 0], [1, 1, 0]] }"),
         "points must be from"},
        {shape("{ type = \"heightfield\", file = @\"none.png\", size = [1, 1], height = 1 }"),
         "file \"none.png\" does not exist (looked at dir/none.png)"},
        {shape("@{ type = \"heightfield\", file = \"x.png\", size = [1, 1] }"), "a heightfield needs \"height\""},
        {shape("{ type = \"heightfield\", file = \"x.png\", size = @[1, 1, 1], height = 1 }"),
         "size must be an array of 2 numbers, along x and along z"},
        {shape("{ type = \"compound\", parts = [{ shape = { type = @\"heightfield\" } }] }"),
         "cannot be part of a body, whose parts collide as convex shapes"},
        {shape("{ type = \"compound\", parts = @[{ shape = { type = \"sphere\", radius = 1 }, collide = false }] }"),
         "parts must hold a part that collides"},
        {"format = 1\n[[body]]\nshape = { type = @\"heightfield\" }", "is ground and cannot move"},
        {"format = 1\n@[body]\nx = 1", "body must be an array of tables; write [[body]] for each (given a table)"},
        {"format = 1\nbody = [@3]", "body must be a table (given 3)"},
    });
}

TEST(SceneErrors, OfBodies) {
    expect_errors({
        {body("type = @\"static\""), "type must be one of \"dynamic\", \"fixed\", \"kinematic\" (given \"static\")"},
        {body("mass = @0"), "mass must be above 0"},
        {body("mass = 1\ndensity = @1"), "density and mass exclude each other"},
        {body("name = @\"\""), "name must not be empty"},
        {body("name = \"a\"\n[[body]]\nname = @\"a\"\nshape = { type = \"sphere\", radius = 1 }"),
         "name must be unique, and another body has it (given \"a\")"},
        {body("position = [0, @1e10, 0]"), "position must be"},
        {body("rotation = @[1, 0.1, 0, 0]"), "rotation must be a quaternion of length 1 (given one of length 1.00499)"},
        {body("rotation = @[0, 0, 0, 0]"), "(given one of length 0)"},
        {body("rotation = @[1, 0, 0]"), "rotation must be an array of 4 numbers w, x, y, z"},
        {body("rotation = [1, 0, 0, @nan]"), "finite"},
        {body("rotation = { axis = @[0, 0, 0], angle = 3 }"), "axis must not be zero"},
        {body("rotation = @{ axis = [0, 0, 1] }"), "a rotation needs \"angle\""},
        {body("rotation = { axis = [0, 0, 1], angle = @inf }"), "angle must be a finite number"},
        {body("type = \"fixed\"\nvelocity = @[1, 0, 0]"), "velocity must be zero for a fixed body (given [1, 0, 0])"},
        {body("type = \"kinematic\"\nangular_velocity = @[1, 0, 0]"), "give it keyframes"},
        {body("visible = @\"yes\""), "visible must be true or false"},
        {body("gravity_scale = @1e7"), "gravity_scale must be from -1000000 to 1000000 (given 10000000)"},
        {body("rolling_friction = @-1"), "rolling_friction must be from 0 to 1000 (given -1)"},
        {body("type = \"fixed\"\ncenter_of_mass = @[0, 0, 0]"), "center_of_mass is for dynamic bodies"},
        {body("inertia = @[1, 1, 1]"), "inertia must be an array of 6 numbers xx, yy, zz, xy, xz, yz"},
        {body("inertia = [1, @-1, 1, 0, 0, 0]"), "inertia must be above 0 and at most 1e+30 kg m^2 (given -1)"},
        {body("inertia = @[1, 1, 1, 2, 0, 0]"),
         "inertia must be positive about every axis (given the moments -1, 1 and 3"},
        {body("inertia = @{ principal = [1, 2, 4] }"),
         "inertia breaks the triangle inequality, and no body has it: the largest moment is at most the sum of the "
         "other "
         "two, here 3 (given the moments 1, 2 and 4 kg m^2"},
        {body("layers = [@3]"), "layers must be a string (given 3)"},
        {body("layers = [\"floor\"]\ncollide_with = [@\"flor\"]"),
         "collide_with \"flor\" is the layer of no body (did you mean \"floor\"?)"},
        {body("collide_with = [@\"floor\"]"), "is the layer of no body: give a body layers = [...]"},
    });
}

TEST(SceneErrors, OfKeyframes) {
    expect_errors({
        {body("keyframes = @[{ time = 0 }]"), "keyframes is for bodies of type \"kinematic\""},
        {body("interpolation = @\"linear\""), "interpolation is for bodies of type \"kinematic\""},
        {body("type = \"kinematic\"\nkeyframes = @[]"), "at least one keyframe"},
        {body("type = \"kinematic\"\nkeyframes = [@{ position = [0, 0, 0] }]"), "a keyframe needs \"time\""},
        {body("type = \"kinematic\"\nkeyframes = [{ time = 1 }, { time = @1 }]"),
         "time must come after the keyframe before, at 1 s (given 1)"},
        {body("type = \"kinematic\"\nkeyframes = [{ time = @-1 }]"), "time must be from 0"},
        {body("type = \"kinematic\"\nkeyframes = [{ time = 0, @pos = 1 }]"), "unknown key \"pos\" in a keyframe"},
        {body("type = \"kinematic\"\ninterpolation = @\"cubic\""), "\"smooth\", \"linear\""},
        {body("type = \"kinematic\"\nkeyframes = [{ time = 0, rotation = @[2, 0, 0, 0] }]"), "length 2"},
    });
}

TEST(SceneErrors, OfCopies) {
    expect_errors({
        {body("scale = @[1, 2]"), "scale needs a grid or a scatter"},
        {body("colors = @[\"#ffffff\"]"), "colors needs a grid or a scatter"},
        {body("grid = @{ count = [1, 1, 1] }"), "a grid needs \"spacing\""},
        {body("grid = @{ spacing = 1 }"), "a grid needs \"count\""},
        {body("grid = { count = [@0, 1, 1], spacing = 1 }"), "count must be from 1 to 1000000 (given 0)"},
        {body("grid = { count = @[1000, 1000, 2], spacing = 1 }"), "makes more than 1000000 bodies"},
        {body("grid = { count = [1, 1, 1], spacing = @0 }"), "spacing must be"},
        {body("grid = { count = [1, 1, 1], spacing = 1, jitter = [0, @-1, 0] }"), "jitter must be"},
        {body("grid = { count = [1, 1, 1], spacing = 1, tilt = @181 }"), "tilt must be from 0 to 180 degrees"},
        {body("grid = { count = [1, 1, 1], spacing = 1 }\nscatter = @{ count = 1, size = [1, 1, 1] }"),
         "exclude each other"},
        {body("type = \"kinematic\"\ngrid = @{ count = [1, 1, 1], spacing = 1 }"), "for dynamic and fixed bodies"},
        {shape("{ type = \"plane\" }\ngrid = @{ count = [1, 1, 1], spacing = 1 }"), "endless"},
        {body("scatter = { count = 2, size = [1, 1, 1], rotation = @\"some\" }"), "\"random\", \"none\""},
        {body("scatter = @{ count = 100, size = [2, 2, 2] }"), "copies found a place without touching another"},
        {body("grid = { count = [1, 1, 1], spacing = 1 }\nscale = @[2, 1]"), "smaller factor first"},
        {body("grid = { count = [1, 1, 1], spacing = 1 }\nscale = @2"), "scale must be an array of 2 numbers"},
        {body("grid = { count = [1, 1, 1], spacing = 1 }\ncolors = @[]"), "at least one color"},
        {body("grid = { count = [1, 1, 1], spacing = 1 }\ncolors = [\"#ffffff\", @\"blue\"]"), "(given \"blue\")"},
        {body("grid = { count = [1, 1, 1], spacing = 1 }\nname = \"a\"\n[[body]]\nname = @\"a.0\"\nshape = { type = "
              "\"sphere\", radius = 1 }"),
         "(given \"a.0\")"},
        {body("[[body]]\nshape = { type = \"box\", size = [1, 1, 1] }\ngrid = @{ count = [1000, 1000, 1], spacing = 1 "
              "}"),
         "too many bodies"},
    });
}

TEST(SceneErrors, OfFieldsAndPairForces) {
    const std::string two =
        "name = \"a\"\n[[body]]\nname = \"b\"\nshape = { type = \"sphere\", radius = 1 }\n"
        "position = [9, 0, 0]\n[[body]]\nname = \"floor\"\ntype = \"fixed\"\n"
        "shape = { type = \"plane\" }\n";
    const auto pair = [&](const std::string& keys) { return body(two + "[[pair_force]]\n" + keys); };
    const auto field = [&](const std::string& keys) { return body("[[field]]\n" + keys); };
    expect_errors({
        {field("type = @\"magnet\""), "\"uniform\", \"point\""},
        {body("@[[field]]\ntype = \"uniform\""), "[[field]] needs \"acceleration\""},
        {field("type = \"point\"\nstrength = 1\nlinear = @1"), "is a key of another type than \"point\""},
        {field("type = @\"drag\""), "needs linear or quadratic"},
        {field("type = \"point\"\nstrength = 1\nregion = { box = @[1, 1, 1], sphere = 1 }"), "exclude each other"},
        {field("type = \"point\"\nstrength = 1\nenabled = @[2, 1]"), "must end after it starts"},
        {pair("type = \"gravity\"\nbodies = [\"a\", @\"c\"]"), "is not the name of a body"},
        {pair("type = \"gravity\"\nbodies = [\"a\", @\"a\"]"), "names 'a' again"},
        {pair("type = \"gravity\"\nbodies = [\"a\", @\"floor\"]"), "must be a dynamic body: others have no mass"},
        {pair("type = \"1/r^2\"\nstrength = 1\nbodies = [\"a\", @\"floor\"]"), "must have a center"},
        {pair("type = \"gravity\"\nbodies = @[\"a\"]"), "must name two bodies or more"},
        {pair("type = \"coulomb\"\nbodies = [\"a\", \"b\"]\ncharges = @[1]"), "one charge for each of the 2 entries"},
        {pair("type = \"dipole\"\nbodies = [\"a\", \"b\"]\nmoments = @[[1, 0, 0]]"),
         "must have one moment for each of the 2 entries of bodies, not 1"},
        {pair("type = \"dipole\"\nbodies = [\"a\", \"b\"]\nmoments = @[[0, 0, 0], [0, 0, 0]]"), "must not all be zero"},
        {body(two + "@[[pair_force]]\ntype = \"dipole\"\nbodies = [\"a\", \"b\"]"), "needs \"moments\""},
        {pair("type = \"gravity\"\nbodies = [\"a\", \"b\"]\nmoments = @[[1, 0, 0], [1, 0, 0]]"),
         "is a key of another type than \"gravity\""},
        {body(two + "@[[pair_force]]\ntype = \"spring\"\nbodies = [\"a\", \"b\"]"), "needs \"stiffness\""},
        {pair("type = \"spring\"\nbodies = [\"a\", \"b\"]\nstiffness = 1\nstrength = @1"),
         "is a key of another type than \"spring\""},
    });
}

TEST(SceneErrors, OfExplosions) {
    const auto blast = [&](const std::string& keys) { return body("@[[explosion]]\n" + keys); };
    expect_errors({
        {blast("impulse = 1"), "[[explosion]] needs \"center\""},
        {blast("center = [0, 1, 0]"), "[[explosion]] needs \"impulse\""},
        {body("[[explosion]]\ncenter = [0, 1, 0]\nimpulse = 1\ntime = @-1"), "time must be from 0 to"},
        {body("[[explosion]]\ncenter = [0, 1, 0]\nimpulse = 1\nradius = @0"), "radius must be"},
        {body("[[explosion]]\ncenter = [0, 1, 0]\nimpulse = 1\n@radiu = 2"), "did you mean"},
    });
}

TEST(SceneErrors, OfWater) {
    const auto with = [](const std::string& keys) { return "format = 1\n" + keys; };
    expect_errors({
        {with("[water]\ndensity = @-1"), "density must be above 0"},
        {with("[water]\n@depth = 1"), "unknown key \"depth\" in [water]"},
        {with("[water]\ncurrent = @[1, 1, 0]"), "current must be horizontal"},
        {with("[water]\nwaves = [{ height = @1, length = 4 }]"), "height makes a wave that breaks"},
        {with("[water]\nwaves = [{ height = 0.3, length = 3 }, { height = @0.3, length = 3 }]"), "(given 0.2)"},
        {with("[water]\nwaves = [{ height = 0.1, length = 3, direction = @[0, 1, 0] }]"), "must be horizontal"},
        {with("[water]\nwaves = [@{ height = 0.1 }]"), "needs \"length\""},
        {with("[simulation]\ngravity = [0, 0, 0]\n[water]\nwaves = @[{ height = 0.1, length = 3 }]"), "need gravity"},
        {with("@[water]\n[simulation]\ngravity = [1, -9, 0]"), "water needs gravity along -y"},
        {with("@[water]\n[simulation]\nmethod = \"notes\""), "unknown to the method of the notes"},
        {body("water_drag = @-1"), "water_drag must be from 0 to"},
    });
}

TEST(SceneErrors, OfFracture) {
    const std::string hard = "strength = 1e6\n", slabs = ", pattern = \"slabs\"";
    const auto in_body = [&](const std::string& keys) { return body(hard + "fracture = { " + keys + " }"); };
    const auto of_shape = [&](const std::string& keys) {
        return "format = 1\n[[body]]\nstrength = 1e6\nfracture = @{ cells = 8 }\nshape = { " + keys + " }\n";
    };
    expect_errors({
        {body("fracture = @{}"), "needs a strength, in Pa"},
        {in_body("cells = @1"), "must be from 2 to 4096"},
        {in_body("cells = @5000"), "must be from 2 to 4096"},
        {in_body("@cell = 8"), "did you mean"},
        {in_body("pattern = @\"slab\""), "did you mean"},
        {in_body("axis = @[1, 0, 0]"), "is for pattern = \"slabs\""},
        {in_body("cells = 8" + slabs + ", focus = @[1, 0, 0]"), "\"radial\" or \"voronoi\""},
        {in_body("cells = 8, focus = @\"ball\""), "must be a point or \"impact\" (given \"ball\")"},
        {in_body("cells = 8, focus = @2"), "focus must be an array of 3 numbers"},
        {in_body("held = @[\"-y\"]"), "nothing holds a dynamic one"},
        {body("type = \"fixed\"\n" + hard + "fracture = { held = [@\"y\"] }"), "must be one of"},
        {body("type = \"fixed\"\n" + hard + "fracture = { held = @[] }"), "at least one side"},
        {body(hard + "fracture = @{ smallest = 1e-7 }"), "at least 1e-06 of the longest extent"},
        {body(hard + "fracture = @{ smallest = 2 }"), "leaves one cell"},
        {body(hard + "center_of_mass = [0, 0.1, 0]\nfracture = @{}"), "neither center_of_mass nor inertia"},
        {body("strength = @0"), "must be above 0"},
        {body("toughness = @-1"), "must be from 0 to"},
        {of_shape("type = \"plane\"") + "type = \"fixed\"", "endless"},
        {of_shape("type = \"compound\", parts = [{ shape = { type = \"sphere\", radius = 1 } }, { shape = { type = "
                  "\"sphere\", radius = 1 }, position = [1, 0, 0] }]"),
         "two parts of the compound overlap"},
        {of_shape(
             "type = \"compound\", parts = [{ shape = { type = \"sphere\", radius = 1 }, collide = false }, { shape = "
             "{ type = \"sphere\", radius = 1 }, position = [3, 0, 0] }]"),
         "a part of the compound does not"},
        {of_shape("type = \"compound\", parts = [{ shape = { type = \"sphere\", radius = 1 } }, { shape = { type = "
                  "\"sphere\", radius = 1 }, position = [3, 0, 0] }]"),
         "needs a body of one piece"},
        {of_shape("type = \"sphere\", radius = 1") + "type = \"fixed\"", "no face in the held sides"},
        {in_body("cells = 8") + "\nname = \"pane\"\n[[force]]\nbody = @\"pane/1\"\nforce = [1, 0, 0]", "is a piece"},
        {body(hard + "fracture = @{ cells = 8 }\nname = \"pane\"\n[[body]]\nname = \"pane/1\"\nshape = { type = "
                     "\"sphere\", radius = 1 }"),
         "a body has this name"},
    });
}

TEST(SceneErrors, OfForcesAndCords) {
    expect_errors({
        {body("name = \"crate\"\n[[force]]\nbody = @\"crat\"\nforce = [1, 0, 0]"),
         "body \"crat\" is not the name of a body (did you mean \"crate\"?)"},
        {body("name = \"crate\"\ngrid = { count = [2, 1, 1], spacing = 2 }\n[[force]]\nbody = @\"crate\"\nforce = [1, "
              "0, 0]"),
         "\"crate.0\" for the first"},
        {body("name = \"a\"\ntype = \"fixed\"\n[[force]]\nbody = @\"a\"\nforce = [1, 0, 0]"), "must be a dynamic body"},
        {body("name = \"a\"\n@[[force]]\nbody = \"a\""), "[[force]] needs \"force\""},
        {body("name = \"a\"\n@[[force]]\nforce = [1, 0, 0]"), "[[force]] needs \"body\""},
        {body("name = \"a\"\n[[force]]\nbody = \"a\"\nforce = [1, 0, 0]\nstart = 2\nend = @2"),
         "makes the force end before it starts, at 2 s (given 2)"},
        {body("name = \"a\"\n[[force]]\nbody = \"a\"\nforce = [1, 0, 0]\nframe = @\"local\""), "\"world\", \"body\""},
        {body("name = \"a\"\n@[[cord]]\nbody = \"a\""), "[[cord]] needs \"anchor\""},
        {body("name = \"a\"\n[[cord]]\nbody = \"a\"\nanchor = [0, 0, 0]\nradius = @0"), "radius must be"},
    });
}

TEST(SceneErrors, ShowTheGivenTextInReadableLength) {
    const std::string error =
        error_of("format = 1\n[simulation]\nintegrator = 3\ngravity = \"" + std::string(500, 'x') + "\\n\"");
    EXPECT_LT(error.size(), 200u);
    EXPECT_EQ(error.find('\n'), std::string::npos);
    EXPECT_EQ(error_of("format = 1\nx = fa\n").find('\n'), std::string::npos);  // toml++ quotes the line's end
}

TEST(SceneErrors, OfTheFile) {
    EXPECT_THROW(load_scene("no/such/scene.toml"), InputError);
    try {
        load_scene("no/such/scene.toml");
    } catch (const InputError& error) {
        EXPECT_STREQ(error.what(), "no/such/scene.toml: error: the scene cannot be read: No such file or directory");
    }
    try {
        load_scene("/");
        ADD_FAILURE();
    } catch (const InputError& error) {
        EXPECT_STREQ(error.what(), "/: error: the scene is a folder, not a file");
    }
}

}  // namespace
}  // namespace tumble::scene_errors_test
