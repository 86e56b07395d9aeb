#include "scene/camera/camera.h"

#include "core/safe_text.h"
#include "scene/camera/default_camera.h"
#include "scene/fields/camera_fields.h"
#include "scene/fields/label_fields.h"
#include "scene/keys/body_index.h"
#include "scene/keys/read_fields.h"
#include "scene/toml/limits.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <string>
#include <vector>

namespace tumble {
namespace {

/// Source positions of the given keys, for the error if eye, target and up are inconsistent.
struct ViewKeys {
    std::optional<TomlValue> eye, target, up;
};

void check_view(const Vec3& eye, const Vec3& target, const Vec3& up, const ViewKeys& given, const TomlTable& table) {
    const Vec3 view = target - eye;
    if (view.norm() == 0.0) {
        if (given.eye) given.eye->fail("must not be at the target");
        if (given.target) given.target->fail("must not be at the eye");
        table.origin().fail("has its eye in its target");
    }
    if (view.normalized().cross(up.normalized()).norm() >= least_roll_angle) return;
    const SourcePosition& origin = given.up       ? given.up->origin()
                                   : given.eye    ? given.eye->origin()
                                   : given.target ? given.target->origin()
                                                  : table.origin();
    origin.fail(
        "does not fit: the camera looks along its up direction, which leaves its roll undefined; "
        "choose another up");
}

void read_place(const TomlTable& table, CameraDescription& camera, const ViewKeys& given) {
    const Vec3 offset = camera.eye - camera.target;
    if (given.target)
        camera.target = given.target->vector(limits::coordinate);
    else if (camera.follow)
        camera.target = camera.follow_start;
    if (given.eye)
        camera.eye = given.eye->vector(limits::coordinate);
    else if (given.target || camera.follow)
        camera.eye = camera.target + offset;
    check_view(camera.eye, camera.target, camera.up, given, table);
}

std::vector<CameraKeyframe> read_keyframes(const TomlValue& value, const CameraDescription& camera) {
    std::vector<CameraKeyframe> keyframes;
    for (TomlTable& table : value.tables(" { time, eye, target }")) {
        table.set_title("a keyframe of the camera");
        const CameraKeyframe key =
            read_all_fields(table, CameraKeyframe{0.0, camera.eye, camera.target, camera.vertical_fov});
        if (!keyframes.empty() && key.time <= keyframes.back().time) {
            table.require("time").fail(
                fmt::format("must come after the keyframe before, at {} s", number_text(keyframes.back().time)));
        }
        check_view(key.eye, key.target, camera.up, {table.find("eye"), table.find("target"), std::nullopt}, table);
        keyframes.push_back(key);
    }
    if (keyframes.empty()) value.fail("must hold at least one keyframe");
    return keyframes;
}

void read_follow(const TomlTable& table, const SceneDescription& scene, CameraDescription& camera) {
    const auto follow = table.find("follow");
    if (const auto time = table.find("follow_time"); time && !follow)
        time->origin().fail("is for a camera that follows a body: give follow too");
    if (!follow) return;
    camera.follow = BodyIndex(scene.bodies).find(*follow);
    const BodyDescription& body = scene.bodies[*camera.follow];
    if (body.type == BodyType::fixed) follow->fail("must be a body that moves");
    camera.follow_start = body.position;
    camera.follow_start_rotation = body.rotation;
}

/// The file's own duration, not that of the command line, so that a frame looks the same in a clip of any length.
double duration_in_file(const TomlTable& root) {
    double duration = SimulationSettings{}.duration;
    if (const auto table = root.find_table("simulation")) table->read("duration", duration, limits::duration);
    return duration;
}

constexpr double longest_fitted = 60.0;  // s; of a motion that lasts longer, the default camera shows this much

std::optional<DepthOfField> read_lens(const TomlTable& camera, const SceneDescription& scene) {
    const auto given = camera.find("dof");
    if (!given) return std::nullopt;
    TomlTable table = given->table();
    table.set_title("dof");
    auto lens = read_all_fields<DepthOfField>(table);
    const TomlValue focus = table.require("focus");
    if (!focus.is_text()) {
        lens.focus = focus.number(limits::focus);
        if (lens.focus < lens.aperture) focus.fail("must be at least the aperture: a lens sees nothing so near sharp");
        return lens;
    }
    lens.body = BodyIndex(scene.bodies).find(focus);
    if (endless(scene.bodies[*lens.body].shape)) focus.fail("must not be a plane, which has no center");
    return lens;
}

/// A camera of the file; without its table the default one.
CameraDescription read_one(const std::optional<TomlTable>& table, const SceneDescription& scene, double duration) {
    CameraDescription lens;
    lens.fitted_time = std::min(duration, longest_fitted);
    if (!table) return default_camera(scene, lens, duration);

    table->expect_keys(list_keys<CameraDescription>().keys);
    read_fields(*table, lens);
    const ViewKeys given{table->find("eye"), table->find("target"), table->find("up")};
    lens.own_eye = given.eye.has_value();
    lens.own_target = given.target.has_value();

    CameraDescription camera = lens;
    // a camera that follows a body needs no view of the whole throw
    if (!given.eye || !given.target) camera = default_camera(scene, lens, table->find("follow") ? 0.0 : duration);
    camera.dof = read_lens(*table, scene);
    read_follow(*table, scene, camera);
    read_place(*table, camera, given);
    if (table->find("fit") && given.eye && given.target)
        table->find("fit")->fail("is for a camera without an eye or without a target");
    if (const auto keyframes = table->find("keyframes")) {
        camera.keyframes = read_keyframes(*keyframes, camera);
        camera.eye = camera.keyframes.front().eye;
        camera.target = camera.keyframes.front().target;
        camera.vertical_fov = camera.keyframes.front().vertical_fov;
    } else if (const auto interpolation = table->find("interpolation")) {
        interpolation->origin().fail("is for a camera with keyframes");
    }
    return camera;
}

std::vector<std::string_view> names_of(const std::map<std::string, CameraDescription>& cameras) {
    std::vector<std::string_view> names;
    for (const auto& [name, camera] : cameras) names.push_back(name);
    return names;
}

using NamedCameras = std::map<std::string, CameraDescription>;

/// The camera that a shot or an inset names.
const CameraDescription& find_camera(const TomlTable& table, const NamedCameras& cameras) {
    const TomlValue name = table.require("camera");
    const auto found = cameras.find(name.text());
    if (found == cameras.end())
        name.origin().fail(fmt::format("\"{}\" is not the name of one of [cameras]{}", safe_text(name.text()),
                                       suggestion(name.text(), names_of(cameras))));
    return found->second;
}

void read_rectangle(const TomlTable& table, CameraInset& inset) {
    const auto given = table.find("rectangle");
    if (!given) return;
    for (const char* key : {"corner", "size", "margin"})
        if (const auto other = table.find(key))
            other->origin().fail("and rectangle exclude each other: give one of them");
    const auto sides = given->items(4, "numbers: left, top, width and height, as shares of the frame");
    std::array<double, 4>& r = inset.rectangle.emplace();
    for (std::size_t i = 0; i < 4; ++i) r[i] = sides[i].number(i < 2 ? limits::fraction : limits::frame_share);
    constexpr double rounding = 1e-9;
    if (r[0] + r[2] > 1.0 + rounding || r[1] + r[3] > 1.0 + rounding)
        given->fail("must lie in the frame: left + width and top + height are at most 1");
}

std::vector<CameraInset> read_insets(const TomlTable& root, const NamedCameras& cameras) {
    std::vector<CameraInset> insets;
    const auto list = root.find("inset");
    if (!list) return insets;
    for (TomlTable& table : list->tables("; write [[inset]] for each")) {
        table.set_title("[[inset]]");
        if (std::int64_t(insets.size()) == limits::insets)
            table.origin().fail(fmt::format("is one too many: a scene has {} insets at most", limits::insets));
        CameraInset inset = read_all_fields<CameraInset>(table);
        inset.camera = find_camera(table, cameras);
        read_rectangle(table, inset);
        const auto end = table.find("to");
        inset.end = end ? end->number(limits::time) : infinity;
        if (end && inset.end <= inset.start)
            end->fail(fmt::format("must come after its start, at {} s", number_text(inset.start)));
        insets.push_back(std::move(inset));
    }
    return insets;
}

std::vector<CameraShot> read_shots(const TomlTable& root, const NamedCameras& cameras) {
    std::vector<CameraShot> shots;
    const auto list = root.find("shot");
    if (!list) return shots;
    std::vector<bool> open;  // the end follows from the next shot
    for (TomlTable& table : list->tables("; write [[shot]] for each")) {
        table.set_title("[[shot]]");
        CameraShot shot = read_all_fields<CameraShot>(table);
        shot.camera = find_camera(table, cameras);
        if (!shots.empty() && shot.start < (open.back() ? shots.back().start : shots.back().end))
            table.find(table.has("from") ? "from" : "camera")
                ->origin()
                .fail(fmt::format("makes the shot begin before the one before it {}, at {} s",
                                  open.back() ? "begins" : "ends",
                                  number_text(open.back() ? shots.back().start : shots.back().end)));
        const auto end = table.find("to");
        shot.end = end ? end->number(limits::time) : infinity;
        if (end && shot.end <= shot.start)
            end->fail(fmt::format("must come after the start of the shot, at {} s", number_text(shot.start)));
        if (!shots.empty() && open.back()) shots.back().end = shot.start;
        open.push_back(!end);
        shots.push_back(std::move(shot));
    }
    return shots;
}

}  // namespace

CameraDescription read_camera(const TomlTable& root, const SceneDescription& scene,
                              const std::optional<std::string>& named) {
    const double duration = duration_in_file(root);
    NamedCameras cameras;
    if (const auto tables = root.find_table("cameras"))
        for (const auto& [name, value] : tables->entries()) {
            TomlTable table = value.table();
            table.set_title(fmt::format("[cameras.{}]", name));
            cameras.emplace(name, read_one(table, scene, duration));
        }
    CameraDescription camera = read_one(root.find_table("camera"), scene, duration);
    camera.shots = read_shots(root, cameras);
    camera.insets = read_insets(root, cameras);
    if (!named) return camera;
    const auto found = cameras.find(*named);
    if (found == cameras.end())
        throw InputError(fmt::format("--camera: the scene has no [cameras.{}]{}", safe_text(*named),
                                     suggestion(*named, names_of(cameras))));
    return found->second;
}

}  // namespace tumble
