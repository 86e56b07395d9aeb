// DART 6.12: semi-implicit Euler, its own collision detector, Dantzig's solver.
#include "peers/peer.h"

#include <dart/dart.hpp>

namespace {

using namespace tumble::bench;
using dart::dynamics::FreeJoint;

Eigen::Vector3d vec(const Vector& v) { return {v.x, v.y, v.z}; }
Vector vector(const Eigen::Vector3d& v) { return {v.x(), v.y(), v.z()}; }

class DartSimulator : public Simulator {
public:
    DartSimulator(const Scene& scene, double rate, bool elastic)
        : scene_(scene), world_(dart::simulation::World::create()) {
        world_->setTimeStep(1.0 / rate);
        world_->setGravity(Eigen::Vector3d(0.0, 0.0, -scene.gravity));
        world_->getConstraintSolver()->setCollisionDetector(dart::collision::DARTCollisionDetector::create());
        world_->getConstraintSolver()->getCollisionOption().maxNumContacts = 100000;
        // Position correction adds energy; 0.01 is the default.
        dart::constraint::ContactConstraint::setErrorReductionParameter(elastic ? 0.0 : 0.01);
        for (const Body& body : scene.bodies) add(body);
    }

    void step() override {
        if (scene_.air || scene_.push) {
            for (std::size_t i = 0; i < bodies_.size(); ++i) {
                if (!scene_.bodies[i].moves()) continue;
                const Wrench w = wrench(scene_, i, motion(i));
                bodies_[i]->addExtForce(vec(w.force), Eigen::Vector3d::Zero(), false, true);
                bodies_[i]->addExtTorque(vec(w.torque), false);
            }
        }
        world_->step();
    }

    Motion motion(std::size_t i) const override {
        const auto* body = bodies_[i];
        const Eigen::Quaterniond q(body->getWorldTransform().linear());
        return {vector(body->getWorldTransform().translation()),
                {q.w(), q.x(), q.y(), q.z()},
                vector(body->getLinearVelocity()),
                vector(body->getAngularVelocity())};
    }

private:
    void add(const Body& body) {
        auto skeleton =
            dart::dynamics::Skeleton::create(std::to_string(bodies_.size()));  // without a name it prints warnings
        dart::dynamics::ShapePtr shape;
        Eigen::Isometry3d place = Eigen::Isometry3d::Identity();
        place.translation() = vec(body.position);
        place.linear() =
            Eigen::Quaterniond(body.orientation.w, body.orientation.x, body.orientation.y, body.orientation.z).matrix();
        if (body.kind == Kind::sphere) shape = std::make_shared<dart::dynamics::SphereShape>(body.radius);
        if (body.kind == Kind::box) shape = std::make_shared<dart::dynamics::BoxShape>(vec(body.size));
        if (body.kind == Kind::plane) {  // the detector has no planes: a slab of 40 m with its upper side on the plane
            shape = std::make_shared<dart::dynamics::BoxShape>(Eigen::Vector3d(40.0, 40.0, 2.0));
            place.translation() = (body.offset - 1.0) * vec(body.normal);
            place.linear() = Eigen::Quaterniond::FromTwoVectors(Eigen::Vector3d::UnitZ(), vec(body.normal)).matrix();
        }
        dart::dynamics::BodyNode* node = nullptr;
        if (body.moves()) {
            const auto [joint, made] = skeleton->createJointAndBodyNodePair<FreeJoint>();
            const Vector i = body.principal_inertia();
            made->setInertia(dart::dynamics::Inertia(body.mass, Eigen::Vector3d::Zero(), vec(i).asDiagonal()));
            joint->setTransform(place);
            joint->setLinearVelocity(vec(body.velocity));
            joint->setAngularVelocity(vec(body.angular_velocity));
            node = made;
        } else {
            const auto [joint, made] = skeleton->createJointAndBodyNodePair<dart::dynamics::WeldJoint>();
            joint->setTransformFromParentBodyNode(place);
            skeleton->setMobile(false);
            node = made;
        }
        auto* shape_node =
            node->createShapeNodeWith<dart::dynamics::CollisionAspect, dart::dynamics::DynamicsAspect>(shape);
        shape_node->getDynamicsAspect()->setFrictionCoeff(told_friction(scene_, body));
        shape_node->getDynamicsAspect()->setRestitutionCoeff(body.moves() ? body.restitution
                                                                          : 1.0);  // a pair uses the product
        world_->addSkeleton(skeleton);
        bodies_.push_back(node);
    }

    Scene scene_;
    dart::simulation::WorldPtr world_;
    std::vector<dart::dynamics::BodyNode*> bodies_;
};

Way way(const std::string& name, std::vector<Task> tasks) {
    return {name, std::move(tasks),
            [](const Scene& scene, double rate) -> std::unique_ptr<Simulator> {
                for (const Body& body : scene.bodies)
                    if (body.kind == Kind::hexahedron || body.kind == Kind::compound)
                        return nullptr;  // boxes and spheres only
                return std::make_unique<DartSimulator>(scene, rate, false);
            },
            250};
}

std::unique_ptr<Simulator> make_steady(const Scene& scene, double rate) {
    bool elastic = false;
    for (const Body& body : scene.bodies) elastic |= body.moves() && body.restitution > 0.0;
    return std::make_unique<DartSimulator>(scene, rate, elastic);
}

}  // namespace

int main(int argc, char** argv) {
    // Thin walls: DART has no continuous collision detection. Impacts below 0.1 m/s never bounce (a constant of the
    // library).
    const Variant euler{"semi-implicit Euler", [](Demand demand) { return demand != Demand::thin_wall; },
                        [](const Scene& scene, double rate) -> std::unique_ptr<Simulator> {
                            return std::make_unique<DartSimulator>(scene, rate, true);
                        }};
    return run_peer(
        argc, argv,
        {"DART", {euler}, {way("Dantzig", {Task::spheres, Task::tower})}, {{"Dantzig", true, make_steady, 60}}});
}
