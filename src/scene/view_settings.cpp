#include "scene/view_settings.h"

#include "scene/default_camera.h"
#include "scene/limits.h"

namespace tumble {

LightDescription read_light(const TomlTable& root) {
    LightDescription light;
    if (const auto table = root.find_table("light")) {
        table->expect_keys({"direction", "shadows"});
        if (const auto value = table->find("direction")) light.direction = value->direction();
        table->read("shadows", light.shadows);
    }
    return light;
}

std::optional<WindDescription> read_wind(const TomlTable& root) {
    const auto table = root.find_table("wind");
    if (!table) return std::nullopt;
    WindDescription wind;
    table->expect_keys({"velocity", "density", "drag"});
    table->read("velocity", wind.velocity, limits::velocity);
    table->read("density", wind.density, limits::air_density);
    table->read("drag", wind.drag, limits::drag);
    return wind;
}

CameraDescription read_camera(const TomlTable& root, const SceneDescription& scene) {
    CameraDescription lens;
    const auto table = root.find_table("camera");
    if (!table) return default_camera(scene, lens);

    table->expect_keys({"eye", "target", "up", "vertical_fov"});
    if (const auto value = table->find("up")) lens.up = value->direction();
    table->read("vertical_fov", lens.vertical_fov, limits::field_of_view);
    const auto eye = table->find("eye"), target = table->find("target");

    CameraDescription camera = default_camera(scene, lens);
    const Vec3 offset = camera.eye - camera.target;
    if (eye) camera.eye = eye->vector(limits::coordinate);
    if (target) camera.target = target->vector(limits::coordinate);
    if (target && !eye) camera.eye = camera.target + offset;

    const Vec3 view = camera.target - camera.eye;
    constexpr double parallel = 1e-6;   // rad: closer to `up` than this there is no telling which way is up
    if (eye && view.norm() == 0.0) eye->fail("must not be at the target");
    if (view.normalized().cross(camera.up).norm() < parallel) {
        // The default camera never does this, so one of the three was given.
        const auto up = table->find("up");
        const TomlValue& given = up ? *up : eye ? *eye : *target;
        given.origin().fail(
            "does not fit: the camera looks along its up direction, so there is no telling which way is up; "
            "choose another up");
    }
    return camera;
}

}  // namespace tumble
