// Many bodies, most of them small on the screen: culling and levels of detail.
#include "drawing.h"
#include "example_scenes.h"
#include "random.h"

#include "render/ambient_occlusion/atlas_layout.h"
#include "render/ambient_occlusion/occlusion_atlas.h"
#include "render/mesh/mesh_lod.h"
#include "render/mesh/triangle_distance.h"
#include "render/render_scene_builder.h"

#include <gtest/gtest.h>

#include <cmath>

namespace tumble::many_bodies_test {
namespace {

/// Boxes of a pixel to some tens, in a cloud that hides most of its inside; balls and rings among them; a wall made of
/// a box.
SceneDescription crowded_scene() {
    Random random(3);
    SceneDescription scene = empty_scene();
    scene.output.samples = 1;
    scene.camera.eye = Vec3(0.0, 6.0, 40.0);
    scene.camera.target = Vec3(0.0, 3.0, 0.0);
    scene.bodies.push_back(ground_plane());
    const auto ring = torus_asset(0.5, 0.2);
    for (int i = 0; i < 4000; ++i) {
        const Vec3 at = Vec3(0.0, 4.0, -5.0) + random.vector(9.0, 3.5, i % 8 == 0 ? 40.0 : 12.0);
        const Color color = random.color();
        const double size = random.between(0.2, 1.2);
        if (i % 40 == 0)
            scene.bodies.push_back(ball_body(at, 0.5 * size, color));
        else if (i % 80 == 1)
            scene.bodies.push_back(mesh_body(at, ring, color, random.turn(0.1)));
        else
            scene.bodies.push_back(box_body(at, Vec3(size, random.between(0.2, 1.2), size), color, random.turn(0.1)));
    }
    scene.bodies.push_back(box_body(Vec3(-6.0, 3.0, 12.0), Vec3(5.0, 5.0, 0.5), {150, 150, 150}));
    return scene;
}

TEST(ManyBodies, CullingChangesNoByte) {
    const SceneDescription scene = crowded_scene();
    RenderSwitches everything;
    everything.draw_hidden = true;
    EXPECT_EQ(drawn(scene), drawn(scene, everything));
    const RenderScene render_scene = make_render_scene(scene);
    EXPECT_GT(render_scene.mesh_triangles, most_whole_triangles) << "so that meshes are simplified";
    FrameSetup setup(scene, render_scene);
    const auto visible = [&](bool one_sample) {
        const Visibility v = find_visible(setup.prepare(first_snapshot(scene), one_sample));
        return std::count(v.bodies.begin(), v.bodies.end(), true);
    };
    const auto coarse = visible(false), fine = visible(true);
    EXPECT_LT(fine, 0.7 * double(coarse)) << "by pixel much more is found hidden";
}

TEST(ManyBodies, PartialRedrawHasTheBytesOfAFullRedraw) {
    for (const int samples : {1, 4}) {  // with 4: smooth edges
        SceneDescription scene = crowded_scene();
        scene.output.samples = samples;
        RenderSwitches full;
        full.full_redraw = true;
        Renderer partial(scene), whole(scene, full);
        Snapshot snapshot = first_snapshot(scene);
        Random random(9);
        for (const int moved : {0, 1, 5, 60, 3000, 2}) {  // above a quarter, all AO is checked again
            for (int i = 0; i < moved; ++i) {
                BodyState& body = snapshot.bodies[1 + std::size_t(random.between(0.0, 4000.0))];
                body.origin += random.vector(0.4);
                body.orientation = random.turn(0.1);
            }
            ASSERT_EQ(partial.render(snapshot), whole.render(snapshot)) << moved << " moved, " << samples << " samples";
        }
    }
}

TEST(ManyBodies, HundredThousandFitTheAtlas) {
    RenderScene render_scene;
    RenderBody proxy;
    proxy.kind = DrawKind::box;
    proxy.half_size = Vec3::Constant(0.5);
    proxy.ao_radius = 0.5;
    for (const std::size_t count : {std::size_t(100), std::size_t(100'000)}) {
        render_scene.bodies.assign(count, proxy);
        OcclusionAtlas atlas;
        lay_out_places(render_scene, atlas);
        EXPECT_LE(atlas.height, OcclusionAtlas::most_body_rows);
        for (const OcclusionPlace& place : atlas.places) ASSERT_EQ(place.size, count == 100 ? 9 : 3);
    }
}

// A face that is small on the screen has one value, the formula's at its center; it changes to all texels without a
// jump.
TEST(ManyBodies, OcclusionBlendsFromOneValueToAllTexels) {
    double last = 0.0;
    for (double pixels = 0.0; pixels < 12.0; pixels += 0.01) {
        const double detail = occlusion_lod(pixels, 4.0, 8.0);
        EXPECT_LE(std::abs(detail - last), 0.005) << pixels;
        EXPECT_GE(detail, last);
        last = detail;
    }
    EXPECT_EQ(last, 1.0);
    const auto tile_range = [](double away) {  // of the texels of a face that stands on the ground
        SceneDescription scene = empty_scene();
        scene.camera.eye = Vec3(0.0, 1.0, away);
        scene.bodies = {ground_plane(), box_body(Vec3(0.0, 0.5, 0.0), Vec3::Ones(), {200, 200, 200})};
        for (std::size_t i = 0; i < large_scene; ++i)
            scene.bodies.push_back(box_body(Vec3(0.0, 50.0 + 9.0 * double(i), 0.0), Vec3::Ones(), {200, 200, 200}));
        const RenderScene render_scene = make_render_scene(scene);
        FrameSetup setup(scene, render_scene);
        const Snapshot snapshot = first_snapshot(scene);
        const FrameContext frame = setup.prepare(snapshot, false);
        AmbientOcclusion maker(render_scene, Vec3::Zero());
        maker.update(frame, everything_visible(frame));
        const OcclusionPlace& place = maker.atlas().places[1];
        int low = 255, high = 0;
        for (int j = 0; j < place.size; ++j)
            for (int i = 0; i < place.size; ++i) {
                const int at = maker.atlas().texels[std::size_t(place.y + j) * OcclusionAtlas::width +
                                                    std::size_t(place.x + 5 * place.size + i)];
                low = std::min(low, at);
                high = std::max(high, at);
            }
        return std::pair(low, high);
    };
    const auto [near_low, near_high] = tile_range(8.0);
    EXPECT_GT(near_high - near_low, 60);
    const auto [far_low, far_high] = tile_range(200.0);
    EXPECT_EQ(far_low, far_high);
    EXPECT_GT(far_low, near_low);
    EXPECT_LE(far_high, near_high);
}

TEST(TriangleDistance, OfATriangle) {
    const Vec3 a(0, 0, 0), b(2, 0, 0), c(0, 2, 0);
    EXPECT_DOUBLE_EQ(distance_to_triangle({0.5, 0.5, 3.0}, a, b, c), 3.0);             // above it
    EXPECT_DOUBLE_EQ(distance_to_triangle({-3.0, -4.0, 0.0}, a, b, c), 5.0);           // beyond a corner
    EXPECT_DOUBLE_EQ(distance_to_triangle({1.0, -2.0, 0.0}, a, b, c), 2.0);            // beside a side
    EXPECT_DOUBLE_EQ(distance_to_triangle({2.0, 2.0, 1.0}, a, b, c), std::sqrt(3.0));  // beside the long one
    EXPECT_DOUBLE_EQ(distance_to_triangle({5.0, 0.0, 4.0}, a, b, c), 5.0);
}

// An alternative to NearSurface: all triangles, one after the other.
double distance(const Vec3& point, const TriangleMesh& mesh) {
    double least = std::numeric_limits<double>::infinity();
    for (const auto& t : mesh.triangles)
        least =
            std::min(least, distance_to_triangle(point, mesh.vertices[t[0]], mesh.vertices[t[1]], mesh.vertices[t[2]]));
    return least;
}

TEST(MeshLod, IsOffByNoMoreThanAskedFor) {
    const auto asset = torus_asset(1.0, 0.3);
    SceneDescription scene = empty_scene();
    scene.bodies = {mesh_body(Vec3::Zero(), asset, {1, 2, 3})};
    const RenderScene render_scene = make_render_scene(scene);
    std::size_t last = asset->indices.size();
    for (const double deviation : {0.003, 0.01, 0.03, 0.1}) {
        const MeshLod detail = simplify(render_scene.meshes[0], deviation);
        EXPECT_LT(detail.indices.size(), last) << deviation;
        last = detail.indices.size();
        EXPECT_EQ(detail.surface.triangles.size() * 3, detail.indices.size());
        EXPECT_TRUE(closedness(detail.surface).closed()) << "it has an outline all around";
        for (const Vec3& vertex : asset->mesh.vertices) ASSERT_LE(distance(vertex, detail.surface), deviation);
        for (const auto& t : detail.surface.triangles) {
            const Vec3 middle =
                (detail.surface.vertices[t[0]] + detail.surface.vertices[t[1]] + detail.surface.vertices[t[2]]) / 3.0;
            ASSERT_LE(distance(middle, asset->mesh), deviation);
        }
    }
    EXPECT_LT(last, asset->indices.size() / 8);
}

// At any place on the screen, a point of a mesh that deviates as much as its level allows is within a quarter of a
// pixel of its true place.
TEST(MeshLod, IsOffByAQuarterOfAPixelAtMost) {
    SceneDescription scene = empty_scene();
    scene.bodies = {mesh_body(Vec3::Zero(), torus_asset(1.0, 0.3), {1, 2, 3})};
    RenderScene render_scene = make_render_scene(scene);
    EXPECT_EQ(
        level_in_view(render_scene.bodies[0], render_scene, Vec3(0.0, 0.0, -1000.0), Camera(scene.camera, 320, 180)),
        0u)
        << "few triangles";
    render_scene.mesh_triangles = most_whole_triangles + 1;
    const RenderBody& proxy = render_scene.bodies[0];
    const Camera view(scene.camera, scene.output.width, scene.output.height);
    Random random(4);
    double worst = 0.0;
    std::size_t coarsest = 0;
    for (int trial = 0; trial < 20000; ++trial) {
        const Vec3 center =
            view.ray(random.between(0.0, 320.0), random.between(0.0, 180.0)) * std::exp(random.between(0.0, 6.0));
        const std::size_t level = level_in_view(proxy, render_scene, center, view);
        coarsest = std::max(coarsest, level);
        if (level == 0) continue;
        const Vec3 point = center + random.turn(0.1) * Vec3::UnitX() * proxy.bound_radius;
        const Vec3 off = random.turn(0.1) * Vec3::UnitX() * deviation_of_level(proxy, level);
        const double pixels = (view.pixel(point + off) - view.pixel(point)).norm();
        EXPECT_LE(pixels, most_detail_error * 1.05);  // the deviation itself moves it nearer
        worst = std::max(worst, pixels);
    }
    EXPECT_GT(worst, 0.15) << "finer than needed";
    EXPECT_EQ(coarsest, mesh_levels - 1);
}

}  // namespace
}  // namespace tumble::many_bodies_test
