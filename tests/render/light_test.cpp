// Light: colors are as given, shadows are at the geometric place, contacts are dark.
#include "drawing.h"
#include "example_scenes.h"
#include "random.h"

#include <gtest/gtest.h>

#include <cmath>

namespace tumble::light_test {
namespace {

SceneDescription shadow_scene() {
    SceneDescription scene = empty_scene();
    scene.output.width = 640;
    scene.output.height = 360;
    scene.camera.eye = Vec3(0.0, 5.0, 9.0);
    scene.camera.target = Vec3(0.0, 0.5, 0.0);
    scene.light.direction = Vec3(-0.5, -1.0, 0.0);
    scene.bodies = {ground_plane({190, 190, 190}, Pattern::plain),
                    box_body(Vec3(0.0, 2.0, 0.0), Vec3::Ones(), {200, 133, 60})};
    return scene;
}

// Levels that body 1 takes at each place: the image without it less the image with it.
std::vector<double> levels_taken(const SceneDescription& scene, const std::vector<Vec3>& places) {
    SceneDescription open = scene;
    open.bodies[1].appearance.visible = false;
    const Image without = drawn(open), with = drawn(scene);
    std::vector<double> levels;
    for (const Vec3& at : places) levels.push_back(brightness_at(without, scene, at) - brightness_at(with, scene, at));
    return levels;
}

// Without shading, the color on the screen is the scene file's: decoded and encoded exactly once.
TEST(Light, UnlitColorsComeBackAsGiven) {
    ShaderCopy shaders;
    shaders.replace("box.frag", "pixel = ", "pixel = vec4(displayed(v_diffuse), 1.0); // ");
    for (const Color color :
         {Color{0x10, 0x40, 0x80}, Color{0xc8, 0x85, 0x3c}, Color{0xc0, 0xc0, 0x05}, Color{0, 30, 200}}) {
        SceneDescription scene = empty_scene();
        scene.bodies = {box_body(Vec3(0.0, 1.0, 0.0), Vec3::Ones(), color)};
        const Image image = drawn(scene, shaders.options());
        const std::uint8_t* pixel = image.at(160, 90);
        EXPECT_NEAR(pixel[0], color.r, 1);
        EXPECT_NEAR(pixel[1], color.g, 1);
        EXPECT_NEAR(pixel[2], color.b, 1);
    }
}

TEST(Light, AFaceInTheSunLooksLikeItsColor) {
    SceneDescription scene = empty_scene();
    scene.camera.eye = Vec3(0.0, 4.0, 4.0);
    scene.camera.target = Vec3(0.0, 0.0, 0.0);
    scene.light.direction = Vec3(0.3, -1.0, -0.2);
    scene.bodies = {box_body(Vec3(0.0, -0.5, 0.0), Vec3(3.0, 1.0, 3.0), {0xc8, 0x85, 0x3c})};
    const Image image = drawn(scene);
    const std::uint8_t* pixel = image.at(160, 80);
    EXPECT_NEAR(pixel[0], 0xc8, 20);
    EXPECT_NEAR(pixel[1], 0x85, 20);
    EXPECT_NEAR(pixel[2], 0x3c, 32);
}

// The box spans x -0.5 .. 0.5 and y 1.5 .. 2.5; light (-0.5, -1, 0) maps a point at height y to x - y / 2. Its shadow
// on the ground is x in (-0.5 - 1.25, 0.5 - 0.75) = (-1.75, -0.25), z in (-0.5, 0.5).
TEST(Light, AShadowLiesWhereGeometryPutsIt) {
    const SceneDescription scene = shadow_scene();
    const Image image = drawn(scene);
    const double bright = brightness_at(image, scene, Vec3(1.5, 0.0, 1.5));
    for (const Vec3& inside : {Vec3(-1.0, 0, 0), Vec3(-1.69, 0, 0), Vec3(-0.31, 0, 0), Vec3(-1.0, 0, 0.44)})
        EXPECT_LT(brightness_at(image, scene, inside), 0.75 * bright) << inside.transpose();
    for (const Vec3& outside : {Vec3(-1.81, 0, 0), Vec3(-0.19, 0, 0), Vec3(-1.0, 0, 0.56), Vec3(-1.0, 0, -0.56)})
        EXPECT_GT(brightness_at(image, scene, outside), 0.97 * bright) << outside.transpose();
}

// Largest difference between two images of a ground at y = 0, in levels, within `reach` of a point of it.
int most_difference(const Image& a, const Image& b, const SceneDescription& scene, const Vec3& around, double reach) {
    int most = 0;
    for (double x = -reach; x <= reach; x += 0.02 * reach)
        for (double z = -reach; z <= reach; z += 0.02 * reach) {
            const Pixel at = pixel_of(scene, around + Vec3(x, 0.0, z));
            for (int channel = 0; channel < 3; ++channel)
                most = std::max(most, std::abs(a.at(at.x, at.y)[channel] - b.at(at.x, at.y)[channel]));
        }
    return most;
}

// The sun must not shine on the undersides of bodies through the ground.
TEST(Light, ASunBelowTheGroundLightsNothing) {
    SceneDescription scene = shadow_scene();
    scene.bodies.push_back(ball_body(Vec3(-2.0, 1.5, 0.0), 0.5, {60, 130, 200}));
    scene.bodies.push_back(box_body(Vec3(2.0, 1.5, 0.0), Vec3::Ones(), {200, 160, 60},
                                    Quat(Eigen::AngleAxisd(0.6, Vec3(1.0, 0.0, 1.0).normalized()))));
    scene.bodies.back().appearance.metallic = 1.0;
    const auto with_sun = [&](const Vec3& direction) {
        scene.light.direction = direction;
        return drawn(scene);
    };
    const Vec3 above(-0.5, -0.2, -0.4);
    const Image day = with_sun(above), dark = with_sun(Vec3(0.3, 1.0, -0.4));
    EXPECT_GT(brightness_at(day, scene, Vec3(0.0, 2.0, 0.5)), 1.3 * brightness_at(dark, scene, Vec3(0.0, 2.0, 0.5)));
    EXPECT_EQ(with_sun(Vec3(-0.7, 0.1, -0.5)), dark) << "from wherever it shines not";
    scene.bodies[0].rotation =
        Quat(Eigen::AngleAxisd(0.9, Vec3::UnitX()));  // rises towards -z, from where no light comes
    EXPECT_EQ(with_sun(Vec3(0.2, -0.5, 1.0)), with_sun(Vec3(0.0, 0.3, 1.0)));
    std::get<PlaneShape>(scene.bodies[0].shape).normal = Vec3::UnitZ();  // a wall, 8 m behind the bodies
    scene.bodies[0].rotation = Quat::Identity();
    scene.bodies[0].position.z() = -8.0;
    EXPECT_NE(with_sun(Vec3(0.2, -0.5, 1.0)), with_sun(Vec3(0.2, -0.6, 1.0))) << "is no ground";
    scene.bodies[0].appearance.visible = false;
    scene.bodies[0].position.z() = -1000.0;
    EXPECT_NE(with_sun(Vec3(0.3, 1.0, -0.4)), with_sun(Vec3(0.3, 1.0, 0.4))) << "nor is nothing";
}

// A sheet with one border bent upward, which gives it the AO radius of a body with a height.
BodyDescription bent_sheet(bool face_up) {
    auto asset = std::make_shared<MeshAsset>(*sheet_asset(16.0, 8));
    for (Vec3& v : asset->mesh.vertices) v.y() = v.z() < -7.0 ? 2.0 : 0.0;
    for (MeshAsset::Vertex& v : asset->vertices) v.position[1] = v.position[2] < -7.0f ? 2.0f : 0.0f;
    if (!face_up) {
        for (auto& t : asset->mesh.triangles) std::swap(t[1], t[2]);
        for (std::size_t i = 0; i < asset->indices.size(); i += 3)
            std::swap(asset->indices[i + 1], asset->indices[i + 2]);
        for (MeshAsset::Vertex& v : asset->vertices) v.normal[1] = -1.0f;
    }
    return mesh_body(Vec3::Zero(), asset, {190, 190, 190});
}

// A sheet wound the other way, with its normals downward, must not shadow its own upper side, nor be as dark as its
// underside near the ground.
TEST(Light, BothSidesOfAnOpenMeshAreLitAlike) {
    SceneDescription scene = shadow_scene();
    scene.bodies.push_back(ground_plane());
    const auto difference = [&] {
        scene.bodies[0] = bent_sheet(true);
        const Image upright = drawn(scene);
        scene.bodies[0] = bent_sheet(false);
        return most_difference(drawn(scene), upright, scene, Vec3(-0.6, 0.0, 0.0), 2.0);
    };
    scene.bodies.back().position.y() = -0.05;
    EXPECT_LE(difference(), 1);
    scene.output.width = 160;  // shadows are looked up per pixel
    scene.output.height = 90;
    scene.bodies.back().position.y() = -0.5;  // back faces are a pixel's depth farther
    EXPECT_LE(difference(), 1);
}

TEST(Light, ShadowsCanBeTurnedOff) {
    SceneDescription scene = shadow_scene();
    scene.light.shadows = false;
    const Image image = drawn(scene);
    EXPECT_NEAR(brightness_at(image, scene, Vec3(-1.0, 0, 0)), brightness_at(image, scene, Vec3(1.0, 0, 1.0)), 2.0);
}

TEST(Light, AFlyingBodyKeepsItsShadow) {
    SceneDescription scene = shadow_scene();
    scene.camera.eye = Vec3(0.0, 30.0, 60.0);
    Snapshot snapshot = first_snapshot(scene);
    snapshot.bodies[1].origin = Vec3(20.0, 6.0, -10.0);  // far outside the bodies that the near map was fitted to
    const Image image = drawn(scene, snapshot);
    const double bright = brightness_at(image, scene, Vec3(20.0, 0.0, -10.0));
    EXPECT_LT(brightness_at(image, scene, Vec3(17.0, 0.0, -10.0)), 0.85 * bright);
}

// One shadow map around bodies hundreds of meters apart would have texels of a meter, too coarse for bodies near the
// eye.
TEST(Light, BodiesNearTheEyeKeepTheirShadowsWhereOthersAreFar) {
    SceneDescription scene = shadow_scene();
    scene.camera.target = Vec3(0.0, 0.5, -4.0);
    for (const double z : {-100.0, -110.0, -120.0})
        scene.bodies.push_back(box_body(Vec3(40.0, 2.0, z), Vec3::Ones(), {200, 133, 60}));
    scene.bodies.push_back(box_body(Vec3(0.0, 30.0, -300.0), Vec3::Constant(20.0), {200, 133, 60}));
    scene.bodies.push_back(box_body(Vec3(-80.0, 15.0, -300.0), Vec3::Constant(30.0), {200, 133, 60}));
    const Image image = drawn(scene);
    const double bright = brightness_at(image, scene, Vec3(1.5, 0.0, 1.5));
    for (const Vec3& inside : {Vec3(-1.0, 0.0, 0.0), Vec3(-1.6, 0.0, 0.0), Vec3(-0.4, 0.0, 0.0), Vec3(-1.0, 0.0, 0.4)})
        EXPECT_LT(brightness_at(image, scene, inside), 0.78 * bright) << inside.transpose();
    for (const Vec3& outside :
         {Vec3(-1.9, 0.0, 0.0), Vec3(-0.1, 0.0, 0.0), Vec3(-1.0, 0.0, 0.65), Vec3(-1.0, 0.0, -0.65)})
        EXPECT_GT(brightness_at(image, scene, outside), 0.95 * bright) << outside.transpose();
    EXPECT_LT(brightness_at(image, scene, Vec3(-15.0, 0.0, -300.0)),
              0.9 * brightness_at(image, scene, Vec3(40.0, 0.0, -300.0)))
        << "nor are those far away without";
}

// A body of any kind whose top is at y = 0 and that is `size` wide.
BodyDescription wide_ground(const std::string& kind, double size) {
    constexpr Color color{190, 190, 190};
    BodyDescription ground = box_body(Vec3(0.0, -0.5, 0.0), Vec3(size, 1.0, size), color);
    if (kind == "mesh") ground = mesh_body(Vec3::Zero(), sheet_asset(size, 8), color);
    ground.type = BodyType::fixed;
    ground.appearance.roughness = 0.8;  // the same as the plane's
    return ground;
}

// A large receiver of any size has the same shadows as a plane at its place: sharp ones from the near map, also where
// bodies will land.
TEST(Light, ALargeReceiverHasTheShadowsOfAPlane) {
    SceneDescription scene = shadow_scene();
    const Image on_plane = drawn(scene);
    for (const std::string kind : {"box", "mesh"})
        for (const double size : {16.0, 60.0, 2000.0}) {
            scene.bodies[0] = wide_ground(kind, size);
            EXPECT_LE(most_difference(drawn(scene), on_plane, scene, Vec3(-0.6, 0.0, 0.0), 2.0), 1)
                << kind << ", " << size;
        }
}

// The transition from the near map's shadows to the far one's is the same on a large receiver as on a plane.
TEST(Light, ALargeReceiverHasTheFarShadowsOfAPlane) {
    SceneDescription scene = shadow_scene();
    scene.camera.eye = Vec3(0.0, 15.0, 20.0);
    scene.bodies.push_back(box_body(Vec3(3.0, 2.0, 0.0), Vec3(1.0, 0.5, 1.0), {90, 120, 180}));
    Snapshot snapshot = first_snapshot(scene);
    snapshot.bodies[2].origin = Vec3(9.0, 2.0, -2.0);  // it leaves the near map
    const Image on_plane = drawn(scene, snapshot);
    scene.bodies[0] = wide_ground("box", 60.0);
    snapshot.bodies[0] = first_snapshot(scene).bodies[0];
    const Image on_box = drawn(scene, snapshot);
    const double bright = brightness_at(on_box, scene, Vec3(5.0, 0.0, 0.0));
    EXPECT_LT(brightness_at(on_box, scene, Vec3(8.0, 0.0, -2.0)), 0.75 * bright) << "the far one has a shadow";
    EXPECT_LE(most_difference(on_box, on_plane, scene, Vec3(-0.6, 0.0, 0.0), 2.0), 1);
    EXPECT_LT(brightness_at(on_box, scene, Vec3(-1.6, 0.0, 0.0)), 0.75 * bright) << "the near one has a sharp one";
    EXPECT_GT(brightness_at(on_box, scene, Vec3(-1.81, 0.0, 0.0)), 0.97 * bright);
}

// A sheet with waves lower than a pixel far away, seen from above: depths are rounded, and specks of its underside must
// not show.
TEST(Light, FineOpenMeshesShowNoSpecksOfTheirUnderside) {
    SceneDescription scene = shadow_scene();
    scene.camera.eye = Vec3(0.0, 1.5, 9.0);
    scene.camera.target = Vec3::Zero();
    scene.light.shadows = false;
    auto sheet = std::make_shared<MeshAsset>(*sheet_asset(60.0, 300));
    for (MeshAsset::Vertex& v : sheet->vertices) {
        const double a = 9.0 * double(v.position[0]), b = 7.0 * double(v.position[2]) + double(v.position[0]);
        v.position[1] = float(0.03 * (std::sin(a) + std::sin(b)));
        const Vec3 normal = Vec3(-0.27 * std::cos(a) - 0.03 * std::cos(b), 1.0, -0.21 * std::cos(b)).normalized();
        for (int k = 0; k < 3; ++k) v.normal[k] = float(normal[k]);
    }
    scene.bodies = {mesh_body(Vec3::Zero(), sheet, {190, 190, 190})};
    const Image image = drawn(scene);
    int specks = 0;  // darker than all four neighbors, by 15 levels on average
    for (int y = 1; y < image.height - 1; ++y)
        for (int x = 1; x < image.width - 1; ++x) {
            const double most = 2.0 * brightness(image, {x, y}) + 30.0;
            specks += most < brightness(image, {x - 1, y}) + brightness(image, {x + 1, y}) &&
                              most < brightness(image, {x, y - 1}) + brightness(image, {x, y + 1})
                          ? 1
                          : 0;
        }
    EXPECT_EQ(specks, 0);
}

// Highlights on rounded edges of metal must not be dots that change from frame to frame. In images displaced by parts
// of a pixel, few pixels are much brighter in one than on average. Those that are so on wood as well are excluded,
// because a surface ends there.
TEST(Light, MetalEdgesDoNotGlitter) {
    SceneDescription scene = shadow_scene();
    scene.bodies.clear();
    Random random(4);
    for (int i = 0; i < 24; ++i)
        scene.bodies.push_back(
            box_body(Vec3(1.6 * (i % 6) - 4.0, 1.6 * (i / 6) - 2.0, 0.0), Vec3::Ones(), {200, 160, 60}, random.turn()));
    const auto brightest = [&] {  // of each pixel: the difference from the mean
        std::vector<Image> images;
        for (int i = 0; i < 16; ++i) {
            RenderSwitches options;
            options.shift_x = (i % 4) / 4.0;
            options.shift_y = (i / 4) / 4.0;
            images.push_back(drawn(scene, options));
        }
        std::vector<double> above;
        for (int y = 0; y < scene.output.height; ++y)
            for (int x = 0; x < scene.output.width; ++x) {
                double mean = 0.0, most = 0.0;
                for (const Image& image : images) {
                    mean += brightness(image, {x, y}) / 16.0;
                    most = std::max(most, brightness(image, {x, y}));
                }
                above.push_back(most - mean);
            }
        return above;
    };
    const std::vector<double> wood = brightest();
    for (std::size_t i = 0; i < scene.bodies.size(); ++i) {
        scene.bodies[i].appearance.metallic = 1.0;
        scene.bodies[i].appearance.roughness = 0.1 + 0.1 * double(i % 3);
    }
    const std::vector<double> metal = brightest();
    int glitter = 0;
    for (std::size_t i = 0; i < wood.size(); ++i) glitter += wood[i] < 40.0 && metal[i] > 80.0 ? 1 : 0;
    EXPECT_LT(glitter, 10) << "pixels";
}

// No acne: a ball and a box in full sun have no dark specks on the sides towards the sun.
TEST(Light, LitFacesDoNotShadowThemselves) {
    SceneDescription scene = shadow_scene();
    scene.light.direction = Vec3(0.2, -0.5, -1.0);
    scene.bodies[1] = box_body(Vec3(0.0, 0.5, 0.0), Vec3(3.0, 1.0, 1.0), {200, 200, 200});
    const Image with = drawn(scene);
    scene.light.shadows = false;
    const Image without = drawn(scene);
    for (double x = -1.35; x <= 1.35; x += 0.03)
        for (double z = -0.4; z <= 0.4; z += 0.05)
            EXPECT_NEAR(brightness_at(with, scene, Vec3(x, 1.0, z)), brightness_at(without, scene, Vec3(x, 1.0, z)),
                        1.0);
}

TEST(Light, ContactOcclusionIsDarkAndLimited) {
    SceneDescription scene = shadow_scene();
    scene.light.shadows = false;
    scene.bodies[1].position.y() = 0.5;
    const Image image = drawn(scene);
    const double open = brightness_at(image, scene, Vec3(3.0, 0.0, 1.0));
    double last = 0.0;
    for (const double gap : {0.05, 0.2, 0.4}) {
        const double here = brightness_at(image, scene, Vec3(0.0, 0.0, 0.5 + gap));
        EXPECT_GT(here, last);
        last = here;
    }
    EXPECT_LT(brightness_at(image, scene, Vec3(0.0, 0.0, 0.55)), 0.92 * open);
    EXPECT_NEAR(brightness_at(image, scene, Vec3(0.0, 0.0, 1.2)), open, 2.0);
}

// The AO around a contact does not spread with the size of the receiver.
TEST(Light, ContactIsAsDarkOnALargeBoxAsOnAPlane) {
    SceneDescription scene = shadow_scene();
    scene.light.shadows = false;
    scene.bodies[1].position.y() = 0.5;
    const Image on_plane = drawn(scene);
    for (const auto& [size, thick] : {std::pair{16.0, 1.0}, {40.0, 1.0}, {60.0, 1.0}, {16.0, 0.02}}) {
        scene.bodies[0] = wide_ground("box", size);
        scene.bodies[0].shape = BoxShape{Vec3(size, thick, size)};
        scene.bodies[0].position.y() = -0.5 * thick;
        const Image on_box = drawn(scene);
        for (const double gap : {0.1, 0.2, 0.3, 0.4, 0.6, 0.8, 1.2})
            for (const Vec3& at :
                 {Vec3(0.0, 0.0, 0.5 + gap), Vec3(0.5 + gap, 0.0, 0.5 + gap), Vec3(0.5 + gap, 0.0, 0.0)})
                EXPECT_NEAR(brightness_at(on_box, scene, at), brightness_at(on_plane, scene, at), 4.0)
                    << size << " m, " << thick << " thick, " << at.transpose();
    }
}

// Nor does it depend on a mesh's triangles, even if they are few or more than the available texels; nor on a ball's
// size.
TEST(Light, ContactIsAsDarkOnALargeMeshOrBallAsOnAPlane) {
    SceneDescription scene = shadow_scene();
    scene.light.shadows = false;
    scene.bodies[1].position.y() = 0.5;
    std::vector<Vec3> places;
    for (const double gap : {0.1, 0.3, 0.6, 1.2})
        for (const Vec3& at : {Vec3(0.0, 0.0, 0.5 + gap), Vec3(0.5 + gap, 0.0, 0.5 + gap), Vec3(0.5 + gap, 0.0, 0.0)})
            places.push_back(at);
    const auto taken = [&] { return levels_taken(scene, places); };
    const std::vector<double> on_plane = taken();
    const auto compare = [&](const std::string& what) {
        scene.bodies[0].type = BodyType::fixed;
        scene.bodies[0].appearance.roughness = 0.8;  // the same as the plane's
        const std::vector<double> here = taken();
        for (std::size_t i = 0; i < places.size(); ++i)
            EXPECT_NEAR(here[i], on_plane[i], 4.5)
                << what << ", " << places[i].transpose();  // the plane is dithered by 0.5
    };
    for (const double size : {6.0, 16.0, 60.0})
        for (const std::uint32_t cells : {1u, 8u, 120u}) {
            scene.bodies[0] = mesh_body(Vec3::Zero(), sheet_asset(size, cells), {190, 190, 190});
            compare(std::to_string(size) + " m, " + std::to_string(cells) + " cells");
        }
    scene.bodies[0] = ball_body(Vec3(0.0, -10.0, 0.0), 10.0, {190, 190, 190});
    compare("a ball");  // the corners of the box are 4 cm inside it
}

// A body on a shelf or in a bowl does not occlude the ground below; a body beyond the shelf's edge does.
TEST(Light, NoBodyOccludesTheGroundThroughAFixedBody) {
    SceneDescription scene = shadow_scene();
    scene.light.shadows = false;
    scene.camera.eye = Vec3(0.0, 0.3, 6.0);  // below the shelf
    scene.camera.target = Vec3::Zero();
    scene.bodies[1] = ball_body(Vec3(0.0, 0.92, 0.0), 0.5, {200, 133, 60});
    const std::vector<Vec3> places = {Vec3::Zero(), Vec3(0.3, 0.0, 0.2), Vec3(-0.5, 0.0, 0.4)};
    const auto taken = [&] { return levels_taken(scene, places); };
    const std::vector<double> open = taken();
    for (const double levels : open) EXPECT_GT(levels, 5.0);
    const Vec3 size(4.0, 0.02, 4.0);
    const BodyDescription shelves[] = {box_body(Vec3(0.0, 0.4, 0.0), size, {190, 190, 190}),
                                       mesh_body(Vec3(0.0, 0.4, 0.0), sheet_asset(4.0, 1), {190, 190, 190}),
                                       mesh_body(Vec3(0.0, 0.4, 0.0), sheet_asset(4.0, 40), {190, 190, 190}),
                                       ball_body(Vec3(0.0, 2.4, 0.0), 2.0, {190, 190, 190})};
    scene.bodies.push_back({});
    for (const BodyDescription& shelf : shelves) {
        scene.bodies[2] = shelf;
        scene.bodies[2].type = BodyType::fixed;
        for (const double levels : taken()) EXPECT_NEAR(levels, 0.0, 1.0) << shelf.shape.index();
    }
    scene.bodies[2] = shelves[0];
    scene.bodies[2].type = BodyType::fixed;
    scene.bodies[2].position.x() = 2.1;  // ends at 0.1
    const double half = taken().back();
    EXPECT_GT(half, 0.3 * open.back());
    EXPECT_LT(half, 0.95 * open.back());
}

// A mesh of any size, with any sharing of samples between vertices, is unoccluded far from a body.
TEST(Light, ContactIsNotDarkFarAway) {
    SceneDescription scene = shadow_scene();
    scene.light.shadows = false;
    scene.bodies[1].position.y() = 0.5;
    for (const double size : {30.0, 300.0, 3000.0})
        for (const std::uint32_t cells : {30u, 150u}) {
            scene.bodies[0] = mesh_body(Vec3::Zero(), sheet_asset(size, cells), {190, 190, 190});
            scene.bodies[0].type = BodyType::fixed;
            SceneDescription alone = scene;
            alone.bodies[1].appearance.visible = false;
            EXPECT_LE(most_difference(drawn(scene), drawn(alone), scene, Vec3(3.0, 0.0, 0.0), 1.2), 1)
                << size << " m, " << cells;
        }
}

// A body kilometers away, which fell off, rolled away or is in the background, from the start or later, does not affect
// the shadow, the AO and the fog of the remaining body.
TEST(Light, ALostBodyChangesNothingAroundTheRest) {
    SceneDescription scene = shadow_scene();
    scene.bodies[1].position.y() = 0.5;
    const Image alone = drawn(scene);
    scene.bodies.push_back(scene.bodies[1]);
    scene.bodies[2].position = Vec3(2.0, 0.5, -1.0);
    Snapshot aside = first_snapshot(scene);
    aside.bodies[2].origin = Vec3(6.0, 0.5, -1.0);
    const Image gone_aside = drawn(scene, aside);  // the shadow map is fitted to both
    for (const Vec3& place :
         {Vec3(0.0, -5000.0, 0.0), Vec3(3000.0, 0.5, 0.0), Vec3(-3000.0, 0.5, 0.0), Vec3(0.0, 0.5, -3000.0)})
        for (const bool from_start : {true, false}) {
            scene.bodies[2].position = from_start ? place : Vec3(2.0, 0.5, -1.0);
            Snapshot snapshot = first_snapshot(scene);
            snapshot.bodies[2].origin = place;
            EXPECT_LE(
                most_difference(drawn(scene, snapshot), from_start ? alone : gone_aside, scene, Vec3::Zero(), 1.8), 1)
                << "at " << place.transpose() << (from_start ? ", from the start" : ", later");
        }
}

// Pixels without a change stay the same: neither shadow texels nor depths nor AO depend on a body elsewhere.
TEST(Light, RestingBodiesLookTheSameWhileOthersFly) {
    SceneDescription scene = shadow_scene();
    scene.bodies[1].position.y() = 0.5;
    scene.bodies.push_back(ball_body(Vec3(3.0, 0.4, -1.0), 0.4, {80, 180, 90}));
    Snapshot snapshot = first_snapshot(scene);
    const Image before = drawn(scene, snapshot);
    for (const Vec3& place : {Vec3(2.73, 0.61, -1.4), Vec3(4.6, 2.9, 0.3), Vec3(40.0, 9.0, -30.0)}) {
        snapshot.bodies[2].origin = place;
        const Image after = drawn(scene, snapshot);
        int changed = 0;
        for (int y = 100; y < 330; ++y)
            for (int x = 200; x < 390; ++x)
                for (int channel = 0; channel < 3; ++channel)
                    changed += before.at(x, y)[channel] != after.at(x, y)[channel] ? 1 : 0;
        EXPECT_EQ(changed, 0) << "with the ball at " << place.transpose();
    }
}

// The plane's cheap shader, used where neither shadow nor AO is, gives the same result.
TEST(Light, ThePlaneHasNoSeamWhereNothingTouchesIt) {
    SceneDescription scene = shadow_scene();
    const Image with = drawn(scene);
    scene.bodies.pop_back();
    const Image without = drawn(scene);
    int least_x = 640, most_x = -1, faint = 0;
    for (int y = 0; y < with.height; ++y)
        for (int x = 0; x < with.width; ++x) {
            int difference = 0;
            for (int channel = 0; channel < 3; ++channel)
                difference = std::max(difference, std::abs(with.at(x, y)[channel] - without.at(x, y)[channel]));
            if (difference == 0) continue;
            least_x = std::min(least_x, x);
            most_x = std::max(most_x, x);
            faint += x < 140 || x > 420 ? 1 : 0;
        }
    EXPECT_GT(most_x, least_x) << "the box and its shadow must show";
    EXPECT_EQ(faint, 0) << "columns " << least_x << " to " << most_x << " changed";
}

}  // namespace
}  // namespace tumble::light_test
