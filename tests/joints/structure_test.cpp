// Degrees of freedom, loops and redundant rows against those of known mechanisms.
#include "joint_scenes.h"

#include <gtest/gtest.h>

namespace tumble::structure_test {
using namespace tumble::testing;

namespace {

JointReport report_of(const SceneDescription& scene) { return World(scene).joint_report(); }

void expect(const JointReport& report, std::size_t freedom, std::size_t loops, std::size_t redundant) {
    EXPECT_EQ(report.degrees_of_freedom, freedom);
    EXPECT_EQ(report.loops, loops);
    EXPECT_EQ(report.redundant, redundant);
    EXPECT_EQ(report.groups, 1u);
    EXPECT_EQ(report.trees, loops == 0 ? 1u : 0u);
    EXPECT_TRUE(report.counted);
}

TEST(JointStructure, Trees) {
    expect(report_of(pendulum_scene(0.3)), 1, 0, 0);
    expect(report_of(double_pendulum_scene(16)), 2, 0, 0);
    expect(report_of(free_chain_scene(8)), 6 + 3 * 7, 0, 0);
}

TEST(JointStructure, ADoorWithTwoHinges) {
    SceneDescription scene = pendulum_scene(0.0);
    add_joint(scene, JointType::hinge, std::nullopt, 0, {0.0, 0.0, 0.5}, Vec3::UnitZ());
    expect(report_of(scene), 1, 1, 5);
}

TEST(JointStructure, APlanarFourBar) {
    SceneDescription scene = empty_scene();
    add_box(scene, {0.1, 1.0, 0.1}, {0.0, 0.5, 0.0});
    add_box(scene, {1.0, 0.1, 0.1}, {0.5, 1.0, 0.0});
    add_box(scene, {0.1, 1.0, 0.1}, {1.0, 0.5, 0.0});
    add_joint(scene, JointType::hinge, std::nullopt, 0, {0.0, 0.0, 0.0}, Vec3::UnitZ());
    add_joint(scene, JointType::hinge, 0, 1, {0.0, 1.0, 0.0}, Vec3::UnitZ());
    add_joint(scene, JointType::hinge, 1, 2, {1.0, 1.0, 0.0}, Vec3::UnitZ());
    add_joint(scene, JointType::hinge, 2, std::nullopt, {1.0, 0.0, 0.0}, Vec3::UnitZ());
    expect(report_of(scene), 1, 1, 3);
}

// Six hinges along the edges of a cube: one more freedom than the count of rows says.
TEST(JointStructure, Bricard) {
    SceneDescription scene = empty_scene();
    const Vec3 corners[] = {{0, 0, 0}, {1, 0, 0}, {1, -1, 0}, {1, -1, 1}, {0, -1, 1}, {0, 0, 1}};
    const Vec3 axes[] = {Vec3::UnitY(), Vec3::UnitZ(), Vec3::UnitX(), Vec3::UnitY(), Vec3::UnitZ(), Vec3::UnitX()};
    for (int i = 0; i < 5; ++i) {
        const Vec3 along = corners[i + 1] - corners[i];
        add_box(scene, Vec3(0.1, 0.1, 0.1) + 0.9 * along.cwiseAbs(), 0.5 * (corners[i] + corners[i + 1]));
    }
    for (int i = 0; i < 6; ++i)
        add_joint(scene, JointType::hinge, i > 0 ? std::optional<std::size_t>(i - 1) : std::nullopt,
                  i < 5 ? std::optional<std::size_t>(i) : std::nullopt, corners[i], axes[i]);
    expect(report_of(scene), 1, 1, 1);
}

TEST(JointStructure, TheLargestMassRatioAndGap) {
    SceneDescription scene = free_chain_scene(3);
    scene.bodies[2].mass = 50.0;
    scene.joints[0].anchor_second.x() -= 0.25;
    const JointReport report = report_of(scene);
    EXPECT_NEAR(report.mass_ratio, 50.0, 1e-12);
    EXPECT_EQ(report.heaviest, std::optional<std::size_t>(1));
    EXPECT_NEAR(report.gap, 0.25, 1e-12);
    EXPECT_EQ(report.widest, std::optional<std::size_t>(0));
}

}  // namespace
}  // namespace tumble::structure_test
