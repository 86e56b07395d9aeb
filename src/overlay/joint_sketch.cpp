#include "overlay/joint_sketch.h"

#include "core/deterministic_math.h"
#include "overlay/overlay_builder.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace tumble {
namespace {

// Lengths in sizes of the joint: the radius of its smaller body, or a share of the arm from the body's origin to the
// anchor.
constexpr double half_axis = 0.8, arc_radius = 0.55, rail_end = 0.22, farthest_limit = 100.0, share_of_arm = 0.5;
constexpr double arc_step = pi / 24.0;  // rad, between two points of an arc
constexpr int cone_points = 48, cone_spokes = 4;

class Sketcher {
public:
    Sketcher(const JointDescription& joint, double size, JointSketch& sketch)
        : joint_(joint), size_(size), sketch_(sketch) {}

    void draw() {
        sketch_.anchor = second(Vec3::Zero());
        if (joint_.type == JointType::ball) sketch_.marker = MarkerShape::ring;
        if (joint_.type == JointType::fixed) sketch_.marker = MarkerShape::square;
        if (joint_.type == JointType::distance) return add({first(Vec3::Zero()), sketch_.anchor}, false);
        for (std::size_t k = 0; k < 3; ++k) {
            const Vec3 axis = Vec3::Unit(Eigen::Index(k));
            if (joint_.move[k].motion == JointAxis::Motion::limited) add_rail(axis, joint_.move[k]);
            if (joint_.move[k].motion == JointAxis::Motion::free)
                add({first(-half_axis * axis), first(half_axis * axis)}, false);
            // A ball turns about all axes: only its cone has a direction.
            if (joint_.type == JointType::ball || joint_.turn[k].motion == JointAxis::Motion::locked) continue;
            // x is fixed in the first body, y and z are fixed in the second one.
            const auto side = [&](const Vec3& p) { return k == 0 ? first(p) : second(p); };
            add({side(-half_axis * axis), side(half_axis * axis)}, false);
        }
        if (joint_.turn[0].motion == JointAxis::Motion::limited) add_arc(joint_.turn[0]);
        if (joint_.swing) add_cone(*joint_.swing);
    }

private:
    /// Points in the joint frames, in sizes of the joint.
    SketchPoint first(const Vec3& p) const {
        return {joint_.first, joint_.anchor_first + joint_.frame_first * (size_ * p)};
    }
    SketchPoint second(const Vec3& p) const {
        return {joint_.second, joint_.anchor_second + joint_.frame_second * (size_ * p)};
    }
    void add(std::vector<SketchPoint> points, bool limit) { sketch_.lines.push_back({std::move(points), limit}); }

    void add_rail(const Vec3& axis, const JointAxis& move) {
        const double lower = std::max(move.lower / size_, -farthest_limit),
                     upper = std::min(move.upper / size_, farthest_limit);
        const Vec3 across = rail_end * axis.unitOrthogonal();
        add({first(lower * axis), first(upper * axis)}, true);
        for (const double end : {lower, upper}) add({first(end * axis - across), first(end * axis + across)}, true);
    }

    // From the lower to the upper angle about x, and the second body's y, whose angle it is.
    void add_arc(const JointAxis& turn) {
        const double lower = std::max(turn.lower, -2.0 * pi), upper = std::min(turn.upper, 2.0 * pi);
        const int steps = std::max(1, int(std::ceil((upper - lower) / arc_step)));
        std::vector<SketchPoint> points{first(Vec3::Zero())};
        for (int i = 0; i <= steps; ++i) {
            const SinCos at = sincos(lower + (upper - lower) * i / steps);
            points.push_back(first(arc_radius * Vec3(0.0, at.cos, at.sin)));
        }
        points.push_back(points.front());
        add(std::move(points), true);
        add({second(Vec3::Zero()), second({0.0, arc_radius, 0.0})}, false);
    }

    // The second body's x at the limit of its swing, and that axis.
    void add_cone(const std::array<double, 2>& half_angles) {
        std::vector<SketchPoint> rim;
        for (int i = 0; i <= cone_points; ++i) {
            const SinCos around = sincos(2.0 * pi * i / cone_points);
            const Vec3 swing(0.0, half_angles[0] * around.cos, half_angles[1] * around.sin);  // rotation vector
            const double angle = swing.norm();
            const SinCos turned = sincos(angle);
            const Vec3 across = angle > 0.0 ? Vec3(swing.cross(Vec3::UnitX()) / angle) : Vec3(Vec3::Zero());
            rim.push_back(first(arc_radius * (turned.cos * Vec3::UnitX() + turned.sin * across)));
        }
        for (int i = 0; i < cone_spokes; ++i)
            add({first(Vec3::Zero()), rim[std::size_t(i * cone_points / cone_spokes)]}, true);
        add(std::move(rim), true);
        add({second(Vec3::Zero()), second({arc_radius, 0.0, 0.0})}, false);
    }

    const JointDescription& joint_;
    double size_;  // m
    JointSketch& sketch_;
};

}  // namespace

std::vector<JointSketch> sketch_joints(const SceneDescription& scene) {
    std::vector<JointSketch> sketches;
    const std::vector<char> shown = shown_bodies(scene);
    for (std::size_t k = 0; k < scene.joints.size(); ++k) {
        const JointDescription& joint = scene.joints[k];
        bool shows = false;
        double size = infinity, largest = 0.0;
        const auto look_at = [&](const std::optional<std::size_t>& body, const Vec3& anchor) {
            if (!body) return;
            shows = shows || shown[*body] != 0;
            const double radius = radius_about_origin(scene.bodies[*body].shape);
            largest = std::max(largest, radius);
            if (radius > 0.0) size = std::min(size, std::max(radius, share_of_arm * anchor.norm()));
        };
        look_at(joint.first, joint.anchor_first);
        look_at(joint.second, joint.anchor_second);
        if (!shows || joint.type == JointType::gear) continue;
        JointSketch& sketch = sketches.emplace_back();
        sketch.joint = k;
        sketch.allowance = float(2.0 * largest);
        Sketcher(joint, size < infinity ? size : 1.0, sketch).draw();
    }
    return sketches;
}

}  // namespace tumble
