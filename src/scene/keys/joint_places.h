// Anchors and axes of a joint: its two frames, and its coordinates at the start.
#pragma once

#include "scene/description/description.h"
#include "scene/toml/toml_reader.h"

#include <array>
#include <optional>
#include <vector>

namespace tumble {

/// Pose of one side of a joint at the start: of a body's origin; the identity for the world.
struct SidePose {
    Vec3 position = Vec3::Zero();
    Quat rotation = Quat::Identity();

    Vec3 point(const Vec3& local) const { return position + rotation * local; }
    Vec3 local_point(const Vec3& world) const { return rotation.conjugate() * (world - position); }
    Quat local_rotation(const Quat& world) const { return (rotation.conjugate() * world).normalized(); }
};

/// A unit vector square to another one.
Vec3 across(const Vec3& x);

SidePose start_pose(const std::vector<BodyDescription>& bodies, const std::optional<std::size_t>& body);

/// The place of a joint in the world at the start, where no keys give it.
struct JointPlace {
    Vec3 anchor;
    Vec3 x, y;  // axes of its frame: of unit length, square to each other
};

/// Coordinates of a joint at the start, in SI units. A distance joint has its distance in move[0].
struct StartCoordinates {
    std::array<double, 3> move{}, turn{};
};

/// Reads anchor, anchors, axis, axes, second_axis, frame, start_angle and start_position into a joint with type and
/// bodies. With `snap`, gaps of locked coordinates are accepted.
StartCoordinates read_places(const TomlTable& table, const std::vector<BodyDescription>& bodies, bool snap,
                             JointDescription& joint);

/// Sets the frames of a joint with bodies; all its coordinates are zero at the start.
void set_place(const JointPlace& place, const std::vector<BodyDescription>& bodies, JointDescription& joint);

/// Length of the smaller body of the joint, m: the unit of its tolerances.
double smaller_size(const std::vector<BodyDescription>& bodies, const JointDescription& joint);

}  // namespace tumble
