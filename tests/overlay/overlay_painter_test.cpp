// Pixels of overlays over rendered frames: their places by the camera's intrinsics, and the equality of incremental and
// full drawing.
#include "overlay/overlay_painter.h"

#include "overlay/overlay_builder.h"
#include "render/aov/pinhole_camera.h"
#include "render/render_switches.h"
#include "scene/load.h"
#include "sim/world.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace tumble::overlay_painter_test {
namespace {

constexpr const char* drop = R"(
format = 1
[simulation]
duration = 1.0
impacts = "exact"
[output]
size = [320, 180]
[materials.wood]
friction = 0.4
restitution = 0.5
[[body]]
type = "fixed"
shape = { type = "plane" }
material = "wood"
[[body]]
shape = { type = "box", size = [1, 1, 1] }
material = "wood"
position = [0, 1.2, 0]
rotation = { axis = [1, 0.4, 0.2], angle = 20 }
[[body]]
shape = { type = "sphere", radius = 0.4 }
material = "wood"
position = [1.2, 1.9, 0.3]
velocity = [-1, 0, 0]
[overlay]
show = ["forces", "impulses", "velocity", "trails", "ghosts", "contacts", "names", "com", "aabb"]
impulse_time = 0.1
ghost_every = 6
)";

RenderSwitches with_depths() {
    RenderSwitches switches;
    switches.keep_depths = true;
    return switches;
}

OverlayScales some_scales() {
    OverlayScales scales{};
    scales[std::size_t(ArrowQuantity::force)] = 1e-4;
    scales[std::size_t(ArrowQuantity::impulse)] = 1e-3;
    scales[std::size_t(ArrowQuantity::velocity)] = 0.2;
    return scales;
}

PanelOverlay with_legend(const SceneDescription& scene) {
    PanelOverlay overlay;
    overlay.scales = some_scales();
    overlay.legend = true;
    overlay.frame_height = scene.output.height;
    return overlay;
}

TEST(OverlayPainter, TheLegendShowsTheTimeBetweenGhostsInTheScene) {
    SceneDescription scene = parse_scene(drop, "test.toml");
    PanelOverlay slow = with_legend(scene);
    scene.overlay.ghost_every = 1;
    const Image plain = *draw_legend(scene, slow);
    slow.frame_step /= 4.0;
    EXPECT_NE(draw_legend(scene, slow)->pixels, plain.pixels);
    scene.overlay.ghost_every = 4;
    EXPECT_EQ(draw_legend(scene, slow)->pixels, plain.pixels);
}

TEST(OverlayPainter, AnArrowLiesOnTheProjectionOfItsEnds) {
    SceneDescription scene = parse_scene(drop, "test.toml");
    scene.overlay = {};
    const Snapshot snapshot = World(scene).snapshot();
    Renderer renderer(scene, with_depths());
    const Image plain = renderer.render(snapshot);
    OverlayPainter painter(scene, {});
    OverlayFrame shapes;
    const OverlayArrow arrow{{-1.5, 0.2, 0.8}, {0.9, 2.4, 1.1}, {{255, 0, 255}, 1.0f, false}, 6.0f, false};
    shapes.arrows.push_back(arrow);
    const Image& drawn = painter.draw({plain, renderer.changed(), renderer.depths(), renderer.camera()}, shapes);

    const PinholeCamera camera(renderer.camera());
    const auto pixel = [&](const Vec3& world) {  // integers at pixel centers
        const Vec3 p = camera.from_world(world);
        return Eigen::Vector2d(camera.focal * p.x() / p.z() + camera.center_x,
                               camera.focal * p.y() / p.z() + camera.center_y);
    };
    const Eigen::Vector2d foot = pixel(arrow.from), tip = pixel(arrow.to);
    const Eigen::Vector2d axis = (tip - foot).normalized();
    double least = 1e9, most = -1e9, sideways = 0.0, count = 0.0;
    for (int y = 0; y < plain.height; ++y)
        for (int x = 0; x < plain.width; ++x) {
            const std::uint8_t* p = drawn.at(x, y);
            if (p[0] < 180 || p[1] > 90 || p[2] < 180) continue;
            const Eigen::Vector2d from_foot = Eigen::Vector2d(x, y) - foot;
            least = std::min(least, from_foot.dot(axis));
            most = std::max(most, from_foot.dot(axis));
            sideways += from_foot.x() * axis.y() - from_foot.y() * axis.x();
            ++count;
        }
    ASSERT_GT(count, 50.0);
    EXPECT_NEAR(most, (tip - foot).norm(), 1.0);
    EXPECT_NEAR(least, 0.0, 2.3);  // a round foot of half the width, 1.8 pixels
    EXPECT_NEAR(sideways / count, 0.0, 0.25);
}

// The depth test: an arrow behind the box is fainter than the same arrow in front of it.
TEST(OverlayPainter, ABodyHidesAnArrow) {
    SceneDescription scene = parse_scene(drop, "test.toml");
    scene.overlay = {};
    const Snapshot snapshot = World(scene).snapshot();
    Renderer renderer(scene, with_depths());
    const Image plain = renderer.render(snapshot);
    const Vec3 toward_eye = (renderer.camera().eye() - snapshot.bodies[1].origin).normalized();
    const auto difference = [&](double distance) {
        OverlayPainter painter(scene, {});
        OverlayFrame shapes;
        shapes.markers.push_back({snapshot.bodies[1].origin + distance * toward_eye, {{255, 0, 255}, 1.0f, true}});
        const Image& drawn = painter.draw({plain, renderer.changed(), renderer.depths(), renderer.camera()}, shapes);
        double sum = 0.0;
        for (std::size_t i = 0; i < drawn.pixels.size(); ++i)
            sum += std::abs(int(drawn.pixels[i]) - int(plain.pixels[i]));
        return sum;
    };
    EXPECT_LT(difference(-1.5), 0.8 * difference(1.5));
    EXPECT_GT(difference(-1.5), 0.2 * difference(1.5));
}

// As with several render processes: each draws some of the frames only.
TEST(OverlayPainter, AFrameDoesNotDependOnThoseDrawnBefore) {
    const SceneDescription scene = parse_scene(drop, "test.toml");
    const auto frames_drawn_by = [&](int first, int stride) {
        World world(scene);
        world.record_contacts();
        OverlayBuilder builder(scene, some_scales());
        Renderer renderer(scene, with_depths());
        OverlayPainter painter(scene, with_legend(scene));
        std::vector<Image> images;
        for (int n = 0; n <= 48; ++n) {
            if (n > 0) world.advance_frame();
            const Snapshot snapshot = world.snapshot();
            const OverlayFrame& shapes = builder.next(snapshot, &world.contact_records());
            if (n < first || (n - first) % stride != 0) continue;
            const Image& image = renderer.render(snapshot);
            images.push_back(painter.draw({image, renderer.changed(), renderer.depths(), renderer.camera()}, shapes));
        }
        return images;
    };
    const std::vector<Image> all = frames_drawn_by(0, 1), some = frames_drawn_by(0, 4), last = frames_drawn_by(48, 1);
    for (std::size_t k = 0; k < some.size(); ++k) EXPECT_EQ(some[k], all[4 * k]) << k;
    EXPECT_EQ(last.back(), all.back());
}

TEST(OverlayPainter, ChangedRegionsContainEveryChange) {
    const SceneDescription scene = parse_scene(drop, "test.toml");
    World world(scene);
    world.record_contacts();
    OverlayBuilder builder(scene, some_scales());
    Renderer renderer(scene, with_depths());
    OverlayPainter painter(scene, with_legend(scene));
    Image before;
    for (int n = 0; n <= 30; ++n) {
        if (n > 0) world.advance_frame();
        const Snapshot snapshot = world.snapshot();
        const Image& image = renderer.render(snapshot);
        const Image& drawn = painter.draw({image, renderer.changed(), renderer.depths(), renderer.camera()},
                                          builder.next(snapshot, &world.contact_records()));
        if (n > 0) {
            for (const Rectangle& r : painter.changed())
                for (int y = r.y; y < r.y + r.height; ++y)
                    std::copy_n(drawn.at(r.x, y), std::size_t(r.width) * 4, before.at(r.x, y));
            EXPECT_EQ(before, drawn) << n;
        }
        before = drawn;
    }
}

TEST(OverlayPainter, DepthsAreThoseOfTheGroundInClosedForm) {
    SceneDescription scene = parse_scene(drop, "test.toml");
    scene.bodies.resize(1);
    Renderer renderer(scene, with_depths());
    renderer.render(World(scene).snapshot());
    const Camera& camera = renderer.camera();
    int compared = 0;
    for (int y = 0; y < 180; y += 10)
        for (int x = 0; x < 320; x += 10) {
            const Vec3 ray = camera.ray(x + 0.5, y + 0.5);
            const float depth = *renderer.depths().at(x, y);
            if (ray.y() > -0.05) continue;  // near the horizon a depth is rounded coarsely
            EXPECT_NEAR(depth, -camera.eye().y() / ray.y(), 1e-3 * depth) << x << ' ' << y;
            ++compared;
        }
    EXPECT_GT(compared, 100);
}

}  // namespace
}  // namespace tumble::overlay_painter_test
