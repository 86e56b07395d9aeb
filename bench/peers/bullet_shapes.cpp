#include "peers/bullet_shapes.h"

namespace tumble::bench {

btCollisionShape* BulletShapes::make(const Body& body) {
    std::unique_ptr<btCollisionShape> shape;
    if (body.kind == Kind::plane) shape = std::make_unique<btStaticPlaneShape>(vec(body.normal), btScalar(body.offset));
    if (body.kind == Kind::box) shape = std::make_unique<btBoxShape>(vec(0.5 * body.size));
    if (body.kind == Kind::sphere) shape = std::make_unique<btSphereShape>(btScalar(body.radius));
    if (body.kind == Kind::hexahedron) {
        auto hull = std::make_unique<btConvexHullShape>();
        for (const Vector& corner : body.corners) hull->addPoint(vec(corner));
        hull->setMargin(btScalar(0.001));  // the hull grows by this margin; default 4 cm
        shape = std::move(hull);
    }
    if (body.kind == Kind::compound) {
        auto whole = std::make_unique<btCompoundShape>();
        for (const BoxPart& part : body.parts) {
            shapes_.push_back(std::make_unique<btBoxShape>(vec(0.5 * part.size)));
            whole->addChildShape(pose(part.orientation, part.position), shapes_.back().get());
        }
        shape = std::move(whole);
    }
    shapes_.push_back(std::move(shape));
    return shapes_.back().get();
}

}  // namespace tumble::bench
