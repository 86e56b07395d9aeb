// Partial redraw gives the bytes of a full redraw.
#include "drawing.h"
#include "example_scenes.h"
#include "random.h"

#include "render/damage/dirty_tiles.h"
#include "render/scene/pose_filter.h"

#include <gtest/gtest.h>

namespace tumble::partial_redraw_test {
namespace {

// Boxes, balls, a mesh, perhaps a wall, a cord, a low sun, a mirror.
enum class Ground { plane, large_body };

SceneDescription random_scene(unsigned seed, Ground ground = Ground::plane) {
    Random random(seed);
    SceneDescription scene = empty_scene();
    scene.output.width = 232;  // not a multiple of the tile size
    scene.output.height = 152;
    scene.output.samples = seed % 2 == 0 ? 4 : 1;
    scene.camera.eye = Vec3(random.between(-3.0, 3.0), random.between(0.5, 5.0), random.between(5.0, 9.0));
    scene.camera.target = Vec3(0.0, 0.8, 0.0);
    scene.light.direction = Vec3(random.between(-1.0, 1.0), -random.between(0.15, 1.0), random.between(-1.0, 0.6));
    scene.light.shadows = seed % 4 != 2;  // without shadows, changes of AO are not hidden
    scene.bodies.push_back(ground_plane({176, 180, 184}, seed % 3 == 0 ? Pattern::checker : Pattern::grid));
    if (ground == Ground::large_body) {  // larger than the near shadow map
        const double size = std::pow(10.0, random.between(1.2, 2.5));
        scene.bodies[0] = seed % 3 == 0   ? box_body(Vec3(0.0, -1.0, 0.0), Vec3(size, 2.0, size), {176, 180, 184})
                          : seed % 3 == 1 ? mesh_body(Vec3::Zero(), sheet_asset(size, 5), {176, 180, 184})
                                          : ball_body(Vec3(0.0, -size, 0.0), size, {176, 180, 184});
        if (seed % 2 == 0) scene.bodies[0].appearance.pattern = Pattern::grid;
        scene.bodies[0].type = BodyType::fixed;
    }
    if (seed % 4 == 1) {
        BodyDescription wall = ground_plane({190, 150, 140}, Pattern::plain);
        wall.shape = PlaneShape{Vec3(0.0, 0.0, 1.0), -2.5};
        scene.bodies.push_back(wall);
    }
    for (int i = 0; i < 9; ++i) {
        const Vec3 size(random.between(0.2, 1.2), random.between(0.2, 1.2), random.between(0.2, 1.2));
        scene.bodies.push_back(box_body(Vec3::Zero(), size, random.color()));
        scene.bodies.back().appearance.metallic = i == 3 ? 1.0 : 0.0;
        if (i == 4) scene.bodies.back().appearance.pattern = Pattern::checker;
    }
    for (int i = 0; i < 3; ++i)
        scene.bodies.push_back(ball_body(Vec3::Zero(), random.between(0.15, 0.6), random.color()));
    if (seed % 5 < 2) scene.bodies.push_back(mesh_body(Vec3::Zero(), torus_asset(0.5, 0.2), random.color()));
    if (seed % 10 == 8) scene.cords.push_back({2, Vec3(0.1, 0.2, 0.0), Vec3(0.5, 3.0, 0.0), 0.03, {60, 60, 60}});
    if (seed % 20 == 18) scene.cords.back().anchor_body = 4;  // moves with another body
    return scene;
}

bool is_ground(const SceneDescription& scene, std::size_t body) { return scene.bodies[body].type == BodyType::fixed; }

void place(const SceneDescription& scene, Random& random, Snapshot& snapshot) {
    const double spread = random.between(0.6, 3.0);  // close together they occlude each other
    for (std::size_t i = 0; i < snapshot.bodies.size(); ++i) {
        if (is_ground(scene, i)) continue;
        snapshot.bodies[i].origin =
            Vec3(random.between(-spread, spread), random.between(-0.1, spread), random.between(-spread, spread));
        if (random.chance(0.1)) snapshot.bodies[i].origin *= 6.0;  // outside the view, its shadow perhaps inside
        if (random.chance(0.05)) snapshot.bodies[i].origin = scene.camera.eye + random.vector(1.0);
        snapshot.bodies[i].orientation = random.turn();
        if (random.chance(0.3)) {  // on the ground
            snapshot.bodies[i].orientation = Quat::Identity();
            if (const auto* box = std::get_if<BoxShape>(&scene.bodies[i].shape))
                snapshot.bodies[i].origin.y() = 0.5 * box->size.y();
        }
    }
}

void move(const SceneDescription& scene, Random& random, Snapshot& snapshot) {
    const double share = random.between(0.0, 0.6), way = std::pow(10.0, random.between(-4.0, -0.5));
    for (std::size_t i = 0; i < snapshot.bodies.size(); ++i) {
        if (is_ground(scene, i) ? !random.chance(0.01) : !random.chance(share)) continue;
        snapshot.bodies[i].origin += random.vector(way);
        const Vec3 spin = random.vector(way);
        if (!is_ground(scene, i))
            snapshot.bodies[i].orientation =
                (snapshot.bodies[i].orientation * Quat(1.0, spin.x(), spin.y(), spin.z())).normalized();
    }
}

std::size_t different_pixels(const Image& a, const Image& b) {
    std::size_t count = 0;
    for (std::size_t i = 0; i < a.pixels.size(); i += 4)
        count += !std::equal(&a.pixels[i], &a.pixels[i] + 4, &b.pixels[i]);
    return count;
}

// Nothing differs outside the regions that the renderer reports as changed.
void expect_unchanged_elsewhere(const Image& before, const Image& after, const std::vector<Rectangle>& changed) {
    Image painted = before;
    for (const Rectangle& r : changed)
        for (int y = r.y; y < r.y + r.height; ++y) std::copy_n(after.at(r.x, y), 4 * r.width, painted.at(r.x, y));
    EXPECT_EQ(painted, after);
}

// Returns the redrawn part of all frames.
double draw_partly(unsigned seeds, Ground ground) {
    RenderSwitches everything;
    everything.full_redraw = true;
    double redrawn = 0.0;
    for (unsigned seed = 0; seed < seeds; ++seed) {
        const SceneDescription scene = random_scene(seed, ground);
        Renderer partial(scene), full(scene, everything);
        Image before;
        Random random(1000 + seed);
        Snapshot snapshot = first_snapshot(scene);
        for (int arrangement = 0; arrangement < 10; ++arrangement) {
            place(scene, random, snapshot);
            for (int step = 0; step < 3; ++step) {
                const Image &frame = partial.render(snapshot), &truth = full.render(snapshot);
                EXPECT_EQ(different_pixels(frame, truth), 0u)
                    << "scene " << seed << ", arrangement " << arrangement << ", step " << step;
                if (frame != truth) return 1.0;
                if (!before.pixels.empty()) expect_unchanged_elsewhere(before, frame, partial.changed());
                for (const Rectangle& r : partial.changed()) redrawn += double(r.width) * r.height;
                before = frame;
                move(scene, random, snapshot);
            }
        }
    }
    return redrawn / (seeds * 10.0 * 3.0 * 232.0 * 152.0);
}

TEST(PartialRedraw, HasTheBytesOfAFullRedrawInRandomScenes) {
    EXPECT_LT(draw_partly(20, Ground::plane), 0.8) << "of the pictures: the test must have something to leave out";
}

// Large receivers in both shadow maps.
TEST(PartialRedraw, HasTheBytesOfAFullRedrawOnLargeGrounds) {
    EXPECT_LT(draw_partly(12, Ground::large_body), 0.97) << "of the pictures";
}

// So high that it occludes nothing: only its shadow changes the receiver, in the near map and in the far one.
TEST(PartialRedraw, HasTheBytesOfAFullRedrawWhereAShadowMovesOnALargeGround) {
    RenderSwitches everything;
    everything.full_redraw = true;
    for (const bool mesh : {false, true}) {
        SceneDescription scene = empty_scene();
        scene.camera.eye = Vec3(0.0, 8.0, 24.0);
        scene.bodies.push_back(box_body(Vec3(0.0, -1.0, 0.0), Vec3(16.0, 2.0, 16.0), {176, 180, 184}));
        if (mesh) scene.bodies[0] = mesh_body(Vec3::Zero(), sheet_asset(16.0, 10), {176, 180, 184});
        scene.bodies.push_back(ball_body(Vec3(0.0, 2.0, 0.0), 0.3, {200, 60, 40}));
        scene.bodies.push_back(box_body(Vec3(-1.0, 0.25, 0.0), Vec3::Constant(0.5), {60, 90, 200}));
        Renderer partial(scene), full(scene, everything);
        Snapshot snapshot = first_snapshot(scene);
        for (int step = 0; step < 30; ++step) {
            snapshot.bodies[1].origin = Vec3(0.25 * step, 2.0, -0.1 * step);
            EXPECT_EQ(different_pixels(partial.render(snapshot), full.render(snapshot)), 0u)
                << "step " << step << (mesh ? ", mesh" : ", box");
        }
    }
}

// Earlier frames have no influence, for example if the ground's AO tile was wide, then long, then both: texels that
// were never uploaded must not be read.
TEST(PartialRedraw, EarlierFramesHaveNoInfluence) {
    SceneDescription scene = empty_scene();
    scene.output.width = 232;
    scene.output.height = 152;
    scene.camera.eye = Vec3(0.0, 5.0, 6.0);
    scene.camera.target = Vec3(0.0, 0.0, 0.0);
    scene.bodies.push_back(ground_plane({176, 180, 184}, Pattern::plain));
    for (int i = 0; i < 4; ++i) scene.bodies.push_back(box_body(Vec3::Zero(), Vec3::Constant(0.5), {200, 60, 40}));
    Renderer used(scene);
    Snapshot snapshot = first_snapshot(scene);
    for (const auto& [wide, deep] : {std::pair{1.5, 0.4}, {0.4, 1.5}, {1.5, 1.5}, {2.5, 0.4}, {0.4, 2.5}, {2.5, 2.5}}) {
        for (int i = 0; i < 4; ++i)
            snapshot.bodies[std::size_t(i + 1)].origin =
                Vec3(i % 2 == 0 ? wide : -wide, 0.3, i / 2 == 0 ? deep : -deep);
        EXPECT_EQ(different_pixels(used.render(snapshot), drawn(scene, snapshot)), 0u) << wide << " by " << deep;
    }
}

// Nor has the earlier look of sides that are out of sight: a thin side seen edge-on must not have the AO of the next
// tile in the atlas.
TEST(PartialRedraw, ThinSidesHaveTheirOwnOcclusion) {
    SceneDescription scene = empty_scene();
    scene.output.width = 232;
    scene.output.height = 152;
    scene.bodies.push_back(ground_plane({176, 180, 184}, Pattern::plain));
    Random random(3);
    for (int i = 0; i < 90; ++i) scene.bodies.push_back(box_body(Vec3::Zero(), Vec3(0.1, 0.004, 0.4), {200, 160, 140}));
    Renderer used(scene);
    Snapshot snapshot = first_snapshot(scene);
    for (int arrangement = 0; arrangement < 12; ++arrangement) {
        for (std::size_t i = 1; i < snapshot.bodies.size(); ++i) {
            snapshot.bodies[i].origin = Vec3(0.0, 0.2, 0.0) + random.vector(2.5, 0.2, 2.5);
            snapshot.bodies[i].orientation = random.turn();
        }
        EXPECT_EQ(different_pixels(used.render(snapshot), drawn(scene, snapshot)), 0u) << "arrangement " << arrangement;
    }
}

TEST(PartialRedraw, DrawsNothingWhereNothingMoves) {
    const SceneDescription scene = random_scene(1);
    Renderer renderer(scene);
    Random random(5);
    Snapshot snapshot = first_snapshot(scene);
    place(scene, random, snapshot);
    const Image first = renderer.render(snapshot);
    EXPECT_EQ(renderer.changed(), (std::vector<Rectangle>{{0, 0, 232, 152}}));
    const Image& second = renderer.render(snapshot);
    EXPECT_TRUE(renderer.changed().empty());
    EXPECT_EQ(second, first);
}

TEST(DirtyTiles, MarksTheTilesOfAHull) {
    const SceneDescription scene = empty_scene();  // 320 x 180: 20 x 12 tiles
    const Camera view(scene.camera, 320, 180);
    DirtyTiles marks(view);
    EXPECT_TRUE(marks.none());
    const auto at = [&](double x, double y) { return Vec3(7.0 * view.ray(x, y)); };
    const std::array<Vec3, 3> triangle = {at(40.0, 40.0), at(120.0, 40.0), at(40.0, 120.0)};
    marks.mark_hull(triangle);
    EXPECT_TRUE(marks.at(2, 2));
    EXPECT_TRUE(marks.at(7, 2));  // the corner on the right
    EXPECT_TRUE(marks.at(2, 7));
    EXPECT_TRUE(marks.at(4, 4));
    EXPECT_FALSE(marks.at(7, 5));  // beyond the long side
    EXPECT_FALSE(marks.at(8, 2));
    EXPECT_FALSE(marks.at(1, 1));
    EXPECT_FALSE(marks.all());
    const std::array<Vec3, 2> behind = {at(0.0, 0.0), Vec3(-at(0.0, 0.0))};
    marks.mark_hull(behind);
    EXPECT_TRUE(marks.all()) << "a hull beside the eye may be anywhere";
}

}  // namespace
}  // namespace tumble::partial_redraw_test
