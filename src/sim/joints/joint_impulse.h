// The impulse of a joint in an impact.
#pragma once

#include "sim/joints/joint.h"

#include <vector>

namespace tumble {

/// Impulses on B, the opposite ones on A, at one point.
struct JointImpulse {
    Joint* joint = nullptr;
    const Joint* at = nullptr;          // the joint whose bodies it acts on: of a gear, one of its two joints
    bool second = false;                // of a gear: its second joint
    Vec3 force = Vec3::Zero();          // N s
    Vec3 torque = Vec3::Zero();         // N m s
    Vec3 point = Vec3::Zero();          // m, world
    double work_a = 0.0, work_b = 0.0;  // J, on each body
    double rotor = 0.0;                 // J, that the joint's armature gains
    double lost = 0.0;                  // J, at the joint's limits: by their mean speeds before and after the impact

    bool breaks = false;  // the joint breaks: its work is heat

    /// How far the impulse exceeds the joint's strength, at most 1 where it holds. A force is the mean over `h` s.
    double over(double h) const;
};

/// Adds the impulses to the momenta, P and L, and to the account of the joint.
void apply_joint_impulse(const JointImpulse& impulse, std::vector<Body>& bodies);

/// The work of the impulse, from the bodies' velocities (after it) and momenta (before it).
void find_work(JointImpulse& impulse, const std::vector<Body>& bodies);

}  // namespace tumble
