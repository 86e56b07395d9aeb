// [[chain]]: closure, places of the links at rest, joints of the ends, and every refusal.
#include "core/deterministic_math.h"
#include "core/error.h"
#include "scene/load.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

namespace tumble::chains_test {
namespace {

const std::string head = R"(format = 1
[[body]]
name = "ball"
shape = { type = "sphere", radius = 0.5 }
[[body]]
name = "wall"
type = "fixed"
shape = { type = "box", size = [1, 1, 1] }
)";

std::string chain(const std::string& lines) {
    return head + "[[chain]]\nname = \"rope\"\nshape = { type = \"box\", size = [0.1, 0.02, 0.02] }\n" + lines;
}

SceneDescription scene_of(const std::string& lines) { return parse_scene(chain(lines), "dir/scene.toml"); }

/// Largest distance of the anchors of both sides of a joint at the start, m.
double largest_gap(const SceneDescription& scene) {
    double gap = 0.0;
    for (const JointDescription& joint : scene.joints) {
        const auto anchor = [&](const std::optional<std::size_t>& body, const Vec3& p) {
            return body ? Vec3(scene.bodies[*body].position + scene.bodies[*body].rotation * p) : p;
        };
        gap =
            std::max(gap, (anchor(joint.first, joint.anchor_first) - anchor(joint.second, joint.anchor_second)).norm());
    }
    return gap;
}

/// Half lengths of the links, from the anchors of their joints.
std::vector<double> link_lengths(const SceneDescription& scene, std::size_t first) {
    std::vector<double> lengths;
    for (std::size_t i = first; i + 1 < scene.bodies.size(); ++i) {
        lengths.push_back((scene.bodies[i + 1].position - scene.bodies[i].position).norm());
    }
    return lengths;
}

TEST(Chains, AreStraightWithoutSag) {
    const SceneDescription scene =
        scene_of("links = 4\nfrom = [1, 2, 3]\nto = [1, 2, -5]\nends = [\"world\", \"ball\"]\n");
    ASSERT_EQ(scene.bodies.size(), 6u);
    ASSERT_EQ(scene.joints.size(), 5u);
    EXPECT_LE(largest_gap(scene), 1e-14);
    for (std::size_t i = 0; i < 4; ++i) {
        const BodyDescription& link = scene.bodies[2 + i];
        EXPECT_EQ(link.name, "rope." + std::to_string(i));
        EXPECT_LE((link.position - Vec3(1, 2, 2 - 2.0 * double(i))).norm(), 1e-14);
        EXPECT_LE((link.rotation * Vec3::UnitX() + Vec3::UnitZ()).norm(), 1e-14);
        EXPECT_LE((link.rotation * Vec3::UnitY() - Vec3::UnitY()).norm(), 1e-14);
        EXPECT_EQ(scene.joints[i].name, "rope." + std::to_string(i));
        EXPECT_EQ(scene.joints[i].type, JointType::ball);
    }
    EXPECT_EQ(scene.joints[0].first, std::nullopt);
    EXPECT_EQ(scene.joints[0].second, 2u);
    EXPECT_EQ(scene.joints[4].first, 5u);
    EXPECT_EQ(scene.joints[4].second, 0u);
    EXPECT_EQ(scene_of("links = 4\nfrom = [1, 2, 3]\nto = [1, 2, -5]").joints.size(), 3u) << "both ends are free";
}

TEST(Chains, HaveEveryKeyOfAMaterial) {
    const SceneDescription scene = scene_of(
        "links = 2\nfrom = [0, 0, 0]\nto = [1, 0, 0]\nrolling_friction = 0.1\nspinning_friction = 0.2\n"
        "sound = \"metal\"\nemission = \"#102030\"\n");
    const BodyDescription& link = scene.bodies[3];
    EXPECT_EQ(link.rolling_friction, 0.1);
    EXPECT_EQ(link.spinning_friction, 0.2);
    EXPECT_EQ(link.sound, SoundMaterial::metal);
    EXPECT_EQ(link.appearance.emission, (Color{0x10, 0x20, 0x30}));
}

// Equal links hang so that the tangents of their slopes grow evenly: the vertical force on a link's end differs from
// that on the other by its weight, and the horizontal one is the same all along.
TEST(Chains, HangAtRest) {
    for (const std::string to : {"[3, 2, 0]", "[2, 3.5, 1]", "[-1.5, -1, 2]"})
        for (const std::string slack : {"length = 5", "length = 9", "sag = 0.01", "sag = 0.75", "sag = 2"})
            for (const int links : {2, 7, 20}) {
                if (links == 2 && to != "[3, 2, 0]") continue;  // a triangle, which its ends may tip over
                SCOPED_TRACE(to + " " + slack + " " + std::to_string(links));
                const SceneDescription scene =
                    scene_of("links = " + std::to_string(links) + "\nfrom = [0, 2, 0]\nto = " + to +
                             "\nends = [\"world\", \"wall\"]\n" + slack);
                EXPECT_LE(largest_gap(scene), 1e-12);
                std::vector<double> slopes, lengths;
                Vec3 lowest = Vec3::Constant(infinity), end = Vec3::Zero();
                for (std::size_t i = 0; i < std::size_t(links); ++i) {
                    const BodyDescription& link = scene.bodies[2 + i];
                    const Vec3 x = link.rotation * Vec3::UnitX();
                    slopes.push_back(x.y() / std::sqrt(x.x() * x.x() + x.z() * x.z()));
                    lengths.push_back((scene.joints[i + 1].anchor_first - scene.joints[i].anchor_second).norm());
                    end = link.position + link.rotation * scene.joints[i + 1].anchor_first;
                    lowest = lowest.cwiseMin(end);
                }
                for (std::size_t i = 2; i < slopes.size(); ++i)
                    EXPECT_NEAR(slopes[i] - slopes[i - 1], slopes[1] - slopes[0], 1e-8 * (1.0 + std::fabs(slopes[0])));
                for (const double length : lengths) EXPECT_NEAR(length, lengths[0], 1e-11);
                if (slack.starts_with("length")) {
                    EXPECT_NEAR(lengths[0] * links, std::stod(slack.substr(9)), 1e-10);
                }
                if (slack.starts_with("sag") && to == "[3, 2, 0]" && links % 2 == 0) {
                    EXPECT_NEAR(2.0 - lowest.y(), std::stod(slack.substr(6)), 1e-10);
                }
            }
}

TEST(Chains, CloseToALoop) {
    const SceneDescription scene =
        scene_of("links = 12\nfrom = [-1, 0, 0]\nto = [1, 0, 0]\nloop = true\nnormal = [0, 1, 0]\njoint = \"hinge\"");
    ASSERT_EQ(scene.joints.size(), 12u);
    EXPECT_LE(largest_gap(scene), 1e-14);
    EXPECT_EQ(scene.joints[0].first, 13u);
    EXPECT_EQ(scene.joints[0].second, 2u);
    for (const double length : link_lengths(scene, 2))
        EXPECT_NEAR(length, 2.0 * std::cos(pi / 12) * std::sin(pi / 12), 1e-14);
    for (const JointDescription& joint : scene.joints) {
        EXPECT_EQ(joint.type, JointType::hinge);
        const Vec3 axis = scene.bodies[*joint.second].rotation * (joint.frame_second * Vec3::UnitX());
        EXPECT_LE((axis - Vec3::UnitY()).norm(), 1e-14);
    }
}

TEST(Chains, HaveTheKeysOfBodiesAndOfJoints) {
    const SceneDescription scene = scene_of(R"(links = 3
from = [0, 0, 0]
to = [3, 0, 0]
joint = { type = "ball", swing = 40, twist = [-5, 5], friction = 0.25, break_force = 7, collide = true }
twist = 90
mass = 2
friction = 0.5
colors = ["#000001", "#000002"]
velocity = [0, 1, 0]
[[force]]
body = "rope.2"
force = [1, 0, 0]
)");
    const BodyDescription& last = scene.bodies.at(4);
    EXPECT_EQ(last.mass, 2.0);
    EXPECT_EQ(last.friction, 0.5);
    EXPECT_EQ(last.velocity.y(), 1.0);
    EXPECT_EQ(last.appearance.color, (Color{0, 0, 1}));
    EXPECT_EQ(scene.bodies[3].appearance.color, (Color{0, 0, 2}));
    EXPECT_LE((scene.bodies[3].rotation * Vec3::UnitY() - Vec3::UnitZ()).norm(), 1e-14);
    EXPECT_EQ(scene.forces.at(0).body, 4u);
    ASSERT_EQ(scene.joints.size(), 2u);
    for (const JointDescription& joint : scene.joints) {
        EXPECT_NEAR(joint.swing.value()[0], 40.0 * pi / 180.0, 1e-15);
        EXPECT_EQ(joint.turn[1].friction, 0.25);
        EXPECT_EQ(joint.break_force, 7.0);
        EXPECT_TRUE(joint.collide);
        const Vec3 axis = scene.bodies[*joint.first].rotation * (joint.frame_first * Vec3::UnitX());
        EXPECT_LE((axis - Vec3::UnitX()).norm(), 1e-14);
    }
}

TEST(Chains, RefuseMistakes) {
    const std::string line = "from = [0, 0, 0]\nto = [3, 0, 0]\n", three = "links = 3\n" + line;
    const struct {
        std::string lines, phrase;
    } mistakes[] = {
        {"links = @0\n" + line, "links must be from 1"},
        {"links = @2\nloop = true\n" + line, "links must be from 3"},
        {"links = @1000000\n" + line, "makes too many bodies"},
        {"links = 3\nfrom = [0, 0, 0]\nto = @[0, 0, 0]", "to must be another point than from"},
        {three + "length = @2", "length must be at least the distance of the ends, 3 m"},
        {three + "length = 4\nsag = @1", "and length exclude each other"},
        {three + "sag = @0", "sag must be from 1e-09"},
        {"links = 1\nsag = @1\n" + line, "sag needs at least two links"},
        {"links = 3\nfrom = [0, 0, 0]\nto = [0, 3, 0]\nlength = @4", "has no hanging chain between these ends"},
        {"links = 2\nfrom = [0, 2, 0]\nto = [-1.5, -1, 2]\nsag = @20", "give more links"},
        {three + "loop = true\nsag = @1", "is for chains with ends"},
        {three + "loop = true\nends = @[\"free\", \"free\"]", "is for chains with ends"},
        {three + "loop = true\nnormal = @[1, 1, 0]", "must be square to the line"},
        {three + "normal = @[0, 0, 1]", "is for chains with loop = true"},
        {three + "ends = [\"world\", @\"bal\"]", "\"bal\" is not the name of a body (did you mean \"ball\"?)"},
        {three + "ends = @[\"world\"]", "must be an array of 2 names"},
        {three + "joint = @\"slider\"", "must be one of \"ball\", \"hinge\", \"universal\", \"fixed\""},
        {three + "joint = { type = @\"slider\", axis = [1, 0, 0] }", "must be one of \"ball\", \"hinge\""},
        {three + "joint = { type = \"ball\", anchor = @[0, 0, 0] }", "is given by the chain"},
        {three + "joint = { type = \"ball\", axis = @[0, 0, 1] }", "is given by the chain, but for a hinge"},
        {three + "joint = { type = \"hinge\", limits = @[1, 2] }", "must contain the start"},
        {"links = @90\nfrom = [999999999, 0, 0]\nto = [999999999.000001, 0, 0]", "makes links of unusable length, 0 m"},
        {"links = @9\nfrom = [0, 0, 0]\nto = [0, 0, 2e-9]", "makes links of unusable length"},
        {three + "colors = @[]", "must name at least one color"},
        {three + "@rotation = 1", "unknown key \"rotation\" in [[chain]]"},
        {three + "[[chain]]\nname = @\"rope\"\nshape = { type = \"sphere\", radius = 1 }\n" + three, "must be unique"},
        {three + "shape = @2", "redefine"},
    };
    for (const auto& mistake : mistakes) {
        const std::string text = chain(mistake.lines);
        const std::size_t mark = text.find('@');
        ASSERT_NE(mark, std::string::npos) << text;
        const std::string before = text.substr(0, mark);
        const auto line_number = 1 + std::count(before.begin(), before.end(), '\n');
        const std::string expected = "dir/scene.toml:" + std::to_string(line_number) + ":" +
                                     std::to_string(mark - before.rfind('\n')) + ": error: ";
        std::string error = "no error";
        try {
            parse_scene(before + text.substr(mark + 1), "dir/scene.toml");
        } catch (const InputError& e) {
            error = e.what();
        }
        EXPECT_EQ(error.substr(0, expected.size()), expected) << mistake.lines << "\n" << error;
        EXPECT_NE(error.find(mistake.phrase), std::string::npos) << mistake.lines << "\n" << error;
    }
}

}  // namespace
}  // namespace tumble::chains_test
