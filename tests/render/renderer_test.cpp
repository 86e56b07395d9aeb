// Places of bodies in the image, equality of images in every run and with every backend, and gradients without bands.
#include "drawing.h"
#include "example_scenes.h"

#include "core/error.h"

#include <gtest/gtest.h>

#include <cstdlib>
#include <memory>
#include <set>
#include <vector>

namespace tumble::renderer_test {
namespace {

SceneDescription mixed_scene() {
    SceneDescription scene = empty_scene();
    scene.camera.eye = Vec3(2.0, 2.0, 6.0);
    scene.camera.target = Vec3(0.0, 0.5, 0.0);
    const Quat tilt(Eigen::AngleAxisd(0.4, Vec3(1.0, 1.0, 0.0).normalized()));
    scene.bodies = {ground_plane(), box_body(Vec3(0.0, 0.5, 0.0), Vec3::Ones(), {200, 133, 60}),
                    box_body(Vec3(-0.2, 1.4, 0.1), Vec3(0.8, 0.6, 0.7), {60, 133, 200}, tilt),
                    ball_body(Vec3(1.2, 0.4, 0.8), 0.4, {80, 180, 90}, tilt),
                    mesh_body(Vec3(-1.4, 0.25, 1.0), torus_asset(0.5, 0.2), {210, 80, 90})};
    scene.cords.push_back({3, Vec3::Zero(), Vec3(1.2, 3.0, 0.8), 0.02, {60, 60, 60}});
    return scene;
}

TEST(Renderer, DrawsTheSameBytesTwice) {
    const SceneDescription scene = mixed_scene();
    const Snapshot snapshot = first_snapshot(scene);
    Renderer first(scene);
    const Image once = first.render(snapshot);
    EXPECT_EQ(first.render(snapshot), once) << "a frame depends on the one before";
    EXPECT_EQ(once, drawn(scene)) << "a renderer depends on the one before";
}

TEST(Renderer, DoesNotRememberOtherFrames) {
    const SceneDescription scene = mixed_scene();
    Snapshot away = first_snapshot(scene);
    for (std::size_t i = 1; i < away.bodies.size(); ++i) away.bodies[i].origin += Vec3(3.0, 40.0, 2.0) * double(i);
    Renderer renderer(scene);
    renderer.render(away);
    EXPECT_EQ(renderer.render(first_snapshot(scene)), drawn(scene));
}

TEST(Renderer, TwoInOneThreadKeepApart) {
    const SceneDescription scene = mixed_scene();
    const Image alone = drawn(scene);
    auto first = std::make_unique<Renderer>(scene, RenderOptions{});
    Renderer second(scene);
    EXPECT_EQ(first->render(first_snapshot(scene)), alone) << "the first, after the second was made";
    first.reset();
    EXPECT_EQ(second.render(first_snapshot(scene)), alone) << "the second, after the first was destroyed";
}

TEST(Renderer, EglDrawsTheSameBytesAsOsmesa) {
    for (const int samples : {1, 4}) {
        SceneDescription scene = mixed_scene();
        scene.output.samples = samples;
        std::unique_ptr<Renderer> egl;
        try {
            egl = std::make_unique<Renderer>(scene, RenderOptions{GlBackend::egl, {}});
        } catch (const RunError& failure) {
            GTEST_SKIP() << "no EGL here: " << failure.what();
        }
        if (egl->driver().find("llvmpipe") == std::string::npos) GTEST_SKIP() << "EGL draws with " << egl->driver();
        const Image image = egl->render(first_snapshot(scene));
        egl.reset();
        EXPECT_EQ(image, drawn(scene)) << samples << " samples";
    }
}

// Each part is where the body's pose places it, in its own color, and looks like a body of its own.
TEST(Renderer, DrawsAllPartsOfABody) {
    SceneDescription scene = empty_scene();
    const Quat quarter(Eigen::AngleAxisd(0.5 * EIGEN_PI, Vec3::UnitZ()));
    CompoundPart left, right;
    left.shape = SphereShape{0.5};
    left.position = Vec3(0.0, 1.5, 0.0);  // rotated by the body: to the left
    right.shape = BoxShape{Vec3(0.6, 1.0, 1.0)};
    right.position = Vec3(0.0, -1.5, 0.0);
    right.rotation = Quat(Eigen::AngleAxisd(0.3, Vec3::UnitY()));
    right.color = Color{30, 30, 220};
    BodyDescription body = box_body(Vec3(0.0, 1.0, 0.0), Vec3::Ones(), {220, 30, 30}, quarter);
    body.shape = CompoundShape{std::make_shared<const std::vector<CompoundPart>>(std::vector{left, right})};
    scene.bodies = {ground_plane(), body, ball_body(Vec3(0.0, 2.5, 0.0), 0.3, {30, 220, 30})};
    scene.cords.push_back({2, Vec3::Zero(), Vec3(0.0, 4.0, 0.0), 0.02, {60, 60, 60}});
    const Image image = drawn(scene);
    const auto color_at = [&](const Vec3& point) {
        const Pixel p = pixel_of(scene, point);
        return image.at(p.x, p.y);
    };
    EXPECT_GT(color_at(Vec3(-1.5, 1.0, 0.5))[0], 2 * color_at(Vec3(-1.5, 1.0, 0.5))[2]);
    EXPECT_GT(color_at(Vec3(1.5, 1.0, 0.5))[2], 2 * color_at(Vec3(1.5, 1.0, 0.5))[0]);

    SceneDescription apart = scene;
    BodyDescription ball = body, box = body;
    ball.shape = left.shape;
    ball.position = Vec3(-1.5, 1.0, 0.0);
    box.shape = right.shape;
    box.position = Vec3(1.5, 1.0, 0.0);
    box.rotation = quarter * right.rotation;
    box.appearance.color = *right.color;
    apart.bodies = {ground_plane(), ball, box, scene.bodies[2]};
    apart.cords[0].body = 3;
    const Image other = drawn(apart);
    std::size_t different = 0;
    for (int y = 0; y < image.height; ++y)
        for (int x = 0; x < image.width; ++x)
            for (int c = 0; c < 3; ++c) different += std::abs(image.at(x, y)[c] - other.at(x, y)[c]) > 2;
    EXPECT_LT(different, 30u) << "but for the rounding of poses the pictures are the same";
}

// The anchor is a point of the compound, which is drawn as two bodies.
TEST(Renderer, DrawsACordBetweenTwoBodies) {
    SceneDescription scene = mixed_scene();
    CompoundPart part;
    part.shape = SphereShape{0.2};
    part.position = Vec3(0.3, 0.1, 0.0);
    part.rotation = Quat(Eigen::AngleAxisd(0.5, Vec3::UnitX()));
    BodyDescription body =
        box_body(Vec3(1.0, 2.0, 0.5), Vec3::Ones(), {220, 30, 30}, Quat(Eigen::AngleAxisd(0.7, Vec3::UnitZ())));
    body.shape = CompoundShape{std::make_shared<const std::vector<CompoundPart>>(std::vector{part, part})};
    scene.bodies.push_back(body);
    const Vec3 point(-0.4, 0.2, 0.1);
    SceneDescription fixed = scene;
    fixed.cords[0].anchor = body.position + body.rotation * point;
    scene.cords[0].anchor = point;
    scene.cords[0].anchor_body = scene.bodies.size() - 1;
    const Image image = drawn(scene), other = drawn(fixed);
    std::size_t different = 0;
    for (int y = 0; y < image.height; ++y)
        for (int x = 0; x < image.width; ++x)
            for (int c = 0; c < 3; ++c) different += std::abs(image.at(x, y)[c] - other.at(x, y)[c]) > 2;
    EXPECT_LT(different, 10u) << "but for the rounding of poses the pictures are the same";

    Snapshot moved = first_snapshot(scene);
    moved.bodies.back().origin += Vec3(-1.0, 0.5, 0.0);
    Renderer renderer(scene);
    const Image before = renderer.render(first_snapshot(scene));
    EXPECT_EQ(renderer.render(moved), Renderer(scene).render(moved)) << "the cord moves with its anchor";
    EXPECT_NE(renderer.render(moved), before);
}

TEST(Renderer, NamesItsDriver) {
    Renderer renderer(empty_scene());
    EXPECT_NE(renderer.driver().find("OpenGL"), std::string::npos) << renderer.driver();
}

TEST(Renderer, HasTheSkyAboveTheGroundAndTopRowFirst) {
    SceneDescription scene = empty_scene();
    scene.bodies = {box_body(Vec3(0.0, 2.0, 0.0), Vec3::Ones(), {220, 30, 30}),
                    box_body(Vec3(0.0, 0.0, 0.0), Vec3::Ones(), {30, 30, 220}),
                    box_body(Vec3(1.5, 1.0, 0.0), Vec3::Ones(), {30, 220, 30})};
    const Image image = drawn(scene);
    ASSERT_EQ(image.width, 320);
    ASSERT_EQ(image.height, 180);
    const std::uint8_t *above = image.at(160, 90 - 31), *below = image.at(160, 90 + 31),
                       *right = image.at(160 + 46, 90);
    EXPECT_GT(above[0], above[2] + 40);
    EXPECT_GT(below[2], below[0] + 40);
    EXPECT_GT(right[1], right[0] + 40);
    EXPECT_EQ(above[3], 255);
}

// The pinhole formula of camera.h: the center of a small ball is at the predicted pixel.
TEST(Renderer, FollowsThePinholeFormula) {
    SceneDescription scene = empty_scene();
    scene.camera.eye = Vec3(3.0, 2.5, 5.0);
    scene.camera.target = Vec3(0.2, 0.4, -0.3);
    scene.light.shadows = false;
    const Vec3 f = (scene.camera.target - scene.camera.eye).normalized(), r = f.cross(Vec3::UnitY()).normalized();
    const Vec3 u = r.cross(f);
    const double t = std::tan(0.5 * scene.camera.vertical_fov * 3.14159265358979 / 180.0), aspect = 320.0 / 180.0;
    for (const Vec3& p : {Vec3(0.0, 0.0, 0.0), Vec3(-1.5, 1.2, -0.5), Vec3(1.0, -0.4, 1.0), Vec3(-3.0, 0.0, -4.0)}) {
        scene.bodies = {ball_body(p, 0.06, {250, 0, 0})};
        const Image image = drawn(scene);
        double sum = 0.0, x = 0.0, y = 0.0;
        for (int row = 0; row < image.height; ++row)
            for (int column = 0; column < image.width; ++column) {
                const std::uint8_t* c = image.at(column, row);
                const double redness = std::max(0.0, double(c[0]) - double(c[2]));
                sum += redness;
                x += redness * (column + 0.5);
                y += redness * (row + 0.5);
            }
        ASSERT_GT(sum, 100.0);
        const Vec3 d = p - scene.camera.eye;
        EXPECT_NEAR(x / sum, 160.0 * (1.0 + d.dot(r) / (aspect * t * d.dot(f))), 1.0);
        EXPECT_NEAR(y / sum, 90.0 * (1.0 - d.dot(u) / (t * d.dot(f))), 1.0);
    }
}

TEST(Renderer, FarFromTheOriginDrawsTheSame) {
    SceneDescription scene = mixed_scene();
    scene.cords.clear();
    const Image here = drawn(scene), there = drawn(moved(scene, Vec3(4e6, 0.0, -2e6)));  // whole cells of the grid
    int different = 0;
    for (std::size_t i = 0; i < here.pixels.size(); ++i)
        different += std::abs(int(here.pixels[i]) - int(there.pixels[i])) > 8 ? 1 : 0;
    EXPECT_LT(different, 150) << "of " << here.pixels.size();
}

// With white bodies before black, a pixel is the covered share of its samples.
TEST(Renderer, AveragesTheSamplesOfAPixel) {
    ShaderCopy shaders;
    shaders.replace("box.frag", "pixel = ", "pixel = vec4(1.0); // ");
    shaders.replace("sky.frag", "pixel = ", "pixel = vec4(0.0, 0.0, 0.0, 1.0); // ");
    SceneDescription scene = empty_scene();
    scene.bodies = {box_body(Vec3(0.0, 1.0, 0.0), Vec3(2.0, 2.0, 2.0), {255, 255, 255},
                             Quat(Eigen::AngleAxisd(0.3, Vec3::UnitZ())))};
    for (const int samples : {1, 4}) {  // llvmpipe has no other numbers: 2 are drawn as 4
        scene.output.samples = samples;
        RenderSwitches options = shaders.options();
        options.multisample = true;
        const Image image = drawn(scene, options);
        std::set<int> values;
        for (std::size_t i = 0; i < image.pixels.size(); i += 4) values.insert(image.pixels[i]);
        EXPECT_EQ(int(values.size()), samples + 1);
        for (const int value : values) {
            const double covered = value * samples / 255.0;
            EXPECT_NEAR(covered, std::round(covered), 0.02) << value;
        }
    }
}

TEST(Renderer, HidesInvisibleBodiesAndDrawsNothingBehindTheEye) {
    SceneDescription scene = empty_scene();
    const Image nothing = drawn(scene);
    scene.bodies = {box_body(Vec3(0.0, 1.0, 0.0), Vec3::Ones(), {200, 30, 30}),
                    box_body(Vec3(0.0, 1.0, 16.0), Vec3::Ones(), {200, 30, 30})};
    scene.bodies[0].appearance.visible = false;
    EXPECT_EQ(drawn(scene), nothing);
}

TEST(Renderer, TurnsWithTheBody) {
    SceneDescription scene = empty_scene();
    scene.bodies = {box_body(Vec3(0.0, 1.0, 0.0), Vec3(4.0, 0.4, 0.4), {220, 30, 30},
                             Quat(Eigen::AngleAxisd(1.5707963267948966, Vec3::UnitZ())))};
    const Image image = drawn(scene);
    const auto red = [&](int x, int y) { return image.at(x, y)[0] > image.at(x, y)[2] + 60; };
    EXPECT_TRUE(red(160, 90 - 45));
    EXPECT_TRUE(red(160, 90 + 45));
    EXPECT_FALSE(red(160 - 45, 90));
}

TEST(Renderer, RefusesAPictureThatTheDriverCannotHold) {
    SceneDescription scene = empty_scene();
    scene.output.width = 1 << 20;
    EXPECT_THROW(Renderer(scene, RenderOptions{}), RunError);
}

// The means of 8 x 8 pixels down the middle of the picture, in levels of green.
std::vector<double> block_means(const Image& image) {
    std::vector<double> means;
    for (int top = 0; top + 8 <= image.height; top += 8) {
        double sum = 0.0;
        for (int y = top; y < top + 8; ++y)
            for (int x = image.width / 2; x < image.width / 2 + 8; ++x) sum += image.at(x, y)[1];
        means.push_back(sum / 64.0);
    }
    return means;
}

// A gradient of some levels over the whole image: rounded to the nearest level, it would have visible bands.
TEST(Renderer, SkyAndGroundHaveNoBands) {
    SceneDescription sky = empty_scene(), ground = empty_scene();
    sky.camera.target = Vec3(0.0, 3.0, 0.0);
    ground.bodies = {ground_plane({185, 188, 194}, Pattern::plain)};
    ground.camera.target = Vec3(0.0, -0.2, 0.0);
    for (SceneDescription* scene : {&sky, &ground}) {
        scene->output.width = 640;
        scene->output.height = 360;
        scene->camera.vertical_fov = scene == &sky ? 5.0 : 12.0;
        const std::vector<double> means = block_means(drawn(*scene));
        EXPECT_GT(std::abs(means.back() - means.front()), 1.5) << "there must be steps to see";
        EXPECT_LT(std::abs(means.back() - means.front()), 30.0) << "they must be wide";
        for (std::size_t i = 1; i + 1 < means.size(); ++i)
            EXPECT_NEAR(means[i - 1] - 2.0 * means[i] + means[i + 1], 0.0, 0.3)
                << (scene == &sky ? "sky" : "ground") << ", row " << 8 * i;
    }
}

}  // namespace
}  // namespace tumble::renderer_test
