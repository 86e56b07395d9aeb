// The hash of scenes with fields and forces between bodies.
#include "scene/hash/scene_hash.h"
#include "scene/load.h"

#include <gtest/gtest.h>

#include <set>
#include <string>

namespace tumble::field_hash_test {
namespace {

std::string hash_of(const std::string& text) { return scene_hash(parse_scene(text, "fields.toml")); }

TEST(SceneHash, EveryKeyOfFieldsPairForcesAndExplosionsChangesIt) {
    const std::string bodies =
        "format = 1\n[[body]]\nname = \"a\"\nshape = { type = \"sphere\", radius = 0.1 }\n[[body]]\nname = \"b\"\n"
        "shape = { type = \"sphere\", radius = 0.1 }\nposition = [3, 0, 0]\n[[body]]\nname = \"c\"\n"
        "shape = { type = \"sphere\", radius = 0.1 }\nposition = [0, 3, 0]\n";
    const std::string point = "type = \"point\"\nstrength = 2\n", vortex = "type = \"vortex\"\nstrength = 2\n",
                      drag = "type = \"drag\"\nlinear = 1\nquadratic = 1\n", pair = "bodies = [\"a\", \"b\"]\n",
                      charged = "type = \"coulomb\"\n" + pair, spring = "type = \"spring\"\n" + pair,
                      magnets = "type = \"dipole\"\n" + pair, blast = "center = [0, 1, 0]\nimpulse = 1\n";
    struct Pair {
        std::string table, one, other;
    };
    std::set<std::string> seen{hash_of(bodies)};
    for (const auto& [table, one, other] :
         {Pair{"field", "type = \"uniform\"\nacceleration = [1, 0, 0]", "type = \"uniform\"\nacceleration = [2, 0, 0]"},
          {"field", point, point + "center = [1, 0, 0]"},
          {"field", "type = \"point\"\nstrength = 3", point + "softening = 0.1"},
          {"field", vortex, vortex + "axis = [1, 0, 0]"},
          {"field", drag, drag + "velocity = [1, 0, 0]"},
          {"field", "type = \"drag\"\nlinear = 1", "type = \"drag\"\nquadratic = 1"},
          {"field", point + "region = { box = [1, 1, 1] }", point + "region = { box = [1, 1, 2] }"},
          {"field", point + "region = { sphere = 1 }", point + "region = { sphere = 1, center = [1, 0, 0] }"},
          {"field", point + "enabled = [1]", point + "enabled = [1, 2]"},
          {"pair_force", "type = \"gravity\"\n" + pair, "type = \"gravity\"\nbodies = [\"a\", \"c\"]"},
          {"pair_force", "type = \"1/r^2\"\nstrength = 1\n" + pair, "type = \"1/r^2\"\nstrength = 2\n" + pair},
          {"pair_force", charged + "charges = [1, 2]", charged + "charges = [1, 3]"},
          {"pair_force", charged + "charges = [2, 2]", charged + "charges = [2, 2]\nsoftening = 0.1"},
          {"pair_force", spring + "stiffness = 1", spring + "stiffness = 2"},
          {"pair_force", spring + "stiffness = 1\ndamping = 1", spring + "stiffness = 1\nlength = 1"},
          {"pair_force", spring + "stiffness = 1\nenabled = [1]", spring + "stiffness = 1\nenabled = [1, 2]"},
          {"pair_force", magnets + "moments = [[1, 0, 0], [0, 0, 1]]", magnets + "moments = [[1, 0, 0], [0, 1, 0]]"},
          {"explosion", blast, blast + "time = 1"},
          {"explosion", "center = [0, 2, 0]\nimpulse = 1", "center = [0, 1, 0]\nimpulse = 2"},
          {"explosion", blast + "radius = 3", blast + "radius = 4"}})
        for (const std::string& keys : {one, other})
            EXPECT_TRUE(seen.insert(hash_of(bodies + "[[" + table + "]]\n" + keys + "\n")).second) << keys;
}

TEST(SceneHash, EveryKeyOfWaterChangesIt) {
    const std::string ball = "format = 1\n[[body]]\nshape = { type = \"sphere\", radius = 0.1 }\n[water]\n",
                      wave = "waves = [{ height = 0.2, length = 4";
    std::set<std::string> seen{hash_of(ball)};
    for (const std::string& keys :
         {std::string("level = 1"), std::string("density = 1025"), std::string("drag = 2"),
          std::string("viscosity = 0.1"), std::string("added_mass = false"), std::string("current = [1, 0, 0]"),
          std::string("color = \"#102030\""), std::string("visible_in_aov = false"), wave + " }]",
          wave + ", direction = [0, 0, 1] }]", wave + ", phase = 90 }]",
          std::string("waves = [{ height = 0.2, length = 5 }]"), std::string("waves = [{ height = 0.1, length = 4 }]")})
        EXPECT_TRUE(seen.insert(hash_of(ball + keys + "\n")).second) << keys;
    for (const char* keys : {"color = \"#102030\"\n", "visible_in_aov = false\n"})
        EXPECT_EQ(motion_hash(parse_scene(ball + keys, "water.toml")), motion_hash(parse_scene(ball, "water.toml")));
}

}  // namespace
}  // namespace tumble::field_hash_test
