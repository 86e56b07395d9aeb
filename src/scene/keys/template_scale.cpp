#include "scene/keys/template_scale.h"

#include "sim/geometry/shapes/shape.h"

#include <cmath>

namespace tumble {
namespace {

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
    joint.break_force *= mass;
    joint.break_torque *= mass * scale;
    joint.break_impulse *= mass * time;
}

}  // namespace

void enlarge(SceneTemplate& content, double scale, double mass_factor, MeshCache& meshes) {
    const bool keeps_density = mass_factor == scale * scale * scale;
    for (BodyDescription& body : content.bodies) {
        if (body.type == BodyType::dynamic && (body.mass || !keeps_density))
            body.mass = mass_properties(body).mass * mass_factor;
        if (scale == 1.0) continue;
        body.shape = meshes.enlarged(body.shape, scale);
        body.position *= scale;
        for (Keyframe& key : body.keyframes) key.position *= scale;
    }
    for (JointDescription& joint : content.joints) {
        const auto length = [&](std::size_t of) { return content.joints[of].type == JointType::slider ? scale : 1.0; };
        const bool gear = joint.type == JointType::gear;
        enlarge_joint(joint, scale, mass_factor, gear ? length(joint.geared[0]) / length(joint.geared[1]) : 1.0);
    }
}

}  // namespace tumble
