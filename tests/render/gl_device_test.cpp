// Renderers of different scenes in one OpenGL context, one after the other: nothing of a scene is left for the next.
#include "drawing.h"
#include "example_scenes.h"

#include "render/gl/gl_device.h"

#include <gtest/gtest.h>

#include <vector>

namespace tumble::gl_device_test {
namespace {

/// Scenes that use different shaders, sizes, samples and states of OpenGL.
std::vector<SceneDescription> scenes() {
    SceneDescription heap = heap_scene(6);
    SceneDescription mixed = empty_scene();
    mixed.camera.eye = Vec3(2.0, 2.0, 6.0);
    mixed.bodies = {ground_plane({176, 180, 184}, Pattern::checker), ball_body(Vec3(1.2, 0.4, 0.8), 0.4, {80, 180, 90}),
                    mesh_body(Vec3(-1.4, 0.25, 1.0), torus_asset(0.5, 0.2), {210, 80, 90})};
    mixed.bodies[1].appearance.metallic = 1.0;
    SceneDescription corded = mixed;
    corded.cords.push_back({1, Vec3::Zero(), Vec3(1.2, 3.0, 0.8), 0.02, {60, 60, 60}});
    SceneDescription walls = heap;
    walls.bodies.push_back(ground_plane({200, 60, 60}, Pattern::plain));
    std::get<PlaneShape>(walls.bodies.back().shape) = {Vec3(1.0, 0.0, 0.2).normalized(), -3.0};
    SceneDescription sheet = empty_scene();  // open meshes are drawn from both sides, with an offset
    sheet.bodies = {mesh_body(Vec3(0.0, 1.0, 0.0), sheet_asset(2.0, 4), {90, 90, 200})};
    SceneDescription unlit = heap;
    unlit.light.shadows = false;
    unlit.output.width = 100;
    unlit.output.height = 210;
    return {heap, mixed, corded, walls, sheet, unlit};
}

/// Two frames: the second one redraws a part.
std::vector<Image> frames(const SceneDescription& scene, GlDevice* device) {
    RenderSwitches switches;
    switches.device = device;
    Renderer renderer(scene, switches);
    Snapshot snapshot = first_snapshot(scene);
    std::vector<Image> images{renderer.render(snapshot)};
    snapshot.bodies.back().origin.x() += 0.1;
    snapshot.bodies.back().center_of_mass.x() += 0.1;
    images.push_back(renderer.render(snapshot));
    return images;
}

TEST(GlDevice, ScenesInOneContextHaveTheImagesOfTheirOwn) {
    const std::vector<SceneDescription> all = scenes();
    std::vector<std::vector<Image>> own;
    for (const SceneDescription& scene : all) own.push_back(frames(scene, nullptr));
    GlDevice device(GlBackend::osmesa);
    for (std::size_t i = 0; i < all.size(); ++i) EXPECT_EQ(frames(all[i], &device), own[i]) << i;
    for (std::size_t i = all.size(); i-- > 0;) EXPECT_EQ(frames(all[i], &device), own[i]) << i << " in reverse";
}

TEST(GlDevice, AProgramIsCompiledOnce) {
    const ShaderCopy shaders;
    GlDevice device(GlBackend::osmesa);
    const ShaderProgram& first = device.program(shaders.folder(), {"sky.vert", "sky.frag", {}});
    EXPECT_EQ(&device.program(shaders.folder(), {"sky.vert", "sky.frag", {}}), &first);
    EXPECT_NE(&device.program(shaders.folder(), {"sky.vert", "sky.frag", {"OTHER"}}), &first);
}

}  // namespace
}  // namespace tumble::gl_device_test
