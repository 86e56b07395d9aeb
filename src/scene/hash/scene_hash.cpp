#include "scene/hash/scene_hash.h"

#include "scene/hash/value_hash.h"

#include <filesystem>
#include <map>

namespace tumble {
namespace {

enum class Content { all, motion };

/// Adds each struct of a description by a structured binding of all its fields: a new field does not compile here before
/// it has a place (tests/scene/scene_hash_test.cpp varies each key).
class DescriptionHash : public ValueHash {
public:
    explicit DescriptionHash(Content content) : all_(content == Content::all) {}

    void add_scene(const SceneDescription& scene) {
        const auto& [file, title, simulation, output, camera, light, wind, contact, forces, bodies, joints, cords,
                     overlay] = scene;
        add_value(simulation);
        add_value(output);
        add_value(wind);
        if (contact != PairRules{}) add_value(contact);  // other scenes keep their hash
        add_value(forces);
        add_value(bodies);
        if (!joints.empty()) add_value(joints);  // scenes without joints keep their hash
        if (!all_) return;
        add_all(title, camera, light, cords, overlay);
        add_shown_file(scene);
    }

    void add_shown_file(const SceneDescription& scene) {
        const bool shows_file = scene.title.empty() && scene.overlay.show.has(Overlay::title);
        add_value(shows_file ? std::filesystem::path(scene.file).stem().string() : std::string());
    }

    template <class T>
    std::string finish_with(const T& part) {
        add_value(part);
        return finish();
    }

private:
    template <class... Values>
    void add_all(const Values&... values) {
        (add_value(values), ...);
    }

    template <class T>
    requires requires(ValueHash hash, const T& value) { hash.add(value); }
    void add_value(const T& value) { add(value); }
    void add_value(const Vec3& v) { add_all(v.x(), v.y(), v.z()); }
    void add_value(const Quat& q) { add_all(q.w(), q.x(), q.y(), q.z()); }
    template <class T>
    void add_value(const std::optional<T>& value) {
        add(value.has_value());
        if (value) add_value(*value);
    }
    template <class T>
    void add_value(const std::vector<T>& values) {
        add(values.size());
        for (const T& value : values) add_value(value);
    }
    template <class T, std::size_t N>
    void add_value(const std::array<T, N>& values) {
        for (const T& value : values) add_value(value);
    }

    void add_value(const SimulationSettings& simulation) {
        const auto& [duration, steps_per_frame, gravity, method, push_out, integrator, impacts, impact_law,
                     contact_solver, rotation, sleep, seed] = simulation;
        add_all(duration, steps_per_frame, gravity, method, push_out, integrator, impacts, impact_law, contact_solver,
                rotation, sleep, seed);
    }
    void add_value(const OutputSettings& output) {
        const auto& [width, height, fps, samples] = output;
        add(fps);
        if (all_) add_all(width, height, samples);
    }
    void add_value(const CameraKeyframe& key) {
        const auto& [time, eye, target, vertical_fov] = key;
        add_all(time, eye, target, vertical_fov);
    }
    void add_value(const CameraDescription& camera) {
        const auto& [eye, target, up, vertical_fov, keyframes, interpolation, orbit, follow, follow_start,
                     follow_start_rotation] = camera;
        add_all(eye, target, up, vertical_fov, keyframes, interpolation, orbit, follow, follow_start,
                follow_start_rotation);
    }
    void add_value(const LightDescription& light) {
        const auto& [direction, shadows] = light;
        add_all(direction, shadows);
    }
    void add_value(const WindDescription& wind) {
        const auto& [velocity, density, drag] = wind;
        add_all(velocity, density, drag);
    }
    void add_value(const PairRules& rules) {
        const auto& [restitution, friction] = rules;
        add_all(restitution, friction);
    }
    void add_value(const ForceDescription& one) {
        const auto& [body, point, force, body_frame, start, end] = one;
        add_all(body, point, force, body_frame, start, end);
    }

    void add_value(const MeshAsset::Vertex& vertex) {
        const auto& [position, normal] = vertex;
        add_bytes(std::as_bytes(std::span(position)));
        add_bytes(std::as_bytes(std::span(normal)));
    }
    void add_value(const TriangleMesh& mesh) {
        const auto& [vertices, triangles] = mesh;
        add_all(vertices, triangles);
    }
    void add_value(const MeshAsset& asset) {
        const auto& [file, mesh, vertices, indices] = asset;
        add_value(mesh);
        add_all(vertices, indices);
    }
    void add_value(const PlaneShape& plane) {
        const auto& [normal, offset] = plane;
        add_all(normal, offset);
    }
    void add_value(const BoxShape& box) {
        const auto& [size] = box;
        add_value(size);
    }
    void add_value(const SphereShape& sphere) {
        const auto& [radius] = sphere;
        add_value(radius);
    }
    void add_value(const MeshShape& mesh) {
        const auto& [asset] = mesh;
        add_shared(asset);
    }
    void add_value(const CompoundShape& compound) {
        const auto& [parts] = compound;
        add_shared(parts);
    }
    void add_value(const Shape& shape) {
        add(shape.index());
        std::visit([&](const auto& one) { add_value(one); }, shape);
    }
    void add_value(const CompoundPart& part) {
        const auto& [shape, position, rotation, density, color] = part;
        add_all(shape, position, rotation, density);
        if (all_) add_value(color);
    }
    /// Data that several bodies may share, hashed once. Equal data counts as equal, shared or not.
    template <class T>
    void add_shared(const std::shared_ptr<const T>& data) {
        const auto [place, is_new] = hash_of_shared_.try_emplace(data.get());
        if (is_new) {
            DescriptionHash inner(all_ ? Content::all : Content::motion);
            inner.add_value(*data);
            place->second = inner.finish();
        }
        add(place->second);
    }

    void add_value(const Appearance& appearance) {
        const auto& [color, roughness, metallic, pattern, visible] = appearance;
        add_all(color, roughness, metallic, pattern, visible);
    }
    void add_value(const Keyframe& key) {
        const auto& [time, position, rotation] = key;
        add_all(time, position, rotation);
    }
    void add_value(const BodyDescription& body) {
        const auto& [name, type, shape, appearance, density, mass, restitution, friction, position, rotation, velocity,
                     angular_velocity, integrator, keyframes, interpolation] = body;
        add_all(name, type, shape, density, mass, body.restitution_in_pair(), body.friction_in_pair(), position,
                rotation, velocity, angular_velocity, integrator, keyframes, interpolation);
        if (all_) add_value(appearance);
    }
    void add_value(const JointSpring& spring) {
        const auto& [stiffness, damping, frequency, damping_ratio, rest] = spring;
        add_all(stiffness, damping, frequency, damping_ratio, rest);
    }
    void add_value(const JointTarget& target) {
        const auto& [time, value] = target;
        add_all(time, value);
    }
    void add_value(const JointMotor& motor) {
        const auto& [speed, targets, interpolation, stiffness, damping, max_force] = motor;
        add_all(speed, targets, interpolation, stiffness, damping, max_force);
    }
    void add_value(const JointAxis& axis) {
        const auto& [motion, lower, upper, restitution, spring, motor, friction] = axis;
        add_all(motion, lower, upper, restitution, spring, motor, friction);
    }
    void add_value(const JointDescription& joint) {
        const auto& [name, type, first, second, anchor_first, anchor_second, frame_first, frame_second, move, turn,
                     swing, length, geared, ratio, friction_coefficient, bearing_radius, break_force, break_torque,
                     break_impulse, collide, start, end, visible] = joint;
        add_all(name, type, first, second, anchor_first, anchor_second, frame_first, frame_second, move, turn, swing,
                length, friction_coefficient, bearing_radius, break_force, break_torque, break_impulse, collide, start,
                end);
        if (type == JointType::gear) add_all(geared, ratio);  // other scenes keep their hash
        if (all_) add_value(visible);
    }
    void add_value(const CordDescription& cord) {
        const auto& [body, point, anchor, radius, color, joint, anchor_body] = cord;
        add_all(body, point, anchor, radius, color);
        if (joint) add_all(joint, anchor_body);  // scenes without joints keep their hash
    }

    void add_value(const OverlaySet& show) {
        for (const OverlayName& overlay : overlay_names) add(show.has(overlay.overlay));
    }
    void add_value(const TrailPoint& trail) {
        const auto& [body, point, color] = trail;
        add_all(body, point, color);
    }
    void add_value(const Caption& caption) {
        const auto& [text, start, end] = caption;
        add_all(text, start, end);
    }
    void add_value(const OverlayDescription& overlay) {
        const auto& [show, bodies, start, end, impulse_time, trail_time, trail_points, ghost_every, legend, scale,
                     color, plot, plot_place, captions] = overlay;
        add_all(show, bodies, start, end, impulse_time, trail_time, trail_points, ghost_every, legend, scale, color,
                plot, plot_place, captions);
    }

    bool all_;
    std::map<const void*, std::string> hash_of_shared_;  // looked up only: the order of addresses has no effect
};

std::string hash_of(const SceneDescription& scene, Content content) {
    DescriptionHash hash(content);
    hash.add(std::string_view(content == Content::all ? "tumble scene" : "tumble motion"));
    hash.add_scene(scene);
    return hash.finish();
}

}  // namespace

std::string scene_hash(const SceneDescription& scene) { return hash_of(scene, Content::all); }

std::string motion_hash(const SceneDescription& scene) { return hash_of(scene, Content::motion); }

std::vector<std::pair<std::string, std::string>> scene_parts(const SceneDescription& scene) {
    const auto& [file, title, simulation, output, camera, light, wind, contact, forces, bodies, joints, cords,
                 overlay] = scene;
    const auto part = [](const auto& value) { return DescriptionHash(Content::all).finish_with(value); };
    SimulationSettings of_any_duration = simulation;
    of_any_duration.duration = 0.0;
    DescriptionHash text(Content::all);
    if (overlay.show.has(Overlay::title)) text.add(title);
    text.add_shown_file(scene);
    std::vector<std::pair<std::string, std::string>> parts{{"simulation", part(of_any_duration)},
                                                           {"camera", part(camera)},
                                                           {"light", part(light)},
                                                           {"wind", part(wind)},
                                                           {"forces", part(forces)},
                                                           {"bodies", part(bodies)}};
    if (contact != PairRules{}) parts.emplace_back("contact", part(contact));  // as in the hash
    if (!joints.empty()) parts.emplace_back("joints", part(joints));           // as in the hash
    parts.emplace_back("cords", part(cords));
    parts.emplace_back("overlay", text.finish_with(overlay));
    return parts;
}

}  // namespace tumble
