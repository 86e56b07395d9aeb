// Conversions and shapes of Bullet for the worlds of rigid bodies and of multibodies.
#pragma once

#include "harness/scene.h"

#include <btBulletDynamicsCommon.h>

#include <memory>
#include <vector>

namespace tumble::bench {

inline btVector3 vec(const Vector& v) { return {btScalar(v.x), btScalar(v.y), btScalar(v.z)}; }
inline btQuaternion quat(const Orientation& q) { return {btScalar(q.x), btScalar(q.y), btScalar(q.z), btScalar(q.w)}; }
inline btTransform pose(const Orientation& q, const Vector& position) { return btTransform(quat(q), vec(position)); }
inline Vector vector(const btVector3& v) { return {v.x(), v.y(), v.z()}; }
inline Orientation orientation(const btQuaternion& q) { return {q.w(), q.x(), q.y(), q.z()}; }

/// Owns the shapes of a world.
class BulletShapes {
public:
    btCollisionShape* make(const Body& body);

private:
    std::vector<std::unique_ptr<btCollisionShape>> shapes_;
};

}  // namespace tumble::bench
