// Depth, normal, segmentation and albedo against closed forms, for every pixel.
#include "world_rays.h"

#include "random.h"

#include <gtest/gtest.h>

#include <algorithm>

namespace tumble::aov_surface_test {
namespace {

constexpr double float_rounding = 6e-8;  // relative, of one rounding to float

AovSet all() {
    AovSet aovs;
    for (const Aov aov : all_aovs) aovs.add(aov);
    return aovs;
}

AovFrame made(const SceneDescription& scene, const AovSet& aovs = all()) {
    const Snapshot snapshot = first_snapshot(scene);
    return AovRenderer(scene, aovs).make({snapshot, snapshot});
}

/// Calls visit(index, column, row) for each pixel.
template <class Visit>
void for_pixels(const SceneDescription& scene, const Visit& visit) {
    for (int row = 0; row < scene.output.height; ++row)
        for (int column = 0; column < scene.output.width; ++column)
            visit(std::size_t(row * scene.output.width + column), column, row);
}

Vec3 normal_at(const AovFrame& frame, std::size_t pixel) {
    return {frame.normal[3 * pixel], frame.normal[3 * pixel + 1], frame.normal[3 * pixel + 2]};
}

TEST(AovSurface, DepthOfAPlane) {
    SceneDescription scene = empty_scene();
    scene.bodies = {ground_plane()};
    scene.bodies[0].position = Vec3(3.0, -1.0, 1.0);
    scene.bodies[0].shape = PlaneShape{Vec3::UnitY(), 0.3};
    scene.camera.target = Vec3(1.0, 0.4, 0.0);
    const AovFrame frame = made(scene);
    const WorldView view(scene);
    int ground = 0, sky = 0;
    for_pixels(scene, [&](std::size_t pixel, int column, int row) {
        const double fall = -view.ray(column, row).direction.y();
        const double height = scene.camera.eye.y() + 0.7;
        if (fall > 0.0) {
            ++ground;
            EXPECT_NEAR(frame.depth[pixel], height / fall, float_rounding * height / fall);
            EXPECT_EQ(normal_at(frame, pixel), Vec3::UnitY());
            EXPECT_EQ(frame.segmentation[pixel], 1);
        } else {
            ++sky;
            EXPECT_EQ(frame.depth[pixel], std::numeric_limits<float>::infinity());
            EXPECT_EQ(normal_at(frame, pixel), Vec3::Zero());
            EXPECT_EQ(frame.segmentation[pixel], 0);
        }
    });
    EXPECT_GT(ground, 1000);
    EXPECT_GT(sky, 1000);
}

TEST(AovSurface, ABoxSeenFromTheFront) {
    SceneDescription scene = empty_scene();
    scene.bodies = {box_body(Vec3(0.25, 1.0, 0.5), Vec3(2.0, 1.0, 3.0), {200, 133, 60})};
    const AovFrame frame = made(scene);
    const WorldView view(scene);
    // Its front face is at z = 2, 6 m from the eye; its left edge at x = -0.75, its lower one at y = 0.5.
    const Eigen::Vector2d low = view.place(Vec3(-0.75, 0.5, 2.0)), high = view.place(Vec3(1.25, 1.5, 2.0));
    for_pixels(scene, [&](std::size_t pixel, int column, int row) {
        const bool face = column >= low.x() && column <= high.x() && row <= low.y() && row >= high.y();
        EXPECT_EQ(frame.segmentation[pixel], face ? 1 : 0) << column << " " << row;
        EXPECT_EQ(frame.depth[pixel], face ? 6.0f : std::numeric_limits<float>::infinity());
        EXPECT_EQ(normal_at(frame, pixel), face ? Vec3(0.0, 0.0, 1.0) : Vec3(0.0, 0.0, 0.0));
        EXPECT_EQ(frame.albedo[3 * pixel], face ? 200 : 0);
        EXPECT_EQ(frame.albedo[3 * pixel + 1], face ? 133 : 0);
        EXPECT_EQ(frame.albedo[3 * pixel + 2], face ? 60 : 0);
    });
}

TEST(AovSurface, NormalsOfABoxAreThoseOfTheFaceThePointIsOn) {
    SceneDescription scene = empty_scene();
    const Quat turn(Eigen::AngleAxisd(0.7, Vec3(1.0, 2.0, 0.5).normalized()));
    const Vec3 size(3.0, 2.0, 1.5), middle(0.3, 1.2, 0.5);
    scene.bodies = {box_body(middle, size, {1, 2, 3}, turn)};
    const AovFrame frame = made(scene);
    const WorldView view(scene);
    std::array<int, 3> seen{};
    for_pixels(scene, [&](std::size_t pixel, int column, int row) {
        if (frame.segmentation[pixel] == 0) return;
        const Vec3 p = turn.conjugate() * (view.ray(column, row).at(frame.depth[pixel]) - middle);
        const Vec3 n = turn.conjugate() * normal_at(frame, pixel);
        Eigen::Index k = 0;
        EXPECT_NEAR(n.cwiseAbs().maxCoeff(&k), 1.0, 1e-6);
        EXPECT_NEAR(p[k], 0.5 * size[k] * n[k], 2e-6) << "the point is on the face";
        EXPECT_GT(normal_at(frame, pixel).dot(view.eye - view.ray(column, row).at(frame.depth[pixel])), 0.0);
        ++seen[std::size_t(k)];
    });
    for (const int pixels : seen) EXPECT_GT(pixels, 300);
}

TEST(AovSurface, ABallIsRound) {
    SceneDescription scene = empty_scene();
    const Vec3 center(1.0, 1.5, -2.0);
    const double radius = 1.3;
    scene.bodies = {ball_body(center, radius, {9, 9, 9}, Quat(Eigen::AngleAxisd(1.0, Vec3::UnitX())))};
    const AovFrame frame = made(scene);
    const WorldView view(scene);
    for_pixels(scene, [&](std::size_t pixel, int column, int row) {
        const WorldRay ray = view.ray(column, row);
        const Vec3 d = ray.direction, from = ray.eye - center;
        const double half = d.dot(from), rest = half * half - d.squaredNorm() * (from.squaredNorm() - radius * radius);
        ASSERT_EQ(frame.segmentation[pixel], rest >= 0.0 ? 1 : 0) << column << " " << row;
        if (rest < 0.0) return;
        const double depth = (-half - std::sqrt(rest)) / d.squaredNorm();
        EXPECT_NEAR(frame.depth[pixel], depth, float_rounding * depth);
        EXPECT_LT((normal_at(frame, pixel) - (ray.at(depth) - center) / radius).norm(), 2e-7);
    });
}

/// Bodies of all kinds at random places around a random eye, some of them near, behind it, or around it.
SceneDescription random_scene(unsigned seed) {
    Random random(seed);
    const auto between = [&](double low, double high) { return random.between(low, high); };
    const auto within = [&](double reach) { return between(-reach, reach); };
    const auto vector = [&](double reach) { return Vec3(within(reach), within(reach), within(reach)); };
    const auto turn = [&] { return Quat(Eigen::AngleAxisd(between(-3.0, 3.0), vector(1.0).normalized())); };
    SceneDescription scene = empty_scene();
    scene.output.width = 71;
    scene.output.height = 45;
    scene.camera.eye = vector(3.0);
    scene.camera.target = vector(3.0);
    scene.camera.up = vector(1.0);
    scene.camera.vertical_fov = between(5.0, 150.0);
    scene.bodies = {ground_plane()};
    scene.bodies[0].position.y() = between(-4.0, 0.0);
    scene.bodies[0].shape = PlaneShape{Vec3::UnitY(), between(-0.5, 0.5)};
    scene.bodies[0].rotation = Quat(Eigen::AngleAxisd(between(-0.3, 0.3), Vec3::UnitZ()));
    const auto torus = torus_asset(1.0, 0.4, 12, 8);
    for (int i = 0; i < 12; ++i) {
        const Vec3 at = vector(5.0);
        if (i % 3 == 0)
            scene.bodies.push_back(box_body(at, (vector(2.0).array().abs() + 0.05).matrix(), {}, turn()));
        else if (i % 3 == 1)
            scene.bodies.push_back(ball_body(at, between(0.1, 1.5), {}, turn()));
        else
            scene.bodies.push_back(mesh_body(at, torus, {}, turn()));
    }
    scene.bodies[5].appearance.visible = false;
    return scene;
}

TEST(AovSurface, EveryPixelShowsTheFirstSurfaceOnItsRay) {
    int several = 0;
    for (unsigned seed = 0; seed < 40; ++seed) {
        const SceneDescription scene = random_scene(seed);
        const AovFrame frame = made(scene);
        const WorldView view(scene);
        int wrong = 0;
        std::vector<char> seen(scene.bodies.size() + 1);
        for_pixels(scene, [&](std::size_t pixel, int column, int row) {
            const WorldHit hit = nearest_in_world(scene, first_snapshot(scene), view.ray(column, row));
            seen[std::size_t(frame.segmentation[pixel])] = 1;
            if (std::isinf(hit.first)) {
                wrong += frame.segmentation[pixel] != 0 ? 1 : 0;
                return;
            }
            const bool tie = hit.second - hit.first < 1e-9 * hit.first;
            const bool right = std::abs(frame.depth[pixel] - hit.first) <= 2.0 * float_rounding * hit.first &&
                               (tie || frame.segmentation[pixel] == std::int32_t(hit.body + 1));
            wrong += right ? 0 : 1;
        });
        EXPECT_EQ(wrong, 0) << "seed " << seed;
        if (std::ranges::count(seen, 1) > 4) ++several;
        EXPECT_EQ(seen[6], 0) << "an invisible body is seen";
    }
    EXPECT_GT(several, 10);
}

TEST(AovSurface, AMeshHasNoGapsAndTheNormalsItIsShadedWith) {
    SceneDescription scene = empty_scene();
    const Quat turn(Eigen::AngleAxisd(0.9, Vec3::UnitX()));
    const double ring = 1.5, tube = 0.6;
    scene.bodies = {mesh_body(Vec3(0.0, 1.0, 0.0), torus_asset(ring, tube), {}, turn)};
    const AovFrame frame = made(scene);
    const WorldView view(scene);
    int inside = 0;
    for_pixels(scene, [&](std::size_t pixel, int column, int row) {
        if (frame.segmentation[pixel] != 1) return;
        ++inside;
        // The mesh's triangles are near the exact torus, and its normals are those of the torus.
        const Vec3 p = turn.conjugate() * (view.ray(column, row).at(frame.depth[pixel]) - Vec3(0.0, 1.0, 0.0));
        const Vec3 on_ring = ring * Vec3(p.x(), 0.0, p.z()).normalized();
        EXPECT_NEAR((p - on_ring).norm(), tube, 0.05);
        EXPECT_NEAR(normal_at(frame, pixel).norm(), 1.0, 1e-6);
        EXPECT_GT((turn.conjugate() * normal_at(frame, pixel)).dot((p - on_ring).normalized()), 0.99);
        // No cracks: no empty pixel in a row of the mesh.
        if (column < 2 || frame.segmentation[pixel - 1] == 1) return;
        EXPECT_NE(frame.segmentation[pixel - 2], 1) << column << " " << row;
    });
    EXPECT_GT(inside, 2000);
}

TEST(AovSurface, AnOpenMeshIsSeenFromBothSidesAndAClosedShapeFromOutsideOnly) {
    auto sheet = std::make_shared<MeshAsset>();
    sheet->vertices = {{{-1, -1, 0}, {0, 0, 1}}, {{1, -1, 0}, {0, 0, 1}}, {{0, 2, 0}, {0, 0, 1}}};
    sheet->indices = {0, 1, 2};
    sheet->mesh.vertices = {{-1, -1, 0}, {1, -1, 0}, {0, 2, 0}};
    sheet->mesh.triangles = {{0, 1, 2}};
    for (const double side : {1.0, -1.0}) {
        SceneDescription scene = empty_scene();
        scene.camera.eye = Vec3(0.0, 0.0, 4.0 * side);
        scene.camera.target = Vec3::Zero();
        scene.bodies = {mesh_body(Vec3::Zero(), sheet, {}), box_body(scene.camera.eye, Vec3::Constant(1.0), {}),
                        ball_body(scene.camera.eye, 2.0, {}),
                        mesh_body(scene.camera.eye - Vec3(1.5, 0.0, 0.0), torus_asset(1.5, 0.8), {})};
        const AovFrame frame = made(scene);
        const auto middle = std::size_t(90 * 320 + 160);
        EXPECT_EQ(frame.segmentation[middle], 1);
        EXPECT_EQ(frame.depth[middle], 4.0f);
        EXPECT_EQ(normal_at(frame, middle), Vec3(0.0, 0.0, side)) << "towards the eye";
    }
}

TEST(AovSurface, PartsOfACompoundAreOneBodyWithTheirOwnColors) {
    SceneDescription scene = empty_scene();
    auto parts = std::make_shared<std::vector<CompoundPart>>(2);
    (*parts)[0].shape = BoxShape{{0.5, 0.5, 0.5}};
    (*parts)[0].position = Vec3(1.0, 0.0, 0.0);
    (*parts)[1].shape = SphereShape{0.3};
    (*parts)[1].position = Vec3(-1.0, 0.0, 0.0);
    (*parts)[1].color = Color{7, 8, 9};
    BodyDescription body =
        box_body(Vec3(0.0, 1.0, 0.0), Vec3::Ones(), {1, 2, 3}, Quat(Eigen::AngleAxisd(M_PI, Vec3::UnitY())));
    body.shape = CompoundShape{parts};
    scene.bodies = {ground_plane(), body};
    const AovFrame frame = made(scene);
    const WorldView view(scene);
    // After half a turn, the box is on the left.
    for (const auto& [at, red] : {std::pair(Vec3(-1.0, 1.0, 0.0), 1), std::pair(Vec3(1.0, 1.0, 0.0), 7)}) {
        const Eigen::Vector2d place = view.place(at);
        const auto pixel = std::size_t(std::lround(place.y()) * 320 + std::lround(place.x()));
        EXPECT_EQ(frame.segmentation[pixel], 2);
        EXPECT_EQ(frame.albedo[3 * pixel], red);
    }
}

TEST(AovSurface, ACordIsACylinderWithEnds) {
    SceneDescription scene = empty_scene();
    scene.bodies = {ball_body(Vec3(0.0, 0.2, 0.0), 0.4, {})};
    scene.cords.push_back({0, Vec3(0.0, 0.4, 0.0), Vec3(0.5, 2.5, 0.5), 0.15, {60, 61, 62}});
    const AovFrame frame = made(scene);
    const WorldView view(scene);
    const Vec3 from(0.5, 2.5, 0.5), to(0.0, 0.6, 0.0), axis = (to - from).normalized();
    int pixels = 0, of_end = 0;
    for_pixels(scene, [&](std::size_t pixel, int column, int row) {
        if (frame.segmentation[pixel] != 2) return;
        ++pixels;
        const Vec3 p = view.ray(column, row).at(frame.depth[pixel]) - from;
        const double along = axis.dot(p);
        const Vec3 out = p - along * axis;
        if ((normal_at(frame, pixel) + axis).norm() < 2e-5) {  // the upper end
            ++of_end;
            EXPECT_NEAR(along, 0.0, 1e-6);
            EXPECT_LE(out.norm(), 0.15 + 1e-6);
            return;
        }
        EXPECT_NEAR(out.norm(), 0.15, 2e-6);
        EXPECT_GE(along, -1e-6);
        EXPECT_LE(along, (to - from).norm() + 1e-6);
        EXPECT_LT((normal_at(frame, pixel) - out / 0.15).norm(), 2e-5);
        EXPECT_EQ(frame.albedo[3 * pixel], 60);
    });
    EXPECT_GT(pixels, 300);
    EXPECT_GT(of_end, 3);
}

TEST(AovSurface, ArraysThatAreNotRequestedStayEmpty) {
    SceneDescription scene = empty_scene();
    scene.bodies = {ground_plane()};
    AovSet depth;
    depth.add(Aov::depth);
    const AovFrame frame = AovRenderer(scene, depth).make({first_snapshot(scene), std::nullopt});
    EXPECT_EQ(frame.depth.size(), 320u * 180u);
    EXPECT_TRUE(frame.normal.empty() && frame.segmentation.empty() && frame.motion.empty() && frame.albedo.empty());
    EXPECT_EQ(frame.depth, made(scene).depth);
}

}  // namespace
}  // namespace tumble::aov_surface_test
