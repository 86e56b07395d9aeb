#include "scene/keys/template_pose.h"

#include "core/deterministic_math.h"
#include "core/safe_text.h"
#include "scene/keys/joint_coordinates.h"
#include "scene/keys/joint_keys.h"
#include "scene/keys/joint_places.h"
#include "scene/toml/limits.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>

namespace tumble {
namespace {

/// A rigid motion in the world.
struct RigidMotion {
    Quat rotation = Quat::Identity();
    Vec3 shift = Vec3::Zero();

    Vec3 point(const Vec3& p) const { return rotation * p + shift; }
    /// This motion after the other one.
    RigidMotion after(const RigidMotion& other) const {
        return {(rotation * other.rotation).normalized(), rotation * other.shift + shift};
    }
};

/// Frames and anchors of a joint in the world.
struct WorldJoint {
    Vec3 first, second;
    Quat frame_first, frame_second;

    WorldJoint(const JointDescription& joint, const std::vector<BodyDescription>& bodies) {
        const SidePose a = start_pose(bodies, joint.first), b = start_pose(bodies, joint.second);
        first = a.point(joint.anchor_first);
        second = b.point(joint.anchor_second);
        frame_first = a.rotation * joint.frame_first;
        frame_second = b.rotation * joint.frame_second;
    }
    Vec3 axis() const { return frame_first * Vec3::UnitX(); }
    Vec3 apart() const { return frame_first.conjugate() * (second - first); }
    Quat turn() const {
        Quat q = frame_first.conjugate() * frame_second;
        if (q.w() < 0.0) q.coeffs() = -q.coeffs();
        return q;
    }
    double angle() const { return 2.0 * atan2_stable(turn().x(), turn().w()); }
};

/// Of a hinge or a slider, in rad or m.
double coordinate_of(const JointDescription& joint, const WorldJoint& world) {
    return joint.type == JointType::slider ? world.apart().x() : world.angle();
}

bool has_one_coordinate(const JointDescription& joint) {
    return joint.type == JointType::hinge || joint.type == JointType::slider;
}

/// Changes of the coordinates of the joints, 0 where none is given.
std::vector<double> read_changes(const TomlValue& pose, const SceneTemplate& content) {
    std::map<std::string, std::size_t> index;
    for (std::size_t i = 0; i < content.joints.size(); ++i) index[content.joints[i].name] = i;
    std::vector<double> changes(content.joints.size(), 0.0);
    for (const auto& [name, value] : pose.table().entries()) {
        const auto found = index.find(name);
        if (found == index.end()) {
            std::vector<std::string_view> known;
            for (const auto& [other, i] : index) known.push_back(other);
            value.origin().fail(fmt::format("is not the name of a joint of the template{}", suggestion(name, known)));
        }
        const JointDescription& joint = content.joints[found->second];
        if (!has_one_coordinate(joint)) {
            value.origin().fail(
                fmt::format("is for hinges and sliders (given a joint of type \"{}\")", type_name(joint.type)));
        }
        const bool turns = joint.type == JointType::hinge;
        const CoordinateUnit& unit = turns ? angle_unit : length_unit;
        const double target = value.number(turns ? limits::half_turn : limits::coordinate) * unit.in_si;
        const JointAxis& axis = turns ? joint.turn[0] : joint.move[0];
        if (target < axis.lower - limits::start_tolerance || target > axis.upper + limits::start_tolerance) {
            value.fail(fmt::format("must be within the limits of the joint, {:.6g} to {:.6g} {}",
                                   axis.lower / unit.in_si, axis.upper / unit.in_si, unit.name));
        }
        const WorldJoint world(joint, content.bodies);
        changes[found->second] = target - coordinate_of(joint, world);
    }
    return changes;
}

/// Motion of the second body of the joint relative to its first one.
RigidMotion motion_of(const JointDescription& joint, const WorldJoint& world, double change) {
    if (joint.type == JointType::slider) return {Quat::Identity(), change * world.axis()};
    const SinCos half = sincos(0.5 * change);
    const Vec3 v = half.sin * world.axis();
    const Quat turn = Quat(half.cos, v.x(), v.y(), v.z()).normalized();
    return {turn, world.first - turn * world.first};
}

RigidMotion inverse(const RigidMotion& motion) {
    const Quat back = motion.rotation.conjugate();
    return {back, -(back * motion.shift)};
}

/// The bodies of a template in their order from the roots outward.
class Kinematics {
public:
    Kinematics(const SceneTemplate& content, const std::vector<double>& changes)
        : content_(content), changes_(changes), motion_(content.bodies.size() + 1), at_(content.bodies.size() + 1) {
        for (std::size_t j = 0; j < content.joints.size(); ++j) {
            const JointDescription& joint = content.joints[j];
            at_[side(joint.first)].push_back(j);
            at_[side(joint.second)].push_back(j);
        }
    }

    /// The motion of each body.
    const std::vector<std::optional<RigidMotion>>& run() {
        std::vector<std::size_t> roots{world()};
        for (std::size_t b = 0; b < world(); ++b)
            if (content_.bodies[b].type != BodyType::dynamic) roots.push_back(b);
        for (const std::size_t root : roots) motion_[root] = RigidMotion{};
        for (const std::size_t root : roots) visit_from(root);
        for (std::size_t b = 0; b < world(); ++b) {
            if (motion_[b]) continue;
            motion_[b] = RigidMotion{};
            visit_from(b);
        }
        return motion_;
    }

private:
    std::size_t world() const { return content_.bodies.size(); }
    std::size_t side(const std::optional<std::size_t>& body) const { return body.value_or(world()); }

    /// Ropes, rods and springs do not carry a body along while a joint of another type does.
    void visit_from(std::size_t root) {
        std::vector<std::size_t> order{root};
        for (const bool by_ropes : {false, true})
            for (std::size_t k = 0; k < order.size(); ++k)
                for (const std::size_t j : at_[order[k]]) {
                    const JointDescription& joint = content_.joints[j];
                    if ((joint.type == JointType::distance) != by_ropes) continue;
                    const bool outward = side(joint.first) == order[k];
                    const std::size_t next = outward ? side(joint.second) : side(joint.first);
                    if (motion_[next]) continue;
                    motion_[next] = carried(joint, j, *motion_[order[k]], outward);
                    order.push_back(next);
                }
    }

    RigidMotion carried(const JointDescription& joint, std::size_t j, const RigidMotion& parent, bool outward) const {
        if (changes_[j] == 0.0) return parent;
        const RigidMotion own = motion_of(joint, WorldJoint(joint, content_.bodies), changes_[j]);
        return parent.after(outward ? own : inverse(own));
    }

    const SceneTemplate& content_;
    const std::vector<double>& changes_;
    std::vector<std::optional<RigidMotion>> motion_;  // of each body, then of the world
    std::vector<std::vector<std::size_t>> at_;        // joints of each
};

/// The largest error of the locked coordinates, m; angles count as those of an arm of 1 m.
double error_of(const JointDescription& joint, const WorldJoint& world) {
    const Vec3 apart = world.apart();
    const Quat turn = world.turn();
    if (joint.type == JointType::distance) {
        const double length = apart.norm();
        if (joint.move[0].motion == JointAxis::Motion::locked) return std::fabs(length - joint.length);
        return std::max({0.0, joint.move[0].lower - length, length - joint.move[0].upper});
    }
    double error = 0.0;
    for (int k = 0; k < 3; ++k) {
        if (joint.move[k].motion == JointAxis::Motion::locked) error = std::max(error, std::fabs(apart[k]));
    }
    if (joint.type == JointType::universal) {
        const Vec3 second = turn * Vec3::UnitY();  // stays square to the first axis
        return std::max(error, std::fabs(second.x()));
    }
    for (int k = 0; k < 3; ++k) {
        if (joint.turn[k].motion == JointAxis::Motion::locked) error = std::max(error, 2.0 * std::fabs(turn.vec()[k]));
    }
    return error;
}

constexpr double most_error = 1e-9;  // m: rounding of a loop of meters, not a mistake

}  // namespace

void apply_pose(const TomlValue& pose, SceneTemplate& content) {
    const std::vector<double> changes = read_changes(pose, content);
    std::vector<double> before, before_change;  // errors that are accepted; coordinates
    for (const JointDescription& joint : content.joints) {
        const WorldJoint world(joint, content.bodies);
        before.push_back(error_of(joint, world));
        before_change.push_back(coordinate_of(joint, world));
    }
    const auto motions = Kinematics(content, changes).run();
    for (std::size_t b = 0; b < content.bodies.size(); ++b) {
        BodyDescription& body = content.bodies[b];
        const RigidMotion& motion = *motions[b];
        body.position = motion.point(body.position);
        body.rotation = (motion.rotation * body.rotation).normalized();
        body.velocity = motion.rotation * body.velocity;
        body.angular_velocity = motion.rotation * body.angular_velocity;
    }
    for (std::size_t j = 0; j < content.joints.size(); ++j) {
        const JointDescription& joint = content.joints[j];
        const WorldJoint world(joint, content.bodies);
        double error = error_of(joint, world) - before[j];
        if (changes[j] != 0.0)
            error = std::max(error, std::fabs(coordinate_of(joint, world) - before_change[j] - changes[j]));
        if (error <= most_error) continue;
        pose.origin().fail(
            fmt::format("opens the joint \"{}\" by {:.3g} m, because it closes a loop: give the "
                        "coordinates of all joints of the loop, so that it stays closed",
                        safe_text(joint.name), error));
    }
}

}  // namespace tumble
