#include "scene/keys/joint_places.h"

#include "core/deterministic_math.h"
#include "core/vector.h"
#include "scene/fields/choices.h"
#include "scene/toml/limits.h"
#include "sim/geometry/shapes/shape.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace tumble {

// From the world axis that is farthest from it.
Vec3 across(const Vec3& x) {
    int axis = 0;
    for (int k = 1; k < 3; ++k)
        if (std::fabs(x[k]) < std::fabs(x[axis])) axis = k;
    return x.cross(Vec3::Unit(axis)).normalized();
}

namespace {

bool needs_axis(JointType type) {
    return type == JointType::hinge || type == JointType::slider || type == JointType::universal ||
           type == JointType::cylindrical || type == JointType::planar;
}

bool needs_anchor(JointType type) {
    return type != JointType::fixed && type != JointType::slider && type != JointType::planar;
}

/// The frame with these axes x and y, which are square to each other and of unit length.
Quat frame_of(const Vec3& x, const Vec3& y) {
    Mat3 axes;
    axes.col(0) = x;
    axes.col(1) = y;
    axes.col(2) = x.cross(y);
    return Quat(axes).normalized();
}

Quat frame_about(const Vec3& x) {
    const Vec3 z = across(x);
    return frame_of(x, z.cross(x));
}

double angle_between(const Vec3& a, const Vec3& b) { return atan2_stable(a.cross(b).norm(), a.dot(b)); }

/// The places in the world at the start.
struct Places {
    Vec3 anchor_first = Vec3::Zero(), anchor_second = Vec3::Zero();
    Quat frame_first = Quat::Identity(), frame_second = Quat::Identity();
};

class PlaceReader {
public:
    PlaceReader(const TomlTable& table, const std::vector<BodyDescription>& bodies, bool snap,
                const JointDescription& joint)
        : table_(table),
          bodies_(bodies),
          joint_(joint),
          snap_(snap),
          first_(start_pose(bodies, joint.first)),
          second_(start_pose(bodies, joint.second)) {}

    Places read() {
        read_frame();
        read_anchors();
        read_axes();
        return places_;
    }

private:
    void exclude(const char* one, const char* other) const {
        if (table_.has(one) && table_.has(other))
            table_.find(one)->origin().fail(fmt::format("and {} exclude each other: give one of them", other));
    }

    void read_frame() {
        JointFrame frame = JointFrame::world;
        table_.read<JointFrame>("frame", frame, choices<JointFrame>);
        if (frame == JointFrame::first) given_in_ = first_;
        if (frame == JointFrame::second) given_in_ = second_;
        if (table_.has("frame") && !table_.has("anchor") && !table_.has("axis"))
            table_.find("frame")->origin().fail("is the frame of anchor and axis, and there is neither");
    }

    void read_anchors() {
        exclude("anchors", "anchor");
        if (const auto pair = table_.find("anchors")) {
            const auto anchor = pair->items(2, "points, one in the frame of each body");
            places_.anchor_first = first_.point(anchor[0].vector(limits::coordinate));
            places_.anchor_second = second_.point(anchor[1].vector(limits::coordinate));
        } else if (joint_.type == JointType::distance) {
            table_.require("anchors");
        } else {
            Vec3 anchor = joint_.second ? second_.position : first_.position;
            if (const auto given = table_.find("anchor"))
                anchor = given_in_.point(given->vector(limits::coordinate));
            else if (needs_anchor(joint_.type))
                table_.require("anchor");
            places_.anchor_first = places_.anchor_second = anchor;
        }
    }

    void read_axes() {
        exclude("axes", "axis");
        exclude("axes", "second_axis");
        if (const auto pair = table_.find("axes")) {
            const auto axis = pair->items(2, "directions, one in the frame of each body");
            set_axes(*pair, first_.rotation * axis[0].direction(), second_.rotation * axis[1].direction());
            return;
        }
        if (!table_.has("axis")) {
            if (needs_axis(joint_.type)) table_.require("axis");
            for (const char* key : {"second_axis", "swing", "twist"})
                if (const auto value = table_.find(key)) value->origin().fail("needs an axis (not given)");
            return;
        }
        const Vec3 x = given_in_.rotation * table_.require("axis").direction();
        places_.frame_first = frame_about(x);
        const bool universal = joint_.type == JointType::universal;
        if (universal || table_.has("second_axis")) {
            const TomlValue second = table_.require("second_axis");
            const Vec3 y = given_in_.rotation * second.direction();
            check_square(second, x, y);
            places_.frame_first = frame_of(x, x.cross(y).normalized().cross(x));
        }
        places_.frame_second = places_.frame_first;
    }

    void check_square(const TomlValue& value, const Vec3& x, const Vec3& y) const {
        if (std::fabs(x.dot(y)) <= limits::axis_tolerance) return;
        value.origin().fail(fmt::format(
            "{} square to each other: give axes with an angle of 90 degrees (given one of {:.6g} degrees)",
            value.origin().name == "axes" ? "must be" : "and axis must be", angle_between(x, y) * 180.0 / pi));
    }

    void set_axes(const TomlValue& pair, const Vec3& first, const Vec3& second) {
        if (joint_.type == JointType::universal) {
            check_square(pair, first, second);
            const Vec3 z = first.cross(second).normalized();
            places_.frame_first = frame_of(first, z.cross(first));
            places_.frame_second = frame_of(second.cross(z), second);
            return;
        }
        const double angle = angle_between(first, second);
        if (needs_axis(joint_.type) && angle > limits::axis_tolerance && !snap_) {
            pair.origin().fail(
                fmt::format("must be parallel at the start: give one axis, or snap = true (given an angle of {:.6g} "
                            "degrees between them)",
                            angle * 180.0 / pi));
        }
        places_.frame_first = frame_about(first);
        places_.frame_second = (rotation_between(first, second) * places_.frame_first).normalized();
    }

    const TomlTable& table_;
    const std::vector<BodyDescription>& bodies_;
    const JointDescription& joint_;
    bool snap_;
    SidePose first_, second_, given_in_;
    Places places_;
};

/// Swing of x as a rotation vector, as of a joint with three free angles; its twist is zero by construction.
std::array<double, 3> start_turn(const Places& places) {
    const Vec3 x1 = places.frame_first * Vec3::UnitX(), x2 = places.frame_second * Vec3::UnitX();
    const Vec3 normal = x1.cross(x2);
    const double sine = normal.norm();
    if (sine == 0.0) return {0.0, x1.dot(x2) < 0.0 ? pi : 0.0, 0.0};
    const Vec3 swing = places.frame_first.conjugate() * (normal * (angle_between(x1, x2) / sine));
    return {0.0, swing.y(), swing.z()};
}

/// Distance of the anchors along the directions in which the joint does not slide, m.
double gap_of(JointType type, const Vec3& apart) {
    switch (type) {
        case JointType::slider:
        case JointType::cylindrical:
            return hypotenuse(apart.y(), apart.z());
        case JointType::planar:
            return std::fabs(apart.x());
        case JointType::distance:
        case JointType::six_dof:
            return 0.0;  // checked with its lengths, and with its coordinates
        default:
            return apart.norm();
    }
}

/// Turns and moves the first frame back, so that the coordinates have the given values at the start.
void apply_start(const TomlTable& table, Places& places, StartCoordinates& start) {
    if (const auto angle = table.find("start_angle")) {
        start.turn[0] = angle->number(limits::half_turn) * pi / 180.0;
        const SinCos half = sincos(-0.5 * start.turn[0]);
        places.frame_first = (places.frame_first * Quat(half.cos, half.sin, 0.0, 0.0)).normalized();
    }
    if (const auto position = table.find("start_position")) {
        if (const auto anchors = table.find("anchors"))
            position->origin().fail("and anchors exclude each other: the place of the anchors gives the start");
        start.move[0] = position->number(limits::coordinate);
        places.anchor_first -= places.frame_first * Vec3(start.move[0], 0.0, 0.0);
    }
}

void set_frames(const Places& places, const std::vector<BodyDescription>& bodies, JointDescription& joint) {
    const SidePose first = start_pose(bodies, joint.first), second = start_pose(bodies, joint.second);
    joint.anchor_first = first.local_point(places.anchor_first);
    joint.anchor_second = second.local_point(places.anchor_second);
    joint.frame_first = first.local_rotation(places.frame_first);
    joint.frame_second = second.local_rotation(places.frame_second);
}

double size_of(const BodyDescription& body) {
    const Bounds bounds = local_bounds(body.shape);
    return bounds.empty() ? infinity : bounds.extent().maxCoeff();
}

}  // namespace

SidePose start_pose(const std::vector<BodyDescription>& bodies, const std::optional<std::size_t>& body) {
    if (!body) return {};
    return {bodies[*body].position, bodies[*body].rotation};
}

void set_place(const JointPlace& place, const std::vector<BodyDescription>& bodies, JointDescription& joint) {
    const Quat frame = frame_of(place.x, place.y);
    set_frames({place.anchor, place.anchor, frame, frame}, bodies, joint);
}

double smaller_size(const std::vector<BodyDescription>& bodies, const JointDescription& joint) {
    double size = infinity;
    for (const auto& side : {joint.first, joint.second})
        if (side) size = std::min(size, size_of(bodies[*side]));
    return size;
}

StartCoordinates read_places(const TomlTable& table, const std::vector<BodyDescription>& bodies, bool snap,
                             JointDescription& joint) {
    Places places = PlaceReader(table, bodies, snap, joint).read();
    StartCoordinates start;
    if (const auto anchors = table.find("anchors")) {
        const Vec3 apart = places.frame_first.conjugate() * (places.anchor_second - places.anchor_first);
        const double gap = gap_of(joint.type, apart);
        if (!snap && gap > limits::anchor_tolerance * smaller_size(bodies, joint)) {
            anchors->origin().fail(fmt::format(
                "must meet at the start: give one anchor, or snap = true (given points {:.6g} m apart)", gap));
        }
        start.move = {apart.x(), apart.y(), apart.z()};
        if (joint.type == JointType::distance) start.move = {apart.norm(), 0.0, 0.0};
    }
    start.turn = start_turn(places);
    apply_start(table, places, start);
    set_frames(places, bodies, joint);
    return start;
}

}  // namespace tumble
