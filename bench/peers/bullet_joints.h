// Joints as constraints between Bullet's rigid bodies.
#pragma once

#include "harness/joints.h"
#include "peers/bullet_shapes.h"

namespace tumble::bench {

/// True if Bullet's constraints can represent all joints: all but distances.
bool bullet_can_join(const Scene& scene);

/// The constraint of a joint between `first` and `second`, the scene's bodies; h: the step, s.
std::unique_ptr<btTypedConstraint> constraint_of(const Joint& joint, btRigidBody& first, btRigidBody& second, double h);

}  // namespace tumble::bench
