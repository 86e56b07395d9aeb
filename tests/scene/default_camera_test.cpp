#include "scene/camera/default_camera.h"
#include "scene/load.h"
#include "sim/geometry/shapes/shape.h"

#include <gtest/gtest.h>

#include <cmath>

namespace tumble::default_camera_test {
namespace {

BodyDescription box_at(const Vec3& position, const Vec3& size, BodyType type = BodyType::dynamic) {
    BodyDescription body;
    body.type = type;
    body.shape = BoxShape{size};
    body.position = position;
    return body;
}

BodyDescription ground() {
    BodyDescription body;
    body.type = BodyType::fixed;
    body.shape = PlaneShape{};
    return body;
}

/// Position of a point in the image: within +-1 in both directions if it is visible; third, its depth.
Vec3 in_picture(const SceneDescription& scene, const CameraDescription& camera, const Vec3& p) {
    const Vec3 forward = (camera.target - camera.eye).normalized();
    const Vec3 right = forward.cross(camera.up).normalized(), up = right.cross(forward);
    const Vec3 d = p - camera.eye;
    const double tangent = std::tan(camera.vertical_fov * M_PI / 360.0);
    const double aspect = double(scene.output.width) / scene.output.height;
    return {d.dot(right) / d.dot(forward) / tangent / aspect, d.dot(up) / d.dot(forward) / tangent, d.dot(forward)};
}

/// The largest part of the half image that corners of bodies reach.
double used(const SceneDescription& scene, const CameraDescription& camera) {
    double most = 0.0;
    for (const BodyDescription& body : scene.bodies) {
        if (std::holds_alternative<PlaneShape>(body.shape)) continue;
        const Bounds b = local_bounds(body.shape);
        for (int i = 0; i < 8; ++i) {
            const Vec3 corner(i & 1 ? b.max.x() : b.min.x(), i & 2 ? b.max.y() : b.min.y(),
                              i & 4 ? b.max.z() : b.min.z());
            const Vec3 at = in_picture(scene, camera, body.position + body.rotation * corner);
            EXPECT_GT(at.z(), 0.0);
            most = std::max({most, std::fabs(at.x()), std::fabs(at.y())});
        }
    }
    return most;
}

TEST(DefaultCamera, FillsThePictureAtAnyScale) {
    for (const double scale : {1e-3, 1.0, 1e3}) {
        for (const int width : {200, 1280, 3000}) {
            SceneDescription scene;
            scene.output.width = width;
            scene.output.height = 720;
            scene.bodies = {box_at(Vec3(1, 5, 2) * scale, Vec3(1, 2, 3) * scale),
                            box_at(Vec3(-4, 1, 0) * scale, Vec3(1, 1, 1) * scale)};
            const CameraDescription camera = default_camera(scene, {});
            EXPECT_LE(used(scene, camera), 0.95) << scale << " " << width;
            EXPECT_GE(used(scene, camera), 0.7) << scale << " " << width;
        }
    }
}

TEST(DefaultCamera, LeavesAsMuchRoomAboveAsBelow) {
    SceneDescription scene;  // a long row: its width determines the distance, with space above and below
    for (int i = -20; i <= 20; ++i) scene.bodies.push_back(box_at(Vec3(i, 0.5, -0.3 * i), {1, 1, 1}));
    const CameraDescription camera = default_camera(scene, {});
    double top = -1e9, bottom = 1e9, left = 1e9, right = -1e9;
    for (const BodyDescription& body : scene.bodies) {
        for (int i = 0; i < 8; ++i) {
            const Vec3 corner(i & 1 ? 0.5 : -0.5, i & 2 ? 0.5 : -0.5, i & 4 ? 0.5 : -0.5);
            const Vec3 at = in_picture(scene, camera, body.position + corner);
            top = std::max(top, at.y()), bottom = std::min(bottom, at.y());
            right = std::max(right, at.x()), left = std::min(left, at.x());
        }
    }
    EXPECT_NEAR(top + bottom, 0.0, 0.02);
    EXPECT_NEAR(left + right, 0.0, 0.02);
    EXPECT_LE(right, 0.9);
}

TEST(DefaultCamera, LooksDownAtTheScene) {
    SceneDescription scene;
    scene.bodies = {ground(), box_at({0, 0.5, 0}, {1, 1, 1})};
    const CameraDescription camera = default_camera(scene, {});
    EXPECT_GT(camera.eye.y(), camera.target.y());
    EXPECT_GT(camera.eye.z(), camera.target.z());  // from the front
    EXPECT_LT((camera.eye - camera.target).norm(), 10.0);
}

TEST(DefaultCamera, ShowsTheGroundBeneathAFallingBody) {
    SceneDescription scene;
    scene.bodies = {ground(), box_at({3, 20, 0}, {1, 1, 1})};
    const CameraDescription camera = default_camera(scene, {});
    const Vec3 foot = in_picture(scene, camera, {3, 0, 0});
    EXPECT_LT(std::fabs(foot.x()), 1.0);
    EXPECT_LT(std::fabs(foot.y()), 1.0);
    EXPECT_LE(used(scene, camera), 1.0);
}

TEST(DefaultCamera, ShowsTheWholePathOfAKinematicBody) {
    SceneDescription scene;
    BodyDescription body = box_at({0, 0, 0}, {1, 1, 1}, BodyType::kinematic);
    body.keyframes = {{0.0, {0, 0, 0}, Quat::Identity()}, {1.0, {30, 0, 0}, Quat::Identity()}};
    scene.bodies = {body};
    const CameraDescription camera = default_camera(scene, {});
    EXPECT_LT(std::fabs(in_picture(scene, camera, {30.5, 0, 0}).x()), 1.0);
}

// A frictionless box thrown at 45 degrees, up and along x: x = v t, y = v t - g t^2 / 2, until it slides on at y = 0.5.
TEST(DefaultCamera, ShowsTheTrajectoryOfAThrownBody) {
    constexpr double v = 8.0, g = 9.81;
    SceneDescription scene;
    scene.bodies = {ground(), box_at({0, 0.5, 0}, {1, 1, 1})};
    for (BodyDescription& body : scene.bodies) body.restitution = 0.0;
    scene.bodies[1].velocity = Vec3(v, v, 0.0);
    const CameraDescription camera = default_camera(scene, {}, 3.0);
    const auto shown = [&](const Vec3& p) {
        const Vec3 at = in_picture(scene, camera, p);
        return std::fabs(at.x()) < 1.0 && std::fabs(at.y()) < 1.0 && at.z() > 0.0;
    };
    const double apex = v / g, landing = 2.0 * apex;
    for (const double t : {0.0, 0.5 * apex, apex, landing, 3.0})
        EXPECT_TRUE(shown({v * t, 0.5 + std::max(0.0, v * t - 0.5 * g * t * t), 0.0})) << t << " s";
    EXPECT_FALSE(shown({1.4 * v * 3.0, 0.5, 0.0})) << "but not much more";
    EXPECT_TRUE(default_camera(scene, {}).eye.isApprox(default_camera(scene, {}, 0.0).eye));
}

TEST(DefaultCamera, TrajectoriesEndAtOtherBodiesAndByFriction) {
    SceneDescription stopped;  // by a pile in its path, 6 m ahead
    stopped.bodies = {ground(), box_at({0, 0.5, 0}, {1, 1, 1}), box_at({6, 1, 0}, {2, 2, 2})};
    const double near = default_camera(stopped, {}).eye.norm();
    stopped.bodies[1].velocity = Vec3(10.0, 0.0, 0.0);
    EXPECT_LT(default_camera(stopped, {}, 5.0).eye.norm(), 1.4 * near);
    stopped.bodies.pop_back();
    EXPECT_GT(default_camera(stopped, {}, 5.0).eye.norm(), 3.0 * near);

    SceneDescription rubbed = stopped;  // v^2 / (2 mu g) = 5.1 m
    for (BodyDescription& body : rubbed.bodies) body.friction = 1.0, body.restitution = 0.0;
    const CameraDescription camera = default_camera(rubbed, {}, 5.0);
    EXPECT_LT(std::fabs(in_picture(rubbed, camera, {5.1, 0.5, 0}).x()), 1.0);
    EXPECT_GT(std::fabs(in_picture(rubbed, camera, {10.0, 0.5, 0}).x()), 1.0);

    SceneDescription walled = stopped;  // back from a fixed wall 4 m ahead
    walled.bodies.push_back(box_at({4, 1, 0}, {0.2, 2, 4}, BodyType::fixed));
    EXPECT_GT(std::fabs(in_picture(walled, default_camera(walled, {}, 5.0), {25.0, 0.5, 0}).x()), 1.0);
}

// A bullet leaves: bodies would be invisible in an image of its whole trajectory.
TEST(DefaultCamera, IgnoresBodiesThatFlyFarAway) {
    SceneDescription scene;
    scene.bodies = {ground(), box_at({0, 0.5, 0}, {1, 1, 1})};
    scene.bodies[1].velocity = Vec3(900.0, 0.0, 0.0);
    EXPECT_LT(default_camera(scene, {}, 5.0).eye.norm(), 200.0);
}

// Frame n is the same for any length of the clip.
TEST(DefaultCamera, DoesNotDependOnTheCommandLinesDuration) {
    const std::string text = "format = 1\n[[body]]\nshape = { type = \"sphere\", radius = 1 }\nvelocity = [5, 0, 0]\n";
    SceneOverrides shorter;
    shorter.duration = 0.0;
    EXPECT_EQ(parse_scene(text, "a.toml", shorter).camera.eye, parse_scene(text, "a.toml").camera.eye);
    const auto in_file = parse_scene(text + "[simulation]\nduration = 0\n", "a.toml");
    EXPECT_LT(in_file.camera.eye.norm(), 0.5 * parse_scene(text, "a.toml").camera.eye.norm());
    const auto followed = parse_scene(text + "name = \"ball\"\n[camera]\nfollow = \"ball\"\n", "a.toml");
    EXPECT_TRUE((followed.camera.eye - followed.camera.target).isApprox(in_file.camera.eye - in_file.camera.target));
}

/// True if the line of sight from the eye to the point passes over the rim of a bin of this half width and height.
bool over_the_rim(const Vec3& eye, const Vec3& point, double half, double height) {
    const double rises = (height - point.y()) / (eye.y() - point.y());  // part of the way up to the eye
    const Vec3 at = point + rises * (eye - point);
    return std::fabs(at.x()) < half && std::fabs(at.z()) < half;
}

// Bodies that fall into a bin, made of boxes or of one mesh, are visible at rest.
TEST(DefaultCamera, LooksIntoContainers) {
    SceneDescription bin;
    bin.bodies = {ground(), box_at({2, 1, 0}, {0.2, 2, 4}, BodyType::fixed),
                  box_at({-2, 1, 0}, {0.2, 2, 4}, BodyType::fixed), box_at({0, 1, 2}, {4, 2, 0.2}, BodyType::fixed),
                  box_at({0, 1, -2}, {4, 2, 0.2}, BodyType::fixed)};
    for (const double x : {-1.0, 0.0, 1.0})
        for (const double z : {-1.0, 0.0, 1.0}) bin.bodies.push_back(box_at({x, 5.0, z}, Vec3::Constant(0.5)));
    EXPECT_TRUE(over_the_rim(default_camera(bin, {}).eye, {0.0, 0.25, 0.0}, 1.9, 2.0));

    const Vec3 before = default_camera(bin, {}).eye;
    for (BodyDescription& body : bin.bodies)
        if (body.type == BodyType::fixed) body.appearance.visible = false;  // nothing hides the bodies
    EXPECT_FALSE(over_the_rim(default_camera(bin, {}).eye, {0.0, 0.25, 0.0}, 1.9, 2.0));
    EXPECT_LT(default_camera(bin, {}).eye.y() / default_camera(bin, {}).eye.norm(), 0.8 * before.y() / before.norm());

    auto tube = std::make_shared<MeshAsset>();  // four upright sides, open
    for (const double y : {0.0, 2.0})
        for (const auto& [x, z] : {std::pair(-2.0, -2.0), {2.0, -2.0}, {2.0, 2.0}, {-2.0, 2.0}})
            tube->mesh.vertices.push_back({x, y, z});
    for (std::uint32_t i = 0; i < 4; ++i) {
        const std::uint32_t next = (i + 1) % 4;
        tube->mesh.triangles.push_back({i, next, next + 4});
        tube->mesh.triangles.push_back({i, next + 4, i + 4});
    }
    SceneDescription mesh;
    mesh.bodies = {ground(), BodyDescription{}, box_at({0.0, 5.0, 0.0}, Vec3::Constant(0.5))};
    mesh.bodies[1].type = BodyType::fixed;
    mesh.bodies[1].shape = MeshShape{tube};
    EXPECT_TRUE(over_the_rim(default_camera(mesh, {}).eye, {0.0, 0.25, 0.0}, 2.0, 2.0));
    mesh.bodies[1].position.x() = 50.0;
    EXPECT_LT(default_camera(mesh, {}).eye.y(), 0.5 * default_camera(mesh, {}).eye.norm()) << "it holds nothing";
}

TEST(DefaultCamera, AWideFloorMadeOfABoxDoesNotPushItAway) {
    SceneDescription scene;
    scene.bodies = {box_at({0, -0.5, 0}, {500, 1, 500}, BodyType::fixed), box_at({0, 2, 0}, {1, 1, 1})};
    EXPECT_LT((default_camera(scene, {}).eye).norm(), 30.0);
}

TEST(DefaultCamera, AFixedBodyBesideMovingOnesIsInView) {
    SceneDescription scene;
    scene.bodies = {box_at({9, 1, 0}, {2, 2, 2}, BodyType::fixed), box_at({0, 2, 0}, {1, 1, 1})};
    EXPECT_LE(used(scene, default_camera(scene, {})), 1.0);
}

TEST(DefaultCamera, StandsSomewhereSensibleWithoutBodies) {
    for (const bool with_ground : {false, true}) {
        SceneDescription scene;
        if (with_ground) scene.bodies = {ground()};
        const CameraDescription camera = default_camera(scene, {});
        EXPECT_TRUE(camera.eye.allFinite());
        EXPECT_GT(camera.eye.y(), 0.5);
        EXPECT_LT(camera.eye.norm(), 30.0);
    }
}

TEST(DefaultCamera, FollowsTheLens) {
    SceneDescription scene;
    scene.bodies = {box_at({0, 0, 0}, {1, 1, 1})};
    for (const Vec3& up : {Vec3(0, 0, 1), Vec3(1, 0, 0), Vec3(0, -1, 0)}) {
        CameraDescription lens;
        lens.up = up;
        lens.vertical_fov = 20.0;
        const CameraDescription camera = default_camera(scene, lens);
        EXPECT_GT((camera.eye - camera.target).dot(up), 0.0);
        EXPECT_LE(used(scene, camera), 0.95);
    }
}

TEST(DefaultCamera, FillsInMissingKeys) {
    const std::string body = "\n[[body]]\nshape = { type = \"sphere\", radius = 1 }\nposition = [5, 0, 0]\n";
    const auto whole = parse_scene("format = 1" + body, "a.toml").camera;
    const auto eye = parse_scene("format = 1\n[camera]\neye = [0, 0, 50]" + body, "a.toml").camera;
    EXPECT_EQ(eye.eye, Vec3(0, 0, 50));
    EXPECT_EQ(eye.target, whole.target);
    const auto target = parse_scene("format = 1\n[camera]\ntarget = [0, 0, 0]" + body, "a.toml").camera;
    EXPECT_TRUE(target.eye.isApprox(whole.eye - whole.target, 1e-12));
}

}  // namespace
}  // namespace tumble::default_camera_test
