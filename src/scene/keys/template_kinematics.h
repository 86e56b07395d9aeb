// Forward kinematics of a template: motions of its bodies from changes of the coordinates of its hinges and sliders.
#pragma once

#include "scene/keys/templates.h"

#include <cstddef>
#include <optional>
#include <vector>

namespace tumble {

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

/// Anchors and frames of a joint in the world.
struct WorldJoint {
    Vec3 first, second;
    Quat frame_first, frame_second;

    WorldJoint(const JointDescription& joint, const std::vector<BodyDescription>& bodies);
    WorldJoint(const WorldJoint& start, const RigidMotion& of_first, const RigidMotion& of_second);
    Vec3 axis() const { return frame_first * Vec3::UnitX(); }
    Vec3 apart() const { return frame_first.conjugate() * (second - first); }
    Quat turn() const;  // of the second frame in the first, the shorter way
};

bool has_one_coordinate(const JointDescription& joint);

/// Coordinate of a hinge or a slider, in rad or m.
double coordinate_of(const JointDescription& joint, const WorldJoint& world);

/// Appends the errors of all locked coordinates, m and rad.
void append_errors(const JointDescription& joint, const WorldJoint& world, std::vector<double>& errors);

/// The bodies of a template in their order from the roots outward. Fixed and kinematic bodies and the world are roots;
/// without them the first body of each group of joined bodies.
class TemplateKinematics {
public:
    explicit TemplateKinematics(const SceneTemplate& content);

    /// Motion of each body, and then of the world, for the change of each joint's coordinate.
    std::vector<RigidMotion> motions(const std::vector<double>& changes) const;
    WorldJoint moved(std::size_t joint, const std::vector<RigidMotion>& motions) const;
    const WorldJoint& start(std::size_t joint) const { return start_[joint]; }

    /// Joints that close loops.
    const std::vector<std::size_t>& closing() const { return closing_; }
    /// Joints between the two sides of a closing joint.
    std::vector<std::size_t> loop_of(std::size_t closing) const;

private:
    struct Branch {
        std::size_t body, parent, joint;
        bool outward;  // from the joint's first body to its second one
    };

    std::size_t world() const { return content_.bodies.size(); }
    std::size_t side(const std::optional<std::size_t>& body) const { return body.value_or(world()); }
    void grow_from(const std::vector<std::size_t>& roots, std::vector<char>& reached);

    const SceneTemplate& content_;
    std::vector<WorldJoint> start_;
    std::vector<std::vector<std::size_t>> joints_at_;    // of each body, then of the world
    std::vector<Branch> branches_;                       // parents first
    std::vector<std::optional<std::size_t>> branch_of_;  // of each body
    std::vector<std::size_t> closing_;
};

}  // namespace tumble
