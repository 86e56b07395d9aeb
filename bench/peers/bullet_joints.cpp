#include "peers/bullet_joints.h"

namespace tumble::bench {
namespace {

// A frame at the anchor with the given axis as x or z, relative to the body as it lies at the start.
btTransform frame_in(const btRigidBody& body, const Joint& joint, const btVector3& unit) {
    const btVector3 axis = vec(joint.axis).normalized();
    const btScalar c = unit.dot(axis);
    btQuaternion turn(unit.x() == 0 ? 1 : 0, unit.x() == 0 ? 0 : 1, 0, 0);  // half a turn, if the axis is opposite
    if (c > btScalar(-0.9999999)) turn = shortestArcQuat(unit, axis);
    return body.getWorldTransform().inverse() * btTransform(turn, vec(joint.anchor));
}

std::unique_ptr<btTypedConstraint> hinge(const Joint& joint, btRigidBody& a, btRigidBody& b, double h) {
    const btVector3 z(0, 0, 1);
    // With the reference frame of A the angle is that of B relative to A.
    auto made = std::make_unique<btHingeConstraint>(a, b, frame_in(a, joint, z), frame_in(b, joint, z), true);
    if (joint.limits) made->setLimit(btScalar((*joint.limits)[0]), btScalar((*joint.limits)[1]));
    if (joint.speed) made->enableAngularMotor(true, btScalar(*joint.speed), btScalar(joint.strength * h));
    return made;
}

std::unique_ptr<btTypedConstraint> slider(const Joint& joint, btRigidBody& a, btRigidBody& b) {
    const btVector3 x(1, 0, 0);
    auto made = std::make_unique<btSliderConstraint>(a, b, frame_in(a, joint, x), frame_in(b, joint, x), true);
    const auto [lower, upper] = joint.limits.value_or(std::array<double, 2>{1.0, -1.0});  // lower > upper: free
    made->setLowerLinLimit(btScalar(lower));
    made->setUpperLinLimit(btScalar(upper));
    made->setLowerAngLimit(0);
    made->setUpperAngLimit(0);
    if (joint.speed) {
        made->setPoweredLinMotor(true);
        made->setTargetLinMotorVelocity(btScalar(*joint.speed));
        made->setMaxLinMotorForce(btScalar(joint.strength));
    }
    return made;
}

std::unique_ptr<btTypedConstraint> ball(const Joint& joint, btRigidBody& a, btRigidBody& b) {
    const btVector3 x(1, 0, 0);
    const btTransform in_a = frame_in(a, joint, x), in_b = frame_in(b, joint, x);
    if (!joint.cone) return std::make_unique<btPoint2PointConstraint>(a, b, in_a.getOrigin(), in_b.getOrigin());
    auto made = std::make_unique<btConeTwistConstraint>(a, b, in_a, in_b);
    made->setLimit(btScalar(*joint.cone), btScalar(*joint.cone), BT_LARGE_FLOAT);
    return made;
}

}  // namespace

bool bullet_can_join(const Scene& scene) { return !has_kind(scene, JointKind::distance); }

std::unique_ptr<btTypedConstraint> constraint_of(const Joint& joint, btRigidBody& first, btRigidBody& second,
                                                 double h) {
    std::unique_ptr<btTypedConstraint> made;
    const btVector3 x(1, 0, 0);
    if (joint.kind == JointKind::ball) made = ball(joint, first, second);
    if (joint.kind == JointKind::hinge) made = hinge(joint, first, second, h);
    if (joint.kind == JointKind::slider) made = slider(joint, first, second);
    if (joint.kind == JointKind::fixed)
        made =
            std::make_unique<btFixedConstraint>(first, second, frame_in(first, joint, x), frame_in(second, joint, x));
    if (joint.break_force > 0.0) made->setBreakingImpulseThreshold(btScalar(joint.break_force * h));
    return made;
}

}  // namespace tumble::bench
