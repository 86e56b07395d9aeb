// The scales of arrows: one for the clip, round, and the scene's own where given.
#include "overlay/overlay_scales.h"

#include <gtest/gtest.h>

#include <cmath>

namespace tumble::overlay_scales_test {
namespace {

constexpr auto velocity = std::size_t(ArrowQuantity::velocity);

/// A body, and a camera that sees 10 m at its target.
SceneDescription scene_with_velocity() {
    SceneDescription scene;
    scene.bodies.emplace_back();
    scene.bodies[0].shape = SphereShape{0.5};
    scene.overlay.show.add(Overlay::velocity);
    scene.camera.eye = {0.0, 0.0, 5.0 / std::tan(20.0 * 3.14159265358979 / 180.0)};
    scene.camera.target = {0.0, 0.0, 0.0};
    scene.camera.vertical_fov = 40.0;
    return scene;
}

Snapshot moving_at(double speed, double time = 0.0) {
    Snapshot snapshot;
    snapshot.time = time;
    snapshot.bodies.push_back({Vec3::Zero(), Vec3::Zero(), Quat::Identity(), {speed, 0.0, 0.0}, Vec3::Zero()});
    return snapshot;
}

TEST(OverlayScales, HalfOfTheArrowsAreATenthOfThePictureRoundedDown) {
    const SceneDescription scene = scene_with_velocity();
    ScaleSurvey survey(scene);
    for (int i = 1; i <= 9; ++i) survey.add(moving_at(i), nullptr);
    // The median is 5 m/s, and its bin ends at 5.5 m/s at most: 10 m / 10 / 5.5 = 0.18 m per m/s.
    EXPECT_EQ(survey.scales()[velocity], 0.1);
}

TEST(OverlayScales, TheLongestArrowFitsIntoThePicture) {
    const SceneDescription scene = scene_with_velocity();
    ScaleSurvey survey(scene);
    for (int i = 0; i < 100; ++i) survey.add(moving_at(1.0), nullptr);
    survey.add(moving_at(500.0), nullptr);
    EXPECT_LE(survey.scales()[velocity] * 500.0, 8.0 + 1e-9);
    EXPECT_GT(survey.scales()[velocity] * 500.0, 8.0 / 2.5);
}

TEST(OverlayScales, RestIsNotCounted) {
    const SceneDescription scene = scene_with_velocity();
    ScaleSurvey moving(scene), resting_too(scene);
    moving.add(moving_at(5.0), nullptr);
    resting_too.add(moving_at(5.0), nullptr);
    for (int i = 0; i < 1000; ++i) resting_too.add(moving_at(i % 2 == 0 ? 0.0 : 1e-9), nullptr);
    EXPECT_EQ(moving.scales(), resting_too.scales());
}

TEST(OverlayScales, SizesWithoutAFiniteScaleCountAsRest) {
    const SceneDescription scene = scene_with_velocity();
    ScaleSurvey survey(scene);
    survey.add(moving_at(1e-310), nullptr);
    EXPECT_EQ(survey.scales()[velocity], 0.0);
}

TEST(OverlayScales, BodiesThatAreNotShownAreNotCounted) {
    SceneDescription scene = scene_with_velocity();
    scene.bodies.push_back(scene.bodies[0]);
    scene.overlay.bodies = {1};
    scene.overlay.show.add(Overlay::loads);
    scene.forces.emplace_back();
    scene.forces[0].force = {1.0, 0.0, 0.0};  // on body 0
    ContactRecords records;
    ContactRecord contact;
    contact.a = contact.b = 0;
    contact.normal_force = 1.0;
    contact.normal = {0.0, 1.0, 0.0};
    records.contacts.push_back(contact);
    Snapshot snapshot = moving_at(100.0);
    snapshot.bodies[0].mass = 1.0;
    snapshot.bodies.emplace_back();
    ScaleSurvey survey(scene);
    survey.add(snapshot, &records);
    EXPECT_EQ(survey.scales(), OverlayScales{});
    EXPECT_EQ(survey.marks().states, 0u);
}

TEST(OverlayScales, TimesOutsideOfTheOverlayAreNotCounted) {
    SceneDescription scene = scene_with_velocity();
    scene.overlay.start = 1.0;
    scene.overlay.end = 2.0;
    ScaleSurvey survey(scene);
    survey.add(moving_at(100.0, 0.5), nullptr);
    survey.add(moving_at(100.0, 2.0), nullptr);
    EXPECT_EQ(survey.scales()[velocity], 0.0);
    survey.add(moving_at(1.0, 1.0), nullptr);
    EXPECT_GT(survey.scales()[velocity], 0.0);
}

TEST(OverlayScales, TheScenesScaleIsKeptAndNeedsNoSurvey) {
    SceneDescription scene = scene_with_velocity();
    EXPECT_TRUE(needs_survey(scene.overlay));
    scene.overlay.scale[velocity] = 0.0123;
    EXPECT_FALSE(needs_survey(scene.overlay));
    EXPECT_EQ(ScaleSurvey(scene).scales()[velocity], 0.0123);
}

TEST(OverlayScales, TwoPanelsHaveTheScaleOfBoth) {
    const SceneDescription scene = scene_with_velocity();
    ScaleSurvey slow(scene), fast(scene), both(scene);
    slow.add(moving_at(1.0), nullptr);
    both.add(moving_at(1.0), nullptr);
    fast.add(moving_at(90.0), nullptr);
    both.add(moving_at(90.0), nullptr);
    slow.add(fast);
    EXPECT_EQ(slow.scales(), both.scales());
}

TEST(OverlayScales, NothingIsRecordedForOverlaysWithoutContacts) {
    OverlayDescription overlay;
    for (const Overlay one : {Overlay::velocity, Overlay::omega, Overlay::trails, Overlay::ghosts, Overlay::aabb,
                              Overlay::names, Overlay::clock})
        overlay.show.add(one);
    EXPECT_FALSE(needs_records(overlay));
    overlay.show.add(Overlay::forces);
    EXPECT_TRUE(needs_records(overlay));
}

}  // namespace
}  // namespace tumble::overlay_scales_test
