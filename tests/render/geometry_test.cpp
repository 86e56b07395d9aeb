// The parts of drawing without OpenGL, compared with closed forms and slower methods.
#include "example_scenes.h"

#include "core/deterministic_math.h"
#include "render/ambient_occlusion/analytic_occlusion.h"
#include "render/ambient_occlusion/mesh_occlusion_data.h"
#include "render/ambient_occlusion/texel_grid.h"
#include "render/camera/camera.h"
#include "render/damage/dirty_tiles.h"
#include "render/passes/draw_list.h"
#include "render/render_scene_builder.h"
#include "render/scene/drawable_bounds.h"
#include "render/scene/large_receivers.h"
#include "render/scene/plane_patch.h"
#include "render/scene/render_scene.h"
#include "render/shadow/shadow_cascades.h"
#include "render/shapes/primitive_meshes.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace tumble::geometry_test {
namespace {

Vec3 position(const DrawMesh& mesh, std::uint32_t i) {
    const float* p = mesh.vertices[i].position;
    return {double(p[0]), double(p[1]), double(p[2])};
}

double volume(const DrawMesh& mesh) {
    double sum = 0.0;
    for (std::size_t i = 0; i < mesh.indices.size(); i += 3)
        sum += position(mesh, mesh.indices[i])
                   .dot(position(mesh, mesh.indices[i + 1]).cross(position(mesh, mesh.indices[i + 2]))) /
               6.0;
    return sum;
}

TEST(Primitives, FaceOutwardAndFillTheirVolume) {
    EXPECT_NEAR(volume(make_half_box()), 4.0, 1e-6);   // three pyramids of the cube's six
    EXPECT_NEAR(volume(make_ball(0)), 2.53615, 1e-4);  // icosahedron of circumradius 1
    EXPECT_NEAR(volume(make_ball(4)), 4.18879, 0.02);  // 4 pi / 3
    EXPECT_EQ(make_ball(3).indices.size(), 3u * 20u * 64u);
    EXPECT_NEAR(volume(make_cylinder(256)), 2.0 * 3.14159265, 1e-3);
}

TEST(AnalyticOcclusion, AWallTakesTheShareOfTheFormula) {
    // Ground point at distance x from a wall much higher than the AO radius h: d(p + n h_k) = x.
    Occluder wall{};
    wall.center.setZero();
    wall.to_local.setIdentity();
    wall.half_size = {1.0f, 50.0f, 50.0f};
    wall.ao_radius = 0.5f;
    SurfacePoints points;
    for (const float x : {0.0f, 0.05f, 0.3f, 0.6f}) points.add({1.0f + x, 0.0f, 0.0f}, Eigen::Vector3f::UnitY());
    occlude(points, wall, 1e9f);
    std::size_t i = 0;
    for (const float x : {0.0f, 0.05f, 0.3f, 0.6f}) {
        const auto share = [&](float h) { return std::max(0.0f, 1.0f - x / h); };
        const float closed = 0.5f * (share(near_sample * 0.5f) + share(0.5f));
        EXPECT_NEAR(points.open[i++], 1.0f - occlusion_strength * closed, 1e-6f) << x;
    }
}

TEST(AnalyticOcclusion, CoplanarFacesAndBodiesBehindDoNotOcclude) {
    Occluder box{};
    box.center.setZero();
    box.to_local.setIdentity();
    box.half_size = {0.5f, 0.5f, 0.5f};
    box.ao_radius = 0.5f;
    SurfacePoints points;
    points.add({0.51f, 0.5f, 0.0f}, Eigen::Vector3f::UnitY());  // the top of a neighbor of the same height
    points.add({0.6f, 0.0f, 0.0f}, Eigen::Vector3f::UnitX());   // turned away
    occlude(points, box, 0.5f);
    EXPECT_NEAR(points.open[0], 1.0f, 0.01f);
    EXPECT_EQ(points.open[1], 1.0f);
}

TEST(TexelGrid, EqualsTheValuesOfSinglePoints) {
    std::mt19937 engine(3);
    const auto random = [&](float low, float high) {
        return low + (high - low) * float(double(engine()) / 4294967296.0);
    };
    const auto vector = [&](float size) {
        return Eigen::Vector3f(random(-size, size), random(-size, size), random(-size, size));
    };
    int dark = 0, clear = 0;
    for (int trial = 0; trial < 2000; ++trial) {
        Occluder box{};
        box.to_local =
            Quat(Eigen::AngleAxisd(random(0, 6), Vec3(0.3, 0.5, 0.8).normalized())).toRotationMatrix().cast<float>();
        box.half_size = {random(0.1f, 1.0f), random(0.1f, 1.0f), random(0.1f, 1.0f)};
        box.ao_radius = random(0.1f, 1.0f);
        box.center = vector(2.0f);
        const Eigen::Vector3f normal = vector(1.0f).normalized(),
                              across = normal.unitOrthogonal() * random(0.05f, 0.3f);
        const Eigen::Vector3f along = normal.cross(across), corner = vector(1.0f), floor = vector(1.0f).normalized();
        const int columns = 5, rows = 1 + trial % 4;
        const float ao_radius = random(0.1f, 1.0f), height = random(0.0f, 2.0f);
        TexelGrid lattice;
        lattice.set({corner, across, along, normal, columns, rows});
        lattice.occlude(box, ao_radius);
        SurfacePoints points;
        for (int j = 0; j < rows; ++j)
            for (int i = 0; i < columns; ++i) points.add(corner + float(i) * across + float(j) * along, normal);
        occlude(points, box, ao_radius);
        for (std::size_t k = 0; k < points.size(); ++k) {
            ASSERT_NEAR(lattice.open()[k], points.open[k], 1e-4f) << trial;
            (points.open[k] < 1.0f ? dark : clear) += 1;
        }
        lattice.occlude(floor, height, ao_radius);
        occlude(points, floor, height, ao_radius);
        for (std::size_t k = 0; k < points.size(); ++k) ASSERT_NEAR(lattice.open()[k], points.open[k], 1e-4f) << trial;
    }
    EXPECT_GT(dark, 1000);  // of 25,000
    EXPECT_GT(clear, 1000);
}

TEST(TileMerge, CoverEveryWantedCellOnceAndNoForbiddenOne) {
    std::mt19937 engine(9);
    const CellGrid grid{20, 12, 8, 157, 96};  // the last column is cut
    std::size_t strict = 0, loose = 0;
    for (int trial = 0; trial < 300; ++trial) {
        std::vector<int> cells(std::size_t(grid.columns * grid.rows));  // 0: forbidden, 1: free, 2: wanted
        for (int& cell : cells) cell = int(engine() % 3);
        const auto at = [&](int column, int row) { return cells[std::size_t(row * grid.columns + column)]; };
        const auto wanted = [&](int column, int row) { return at(column, row) == 2; };
        const std::vector<Rectangle> found =
            cell_rectangles(grid, wanted, [&](int column, int row) { return at(column, row) == 1; });
        loose += found.size();
        strict += cell_rectangles(grid, wanted).size();
        std::vector<int> held(cells.size(), 0);
        for (const Rectangle& r : found) {
            ASSERT_LE(r.x + r.width, grid.width);
            for (int row = r.y / 8; row * 8 < r.y + r.height; ++row)
                for (int column = r.x / 8; column * 8 < r.x + r.width; ++column) {
                    ASSERT_NE(at(column, row), 0);
                    ASSERT_EQ(held[std::size_t(row * grid.columns + column)]++, 0);
                }
        }
        for (std::size_t i = 0; i < cells.size(); ++i) ASSERT_TRUE(cells[i] != 2 || held[i] == 1);
    }
    EXPECT_LT(loose, strict);
}

TEST(OccluderFinder, EqualsAFullComparison) {
    std::mt19937 engine(5);
    const auto random = [&](float low, float high) {
        return low + (high - low) * float(double(engine()) / 4294967296.0);
    };
    std::vector<Occluder> occluders(300);
    for (std::size_t i = 0; i < occluders.size(); ++i) {
        occluders[i].center = {random(-20, 20), random(0, 5), random(-20, 20)};
        occluders[i].bound_radius = i % 50 == 0 ? 30.0f : random(0.1f, 1.5f);  // some plates among the boxes
        occluders[i].ao_radius = random(0.1f, 0.6f);
        occluders[i].body = i;
    }
    const OccluderFinder finder(occluders);
    std::vector<std::size_t> found;
    for (int trial = 0; trial < 200; ++trial) {
        const Eigen::Vector3f center(random(-25, 25), random(-2, 8), random(-25, 25));
        const float radius = trial % 20 == 0 ? 60.0f : random(0.0f, 2.0f);
        finder.find(center, radius, found);
        std::vector<std::size_t> expected;
        for (std::size_t i = 0; i < occluders.size(); ++i) {
            const float near = occluders[i].bound_radius + 2.0f * occluders[i].ao_radius + radius;
            if ((occluders[i].center - center).squaredNorm() < near * near) expected.push_back(i);
        }
        EXPECT_EQ(found, expected);
    }
}

TEST(OccluderBoxes, StayInsideAndLeaveTheHoleFree) {
    const auto torus = torus_asset(1.0, 0.3);
    const std::vector<OccluderBox> boxes = make_mesh_occluders(torus->mesh);
    ASSERT_FALSE(boxes.empty());
    EXPECT_LE(boxes.size(), 16u);
    double volume = 0.0;
    for (const OccluderBox& box : boxes) {
        volume += 8.0 * box.half_size.prod();
        EXPECT_GT(std::hypot(box.center.x(), box.center.z()), 0.6) << "in the hole";
        EXPECT_LT(std::hypot(box.center.x(), box.center.z()), 1.4) << "outside";
    }
    const double solid = 2.0 * 3.14159265 * 3.14159265 * 1.0 * 0.3 * 0.3;  // 2 pi^2 R r^2
    EXPECT_GT(volume, 0.4 * solid);
    EXPECT_LT(volume, 1.2 * solid);

    TriangleMesh open = torus->mesh;
    open.triangles.pop_back();
    EXPECT_TRUE(make_mesh_occluders(open).empty());
}

TEST(PlanePatch, CoversTheScreenBelowTheHorizon) {
    SceneDescription scene = empty_scene();
    scene.bodies = {ground_plane()};
    const RenderScene render_scene = make_render_scene(scene);
    const Camera view(scene.camera, 320, 180);  // level, eye at height 1: the horizon is the center row
    const std::vector<PlanePatch> patches = make_plane_patches(render_scene, first_snapshot(scene), view, 0.01);
    ASSERT_EQ(patches.size(), 1u);
    EXPECT_DOUBLE_EQ(patches[0].height, 1.0);
    for (const glm::vec3& corner : patches[0].corners) {
        EXPECT_GE(corner.y, -1e-6f);  // the lower half of the image, drawn with the first row at -1
        // z = 1 - 2 near / depth; the lowest row shows the ground at depth 1 / tan(20 degrees)
        const double depth = corner.y > 0.5f ? 1.0 / std::tan(20.0 * 3.14159265358979 / 180.0) : INFINITY;
        EXPECT_NEAR(corner.z, 1.0 - 0.02 / depth, 1e-6);
    }
    scene.camera.eye.y() = scene.camera.target.y() = -1.0;  // seen from below, a plane is transparent
    EXPECT_TRUE(make_plane_patches(render_scene, first_snapshot(scene), Camera(scene.camera, 320, 180), 0.01).empty());
}

TEST(PlanePatch, CellsAreRoundNumbers) {
    EXPECT_DOUBLE_EQ(pattern_cell(15.0), 1.0);
    EXPECT_NEAR(pattern_cell(0.015), 1e-3, 1e-12);
    EXPECT_DOUBLE_EQ(pattern_cell(30.0), 2.0);
    EXPECT_DOUBLE_EQ(pattern_cell(80.0), 5.0);
    EXPECT_DOUBLE_EQ(pattern_cell(15000.0), 1000.0);
}

TEST(ShadowCascades, HoldsStillWhileBodiesMoveAndGrowsInPowersOfTwo) {
    const SceneDescription scene = heap_scene(50);
    const RenderScene render_scene = make_render_scene(scene);
    const Camera view(scene.camera, 1280, 720);
    const CascadeFitter fitter(scene, render_scene, view, 1024);
    Snapshot snapshot = first_snapshot(scene);
    const ShadowCascades rest = fitter.fit(render_scene, snapshot, view);
    EXPECT_FALSE(rest.has_far);
    snapshot.bodies[3].origin += Vec3(0.3, 0.2, -0.1);
    const ShadowCascades moved_a_little = fitter.fit(render_scene, snapshot, view);
    EXPECT_EQ(rest.x, moved_a_little.x);
    EXPECT_EQ(rest.y, moved_a_little.y);
    EXPECT_EQ(rest.z, moved_a_little.z);
    snapshot.bodies[3].origin = Vec3(-25.0, 1.0, -30.0);
    const ShadowCascades flown = fitter.fit(render_scene, snapshot, view);
    EXPECT_EQ(rest.x, flown.x);
    EXPECT_EQ(rest.y, flown.y);
    ASSERT_TRUE(flown.has_far);
    const double growth = flown.far_texel / flown.near_texel;
    EXPECT_EQ(growth, std::exp2(std::round(std::log2(growth))));
    // every body lies in one of the two maps
    for (std::size_t i = 1; i < snapshot.bodies.size(); ++i) {
        const Vec3 p = view.relative(snapshot.bodies[i].origin);
        const glm::vec4 at(float(p.x()), float(p.y()), float(p.z()), 1.0f);
        const auto row = [&](const glm::vec4& r) { return r.x * at.x + r.y * at.y + r.z * at.z + r.w; };
        for (const float value : {row(flown.x), row(flown.y)}) {
            const float far = value * flown.far.x + flown.far.y;
            EXPECT_TRUE(far > 0.0f && far < 1.0f) << i;
        }
        EXPECT_TRUE(row(flown.z) > 0.0f && row(flown.z) < 1.0f) << i;
    }
}

// Boxes at most 4 m apart, on a possible large receiver: the others occupy 3 + 2 sqrt(3) / 2 = 4.73 m, at least 15 half
// edges.
TEST(LargeReceivers, AreMuchLargerThanAllTheRestTogether) {
    for (const auto& [size, ground] : {std::pair{5.0, false}, {7.0, false}, {9.0, true}, {300.0, true}}) {
        SceneDescription scene = empty_scene();
        scene.bodies.push_back(box_body(Vec3(0.0, -0.5, 0.0), Vec3(size, 1.0, size), {}));
        for (const double x : {-1.5, 0.5, 1.5}) scene.bodies.push_back(box_body(Vec3(x, 0.5, 0.0), Vec3::Ones(), {}));
        const RenderScene render_scene = make_render_scene(scene);
        EXPECT_EQ(render_scene.bodies[0].large_receiver, ground) << size;  // diagonal against 1.5 * max(4.73, 7.5)
        for (std::size_t i = 1; i < 4; ++i) EXPECT_FALSE(render_scene.bodies[i].large_receiver);
        EXPECT_EQ(render_scene.typical_ao_radius, 0.5);
    }
}

TEST(LargeReceivers, AreFoundBelowFallingBodies) {
    SceneDescription scene = empty_scene();
    scene.bodies.push_back(ground_plane());  // y = 0
    const Quat slope(Eigen::AngleAxisd(pi / 6.0, Vec3::UnitZ()));
    scene.bodies.push_back(box_body(Vec3(0.0, 20.0, 0.0), Vec3(40.0, 2.0, 40.0), {}, slope));
    scene.bodies.push_back(ball_body(Vec3(0.0, 25.0, 0.0), 0.5, {}));
    const RenderScene render_scene = make_render_scene(scene);
    ASSERT_TRUE(render_scene.bodies[1].large_receiver);
    const RestHeightEstimate landing(scene, render_scene);
    // Above the center plane the top is higher by 1 / cos 30 degrees, and rises by tan 30 degrees.
    EXPECT_NEAR(landing.fall(Vec3(0.0, 25.0, 3.0), -Vec3::UnitY()), 5.0 - 2.0 / std::sqrt(3.0), 1e-9);
    EXPECT_NEAR(landing.fall(Vec3(3.0, 25.0, 0.0), -Vec3::UnitY()), 5.0 - 5.0 / std::sqrt(3.0), 1e-9);
    EXPECT_NEAR(landing.fall(Vec3(0.0, 25.0, 21.0), -Vec3::UnitY()), 25.0, 1e-9) << "beside it";
    EXPECT_NEAR(landing.fall(Vec3(0.0, 10.0, 0.0), -Vec3::UnitY()), 10.0, 1e-9) << "under it";
    EXPECT_EQ(landing.fall(Vec3(0.0, 25.0, 0.0), Vec3::UnitY()), 0.0);
}

// The bounding ball of a wide receiver contains the eye; its visible part is at the bottom of the image, at the depth
// height / slope.
TEST(NearDistance, FitsTheGroundBelowTheEye) {
    SceneDescription scene = empty_scene();
    scene.camera.eye = Vec3(0.0, 4.0, 8.0);
    scene.bodies.push_back(box_body(Vec3(0.0, -1.0, 0.0), Vec3(100.0, 2.0, 100.0), {}));
    scene.bodies.push_back(box_body(Vec3(0.0, 0.5, 0.0), Vec3::Ones(), {}));
    const Camera view(scene.camera, 320, 180);
    const double near = near_distance_for(make_render_scene(scene), first_snapshot(scene), view);
    const double nearest = 4.0 / -view.ray(160.0, 180.0).y();
    EXPECT_LT(near, nearest);
    EXPECT_GT(near, nearest / 8.0) << "depths have too few bits";
}

TEST(DrawList, IsSortedFrontToBackAndOmitsBodiesOutOfView) {
    SceneDescription scene = heap_scene(30);
    scene.bodies.push_back(box_body(scene.camera.eye + Vec3(0.0, 0.0, 30.0), Vec3::Ones(), {1, 2, 3}));
    const RenderScene render_scene = make_render_scene(scene);
    FrameSetup setup(scene, render_scene);
    const Snapshot snapshot = first_snapshot(scene);
    const FrameContext frame = setup.prepare(snapshot, false);
    OcclusionAtlas atlas;
    atlas.places.resize(scene.bodies.size());
    const DrawableMask all{std::vector<char>(scene.bodies.size(), 1), {}};
    const DrawList list = make_draw_list(frame, find_visible(frame), atlas, all, all);
    std::size_t faces = 0;
    double last = 0.0;  // distance
    const double shell = std::exp2(1.0 / 8.0);
    for (const Batch& batch : list.visible) {
        EXPECT_EQ(batch.mesh, face_mesh);
        faces += batch.count;
        for (std::size_t i = 0; i < batch.count; ++i) {
            const glm::vec3& p = list.instances[batch.first + i].position;
            const double distance = std::sqrt(p.x * p.x + p.y * p.y + p.z * p.z);
            EXPECT_GE(distance, i == 0 ? last / shell : last - 1e-4);  // batches within one shell start again
            last = distance;
        }
    }
    EXPECT_LE(faces, 90u);  // at most three of each
    EXPECT_GE(faces, 45u);
}

}  // namespace
}  // namespace tumble::geometry_test
