
#include "core/safe_text.h"
#include "scene/fields/many_bodies_fields.h"
#include "scene/keys/arrays.h"
#include "scene/keys/fracture.h"
#include "scene/keys/joints.h"
#include "scene/keys/read_fields.h"
#include "scene/keys/templates.h"
#include "scene/mesh/mesh_loader.h"
#include "scene/toml/limits.h"
#include "sim/geometry/shapes/shape.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <utility>

namespace tumble {
namespace {

// A template in another size.

/// Enlarges all lengths by `scale` and all masses by `mass_factor`. Motion under gravity stays similar: forces grow as
/// masses, times as the root of lengths. Speeds and times that are given do not change.
void enlarge(SceneTemplate& content, double scale, double mass_factor, MeshCache& meshes);

/// Factors of the values along one coordinate.
struct CoordinateFactors {
    double value;      // of the coordinate itself
    double force;      // or torque
    double stiffness;  // force / value
    double damping;    // stiffness * time
};

void enlarge_axis(JointAxis& axis, const CoordinateFactors& by, double time) {
    axis.lower *= by.value;
    axis.upper *= by.value;
    axis.friction *= by.force;
    if (axis.spring) {
        axis.spring->stiffness *= by.stiffness;
        axis.spring->damping *= by.damping;
        axis.spring->frequency /= time;
        axis.spring->rest *= by.value;
    }
    if (axis.motor) {
        axis.motor->stiffness *= by.stiffness;
        axis.motor->damping *= by.damping;
        axis.motor->max_force *= by.force;
        for (JointTarget& target : axis.motor->targets) target.value *= by.value;
    }
}

void enlarge_joint(JointDescription& joint, double scale, double mass, double gear_ratio) {
    const double time = std::sqrt(scale);
    const CoordinateFactors move{scale, mass, mass / scale, mass / scale * time};
    const CoordinateFactors turn{1.0, mass * scale, mass * scale, mass * scale * time};
    joint.anchor_first *= scale;
    joint.anchor_second *= scale;
    for (JointAxis& axis : joint.move) enlarge_axis(axis, move, time);
    for (JointAxis& axis : joint.turn) enlarge_axis(axis, turn, time);
    joint.length *= scale;
    joint.ratio *= gear_ratio;
    joint.bearing_radius *= scale;
    if (joint.armature) *joint.armature *= joint.type == JointType::slider ? mass : mass * scale * scale;
    joint.break_force *= mass;
    joint.break_torque *= mass * scale;
    joint.break_impulse *= mass * time;
}

void enlarge(SceneTemplate& content, double scale, double mass_factor, MeshCache& meshes) {
    const bool keeps_density = mass_factor == scale * scale * scale;
    for (BodyDescription& body : content.bodies) {
        if (body.type == BodyType::dynamic && (body.mass || !keeps_density))
            body.mass = mass_properties(body).mass * mass_factor;
        if (body.center_of_mass) *body.center_of_mass *= scale;
        if (body.inertia)
            for (double& moment : *body.inertia) moment *= mass_factor * scale * scale;
        if (scale == 1.0) continue;
        body.shape = meshes.enlarged(body.shape, scale);
        enlarge_fracture(body, scale);
        body.position *= scale;
        for (Keyframe& key : body.keyframes) key.position *= scale;
    }
    for (JointDescription& joint : content.joints) {
        const auto length = [&](std::size_t of) { return content.joints[of].type == JointType::slider ? scale : 1.0; };
        const bool gear = joint.type == JointType::gear;
        enlarge_joint(joint, scale, mass_factor, gear ? length(joint.geared[0]) / length(joint.geared[1]) : 1.0);
    }
}

// Random numbers of instances differ from random numbers of bodies, whose tables count from 0.
constexpr std::uint64_t first_random_table = std::uint64_t(1) << 32;

constexpr Range usable_factor{1e-30, 1e30, ""};  // of masses: forces and stiffness stay finite

const SceneTemplate& find_template(const SceneTemplates& templates, const TomlValue& value, const std::string& name) {
    if (const auto found = templates.find(name); found != templates.end()) return found->second;
    std::vector<std::string_view> known;
    for (const auto& [other, content] : templates) known.push_back(other);
    value.origin().fail(fmt::format("\"{}\" is not the name of a template{}", safe_text(name),
                                    known.empty() ? ": there is none" : suggestion(name, known)));
}

double mass_of_all(const SceneTemplate& content) {
    double mass = 0.0;
    for (const BodyDescription& body : content.bodies)
        if (body.type == BodyType::dynamic) mass += mass_properties(body).mass;
    return mass;
}

void resize(const TomlTable& table, const InstanceRequest& request, MeshCache& meshes, SceneTemplate& content) {
    const double scale = request.scale;
    double factor = scale * scale * scale;
    if (request.mass) {
        const TomlValue mass = table.require("mass");
        const double all = mass_of_all(content);
        if (!(all > 0.0)) mass.origin().fail("is for templates with a dynamic body, and there is none");
        factor = *request.mass / all;
        if (!usable_factor.contains(factor))
            mass.fail(
                fmt::format("is unusable for a template of {:.3g} kg: give densities that are nearer to it", all));
    }
    if (scale == 1.0 && factor == 1.0) return;
    enlarge(content, scale, factor, meshes);
    for (const BodyDescription& body : content.bodies) {
        if (endless(body.shape)) continue;
        const Vec3 extent = local_bounds(body.shape).extent();
        if (limits::size.contains(extent.maxCoeff()) && extent.minCoeff() > 0.0) continue;
        table.require("scale").fail(fmt::format("makes body \"{}\" of unusable size (a length {})",
                                                safe_text(body.name), limits::size.requirement()));
    }
}

/// A ball about all bodies, in the frame of the template, as the shape of its copies.
Shape stand_in(const SceneTemplate& content, const TomlValue& arrangement) {
    Bounds bounds;
    std::vector<BoundingSphere> spheres;
    for (const BodyDescription& body : content.bodies) {
        if (endless(body.shape)) {
            arrangement.origin().fail(
                fmt::format("is for bodies of finite size (given a template with the plane \"{}\", which is endless)",
                            safe_text(body.name)));
        }
        BoundingSphere sphere = bounding_sphere(body.shape);
        sphere.center = body.position + body.rotation * sphere.center;
        bounds.add(sphere.center.array() - sphere.radius);
        bounds.add(sphere.center.array() + sphere.radius);
        spheres.push_back(sphere);
    }
    CompoundPart ball;
    ball.position = bounds.center();
    double radius = 0.0;
    for (const BoundingSphere& sphere : spheres)
        radius = std::max(radius, (sphere.center - ball.position).norm() + sphere.radius);
    ball.shape = SphereShape{radius};
    return CompoundShape{std::make_shared<const std::vector<CompoundPart>>(1, ball)};
}

class InstanceReader {
public:
    InstanceReader(const SceneTemplates& templates, const BodySources& sources, std::vector<BodyDescription>& bodies,
                   std::vector<JointDescription>& joints)
        : templates_(templates),
          sources_(sources),
          bodies_(bodies),
          joints_(joints),
          body_names_(bodies),
          joint_names_(joints) {}

    void read(const TomlTable& table) {
        const InstanceRequest request = read_all_fields<InstanceRequest>(table);
        SceneTemplate content = find_template(templates_, table.require("template"), request.of);
        if (const auto pose = table.find("pose")) apply_pose(*pose, content);
        resize(table, request, sources_.meshes, content);

        BodyDescription model;  // place and velocity of the whole
        model.name = request.name;
        model.position = request.position;
        model.rotation = request.rotation;
        model.velocity = request.velocity;
        model.angular_velocity = request.angular_velocity;
        model.appearance.color = request.color.value_or(model.appearance.color);
        const bool colored = request.color || table.has("colors");
        const std::vector<BodyDescription> places = make_places(table, model, content);
        const SourcePosition origin = table.require("name").origin();
        check_number_of_bodies(std::int64_t(bodies_.size()) + std::int64_t(places.size() * content.bodies.size()),
                               origin);
        check_number_of_joints(joints_.size() + places.size() * content.joints.size(), origin);
        for (std::size_t i = 0; i < places.size(); ++i) {
            if (i > 0)
                for (BodyDescription& body : content.bodies) vary_fracture(body, 1);
            append(content, places[i], colored, origin);
        }
        ++number_;
    }

private:
    /// One body for each copy, with its name, pose and color.
    std::vector<BodyDescription> make_places(const TomlTable& table, const BodyDescription& model,
                                             const SceneTemplate& content) const {
        ShapeRequest shape;
        shape.shape = SphereShape{1.0};
        for (const char* key : {"grid", "scatter"})
            if (const auto arrangement = table.find(key)) shape.shape = stand_in(content, *arrangement);
        const auto copies = read_copies(table, BodyType::dynamic, shape, CopyScales::one);
        if (!copies) return {model};
        check_number_of_bodies(std::int64_t(bodies_.size()) + number_of(*copies) * std::int64_t(content.bodies.size()),
                               copies->origin);
        std::vector<BodyDescription> places =
            make_copies(*copies, model, shape, sources_.meshes, sources_.settings.seed, first_random_table + number_);
        for (std::size_t i = 0; i < places.size(); ++i) places[i].name = fmt::format("{}.{}", model.name, i);
        return places;
    }

    void append(const SceneTemplate& content, const BodyDescription& place, bool colored,
                const SourcePosition& origin) {
        const std::size_t first = bodies_.size(), first_joint = joints_.size();
        for (BodyDescription body : content.bodies) {
            move(place, body);
            body.name = fmt::format("{}.{}", place.name, body.name);
            body_names_.take(body.name, origin);
            if (colored) {
                body.appearance.color = place.appearance.color;
                body.shape = without_paint(body.shape);
            }
            bodies_.push_back(std::move(body));
        }
        for (JointDescription joint : content.joints) {
            move_side(place, first, joint.first, joint.anchor_first, joint.frame_first);
            move_side(place, first, joint.second, joint.anchor_second, joint.frame_second);
            joint.name = fmt::format("{}.{}", place.name, joint.name);
            joint_names_.take(joint.name, origin);
            if (joint.type == JointType::gear)
                for (std::size_t& geared : joint.geared) geared += first_joint;
            joints_.push_back(std::move(joint));
        }
    }

    static void move_side(const BodyDescription& place, std::size_t first, std::optional<std::size_t>& body,
                          Vec3& anchor, Quat& frame) {
        if (body) {
            *body += first;
            return;
        }
        anchor = place.position + place.rotation * anchor;
        frame = (place.rotation * frame).normalized();
    }

    /// To the place, with the motion of a rigid whole that turns about the origin of the instance.
    static void move(const BodyDescription& place, BodyDescription& body) {
        body.position = place.position + place.rotation * body.position;
        body.rotation = (place.rotation * body.rotation).normalized();
        for (Keyframe& key : body.keyframes) {
            key.position = place.position + place.rotation * key.position;
            key.rotation = (place.rotation * key.rotation).normalized();
        }
        if (body.type != BodyType::dynamic) return;
        body.velocity = place.velocity + place.rotation * body.velocity;
        body.angular_velocity = place.angular_velocity + place.rotation * body.angular_velocity;
        if (place.angular_velocity.isZero(0.0)) return;
        const Vec3 center = body.position + body.rotation * mass_properties(body).center_of_mass;
        body.velocity += place.angular_velocity.cross(center - place.position);
    }

    const SceneTemplates& templates_;
    const BodySources& sources_;
    std::vector<BodyDescription>& bodies_;
    std::vector<JointDescription>& joints_;
    BodyNames body_names_;
    JointNames joint_names_;
    std::uint64_t number_ = 0;
};

}  // namespace

void read_instances(const TomlTable& root, const SceneTemplates& templates, const BodySources& sources,
                    std::vector<BodyDescription>& bodies, std::vector<JointDescription>& joints) {
    const auto list = root.find("instance");
    if (!list) return;
    InstanceReader reader(templates, sources, bodies, joints);
    for (TomlTable& table : list->tables("; write [[instance]] for each")) {
        table.set_title("[[instance]]");
        reader.read(table);
    }
}

}  // namespace tumble
