// Culled shadow casters: their sides towards the sun are behind other boxes.
#include "core/vector.h"
#include "example_scenes.h"
#include "random.h"

#include "render/render_scene_builder.h"
#include "render/shadow/caster_culling.h"

#include <gtest/gtest.h>

namespace tumble::caster_culling_test {
namespace {

// True if the ray from `point` to the sun passes through the box.
bool shades(const BodyDescription& box, const Vec3& point, const Vec3& to_sun) {
    return passes_through(box, point, to_sun, 1e9);
}

/// A cloud of boxes, with wide ones among them, seen from the sun.
struct Cloud {
    Cloud() {
        Random random(5);
        for (int i = 0; i < 600; ++i) {
            const Vec3 size = random.vector(0.3) + Vec3::Constant(i % 10 == 0 ? 2.0 : 0.6);
            scene.bodies.push_back(box_body(random.vector(4.0, 4.0, 4.0), size, {200, 200, 200}, random.turn()));
        }
        render_scene = make_render_scene(scene);
        snapshot = first_snapshot(scene);
        items = make_drawables(render_scene, snapshot, view);
        fit = CascadeFitter(scene, render_scene, view, 768).fit(render_scene, snapshot, view);
    }

    SceneDescription scene = empty_scene();
    RenderScene render_scene;
    Camera view{scene.camera, 320, 180};
    Snapshot snapshot;
    PerDrawable<DrawableBounds> items;
    ShadowCascades fit;
};

TEST(CasterCulling, CulledCastersAreInTheShadowOfOthers) {
    const Cloud cloud;
    DrawableMask casters{std::vector<char>(cloud.items.bodies.size(), 1), {}};
    drop_hidden_casters(cloud.render_scene, cloud.items, cloud.fit, casters);
    const Vec3 to_sun = -cloud.scene.light.direction.normalized();
    int dropped = 0;
    for (std::size_t i = 0; i < cloud.items.bodies.size(); ++i) {
        if (casters.bodies[i] != 0) continue;
        ++dropped;
        for (double u = -1.0; u <= 1.0; u += 0.25)
            for (double v = -1.0; v <= 1.0; v += 0.25)
                for (int axis = 0; axis < 3; ++axis)
                    for (const double side : {-1.0, 1.0}) {
                        Vec3 on_cube;
                        on_cube[axis] = side;
                        on_cube[(axis + 1) % 3] = u;
                        on_cube[(axis + 2) % 3] = v;
                        const Vec3 point =
                            cloud.view.eye() + cloud.items.bodies[i].center + cloud.items.bodies[i].half_axes * on_cube;
                        bool shaded = false;
                        for (std::size_t k = 0; k < cloud.items.bodies.size() && !shaded; ++k)
                            shaded = casters.bodies[k] != 0 && shades(cloud.scene.bodies[k], point, to_sun);
                        ASSERT_TRUE(shaded) << "body " << i;
                    }
    }
    EXPECT_GT(dropped, 150) << "of 600: there is much to leave out";
}

TEST(CasterCulling, HidesBodiesBehindABoxAndNoOthers) {
    SceneDescription scene = empty_scene();
    const Vec3 down = scene.light.direction.normalized();
    const Vec3 across = down.unitOrthogonal();
    const Quat turned = rotation_between(Vec3::UnitZ(), down);
    const auto cube = [&](const Vec3& at, double size) {
        return box_body(at, Vec3::Constant(size), {200, 200, 200}, turned);
    };
    scene.bodies = {cube(Vec3(0.0, 2.0, 0.0), 2.0)};
    const Vec3 front = scene.bodies[0].position;
    for (const auto& [away, beside] :
         {std::pair(1.6, 0.0), {1.6, 0.6}, {1.6, 0.9}, {-1.6, 0.0}, {0.0, 0.0}, {6.0, 0.0}})
        scene.bodies.push_back(cube(front + away * down + beside * across, 0.5));
    scene.bodies.push_back(cube(front + 2.0 * down, 2.5));  // wider than the box in front of it
    const RenderScene render_scene = make_render_scene(scene);
    const Camera view(scene.camera, 320, 180);
    const Snapshot snapshot = first_snapshot(scene);
    const std::vector<DrawableBounds> items = make_drawables(render_scene, snapshot, view).bodies;
    const ShadowCascades fit = CascadeFitter(scene, render_scene, view, 768).fit(render_scene, snapshot, view);
    CasterCulling cover(fit);
    cover.add(items[0]);
    std::vector<bool> hidden;
    for (const DrawableBounds& item : items) hidden.push_back(cover.hides(item));
    EXPECT_EQ(hidden, (std::vector<bool>{false, true, true, false, false, true, true, false}))
        << "itself; behind; behind, beside; out at the rim; before; within; far behind; wider";
}

}  // namespace
}  // namespace tumble::caster_culling_test
