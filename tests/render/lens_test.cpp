// Depth of field: a point in focus is sharp, all else a disc of known size; frames do not depend on the ones before.
#include "drawing.h"
#include "example_scenes.h"

#include "core/image_mean.h"
#include "render/camera/lens.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace tumble::lens_test {
namespace {

/// A small light ball before a dark sky, at a distance from the eye.
SceneDescription point_scene(double distance, double focus, double aperture) {
    SceneDescription scene = empty_scene();
    scene.environment.emplace();
    scene.environment->background = BackgroundKind::colors;
    scene.camera.eye = Vec3(0.0, 1.0, 8.0);
    scene.camera.target = Vec3(0.0, 1.0, 0.0);
    scene.camera.dof = DepthOfField{aperture, focus, {}, 64};
    scene.bodies = {ball_body(Vec3(0.0, 1.0, 8.0 - distance), 0.02 * distance, {255, 255, 255})};
    return scene;
}

/// Columns of the middle row that are lighter than the sky.
int width_of(const Image& image) {
    int first = image.width, last = -1;
    for (int x = 0; x < image.width; ++x)
        if (brightness(image, {x, image.height / 2}) > 12.0) {
            first = std::min(first, x);
            last = x;
        }
    return last - first + 1;
}

TEST(Lens, HasPointsSpreadEvenlyOverADiscThatMomentsShare) {
    for (const int count : {1, 3, 8, 40}) {
        std::vector<Eigen::Vector2d> all;
        for (int i = 0; i < count; ++i) {
            const auto points = lens_points(16, {i, count});
            EXPECT_EQ(points.size(), lens_points(16, {0, count}).size());
            all.insert(all.end(), points.begin(), points.end());
        }
        EXPECT_GE(all.size(), 16u);
        EXPECT_LE(all.size(), std::size_t(15 + count));
        Eigen::Vector2d middle = Eigen::Vector2d::Zero();
        double squares = 0.0;
        for (const Eigen::Vector2d& point : all) {
            EXPECT_LE(point.norm(), 1.0);
            middle += point / double(all.size());
            squares += point.squaredNorm() / double(all.size());
        }
        EXPECT_LT(middle.norm(), 0.1);
        EXPECT_NEAR(squares, 0.5, 1e-9);  // of a disc
    }
}

TEST(Lens, BlursAPointToADiscByItsDistance) {
    const double focus = 4.0, aperture = 0.4;
    for (const double distance : {2.5, 4.0, 7.0}) {
        SceneDescription scene = point_scene(distance, focus, aperture);
        const int blurred = width_of(drawn(scene));
        scene.camera.dof.reset();
        const int sharp = width_of(drawn(scene));
        const double pixels_at_focus = 1.0 / (Camera(scene.camera, 320, 180).pixel_size() * focus);
        EXPECT_NEAR(blurred - sharp, aperture * std::abs(distance - focus) / distance * pixels_at_focus, 2.0)
            << "at " << distance << " m";
    }
}

TEST(Lens, FocusesOnABody) {
    SceneDescription scene = point_scene(3.0, 1.0, 0.4);
    scene.camera.dof->body = 0;
    const int blurred = width_of(drawn(scene));
    scene.camera.dof.reset();
    EXPECT_NEAR(blurred, width_of(drawn(scene)), 1.0);
}

TEST(Lens, HasTheSameFrameAfterAnyOther) {
    SceneDescription scene = heap_scene(12);
    scene.output.width = 232;
    scene.output.height = 152;
    scene.camera.dof = DepthOfField{0.3, 6.0, {}, 5};
    RenderSwitches switches;
    switches.full_redraw = true;
    switches.keep_depths = true;
    Renderer partial(scene), full(scene, switches);
    Snapshot snapshot = first_snapshot(scene);
    for (int i = 0; i < 3; ++i) {
        EXPECT_EQ(partial.render(snapshot), full.render(snapshot));
        EXPECT_EQ(partial.changed().size(), 1u);
        partial.render(snapshot);
        EXPECT_TRUE(partial.changed().empty()) << "nothing moved";
        snapshot.bodies[std::size_t(i) + 1].origin += Vec3(0.1, 0.2, 0.0);
    }
    scene.camera.dof.reset();  // depths are those of the middle of the lens
    switches.full_redraw = false;
    Renderer pinhole(scene, switches);
    snapshot.bodies[1].origin.y() += 0.5;
    full.render(snapshot);
    pinhole.render(snapshot);
    EXPECT_EQ(full.depths().depths, pinhole.depths().depths);
}

TEST(Lens, HasTheSameMeanInMomentsOfAFrame) {
    const SceneDescription scene = point_scene(7.0, 4.0, 0.3);
    Renderer renderer(scene);
    const Snapshot snapshot = first_snapshot(scene);
    const Image whole = renderer.render(snapshot);
    ImageMean mean;
    for (int i = 0; i < 4; ++i) mean.add(renderer.render(snapshot, {i, 4}));
    Image moments;
    mean.take(moments);
    int largest = 0;
    for (std::size_t i = 0; i < whole.pixels.size(); ++i)
        largest = std::max(largest, std::abs(int(whole.pixels[i]) - int(moments.pixels[i])));
    EXPECT_LE(largest, 4);
}

}  // namespace
}  // namespace tumble::lens_test
