// DART 6.12: semi-implicit Euler, its own collision detector, Dantzig's solver.
#include "harness/joints.h"
#include "peers/peer.h"

#include <dart/dart.hpp>

namespace {

using namespace tumble::bench;
using dart::dynamics::FreeJoint;
using SceneJoint = tumble::bench::Joint;

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
        bodies_.resize(scene.bodies.size());
        joint_of_.assign(scene.bodies.size(), the_world);
        for (std::size_t i = 0; i < scene.bodies.size(); ++i)
            if (!scene.bodies[i].moves()) add_fixed(i);
        const JointForest forest = forest_of(scene);
        for (const JointForest::Node& node : forest.nodes) add(node);
        for (const auto& skeleton : skeletons_) {
            if (!scene.joints.empty()) skeleton->enableSelfCollisionCheck();  // but not of a body with its parent
            world_->addSkeleton(skeleton);
        }
        for (const std::size_t j : forest.loops) close_loop(scene.joints[j]);
    }

    void step() override {
        if (scene_.has_forces()) {
            for (std::size_t i = 0; i < bodies_.size(); ++i) {
                if (!scene_.bodies[i].moves()) continue;
                const Wrench w = wrench(scene_, i, motion(i));
                bodies_[i]->addExtForce(vec(w.force), Eigen::Vector3d::Zero(), false, true);
                bodies_[i]->addExtTorque(vec(w.torque), false);
            }
        }
        for (const auto& [joint, speed] : motors_) joint->setCommand(0, speed);  // a step clears them
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

    // At the end of the step; the force of a body's joint acts on it.
    std::optional<Vector> joint_force(std::size_t joint) const override {
        for (const std::size_t body : {scene_.joints[joint].first, scene_.joints[joint].second}) {
            if (is_fixed(scene_, body) || joint_of_[body] != joint) continue;
            bodies_[body]->getSkeleton()->computeForwardDynamics();
            const Eigen::Vector3d force =
                bodies_[body]->getWorldTransform().linear() * bodies_[body]->getBodyForce().tail<3>();
            return vector((body == scene_.joints[joint].second ? 1.0 : -1.0) * force);
        }
        return std::nullopt;  // it closes a loop
    }

private:
    using Place = Eigen::Isometry3d;
    using BodyNode = dart::dynamics::BodyNode;

    static Place place_of(const Body& body) {
        Place place = Place::Identity();
        const Orientation& q = body.orientation;
        place.translation() = vec(body.position);
        place.linear() = Eigen::Quaterniond(q.w, q.x, q.y, q.z).matrix();
        return place;
    }

    dart::dynamics::SkeletonPtr new_skeleton() {  // without a name it prints warnings
        skeletons_.push_back(dart::dynamics::Skeleton::create(std::to_string(skeletons_.size())));
        return skeletons_.back();
    }

    void add_fixed(std::size_t i) {
        const Body& body = scene_.bodies[i];
        const auto skeleton = new_skeleton();
        const auto [joint, made] = skeleton->createJointAndBodyNodePair<dart::dynamics::WeldJoint>();
        Place place = place_of(body);
        if (body.kind == Kind::plane) {
            place.translation() = (body.offset - 1.0) * vec(body.normal);
            place.linear() = Eigen::Quaterniond::FromTwoVectors(Eigen::Vector3d::UnitZ(), vec(body.normal)).matrix();
        }
        joint->setTransformFromParentBodyNode(place);
        skeleton->setMobile(false);
        add_shape(made, body);
        bodies_[i] = made;
    }

    void add_shape(BodyNode* node, const Body& body) {
        dart::dynamics::ShapePtr shape;
        if (body.kind == Kind::sphere) shape = std::make_shared<dart::dynamics::SphereShape>(body.radius);
        if (body.kind == Kind::box) shape = std::make_shared<dart::dynamics::BoxShape>(vec(body.size));
        if (body.kind == Kind::plane)  // the detector has no planes: a slab of 40 m with its upper side on the plane
            shape = std::make_shared<dart::dynamics::BoxShape>(Eigen::Vector3d(40.0, 40.0, 2.0));
        auto* shape_node =
            node->createShapeNodeWith<dart::dynamics::CollisionAspect, dart::dynamics::DynamicsAspect>(shape);
        shape_node->getDynamicsAspect()->setFrictionCoeff(told_friction(scene_, body));
        shape_node->getDynamicsAspect()->setRestitutionCoeff(body.moves() ? body.restitution
                                                                          : 1.0);  // a pair uses the product
    }

    void add(const JointForest::Node& node) {
        const Body& body = scene_.bodies[node.body];
        BodyNode* parent = node.parent == the_world ? nullptr : bodies_[node.parent];
        const auto skeleton = parent ? parent->getSkeleton() : new_skeleton();
        BodyNode* made = nullptr;
        if (node.joint == the_world) {
            const auto [joint, free] = skeleton->createJointAndBodyNodePair<FreeJoint>();
            joint->setTransform(place_of(body));
            joint->setLinearVelocity(vec(body.velocity));
            joint->setAngularVelocity(vec(body.angular_velocity));
            made = free;
        } else {
            made = add_joined(*skeleton, parent, node);
        }
        const Vector i = body.principal_inertia();
        made->setInertia(dart::dynamics::Inertia(body.mass, Eigen::Vector3d::Zero(), vec(i).asDiagonal()));
        if (node.joint != the_world) set_motion(*made->getParentJoint(), node);
        if (scene_.contacts) add_shape(made, body);
        bodies_[node.body] = made;
        joint_of_[node.body] = node.joint;
    }

    // The frame of each joint is that of the world at the start.
    BodyNode* add_joined(dart::dynamics::Skeleton& skeleton, BodyNode* parent, const JointForest::Node& node) {
        using namespace dart::dynamics;
        const SceneJoint& joint = scene_.joints[node.joint];
        const Eigen::Vector3d axis = vec(axis_for(joint, node.body));
        std::pair<dart::dynamics::Joint*, BodyNode*> made;
        const std::string name = std::to_string(node.body);  // names that occur twice print messages
        const BodyNode::Properties properties{BodyNode::AspectProperties(name)};
        const auto create = [&](auto type, auto&& of_joint) {
            of_joint.mName = name;
            using Type = typename decltype(type)::type;
            return std::pair<dart::dynamics::Joint*, BodyNode*>(
                skeleton.createJointAndBodyNodePair<Type>(parent, of_joint, properties));
        };
        if (joint.kind == JointKind::ball) made = create(std::type_identity<BallJoint>{}, BallJoint::Properties{});
        if (joint.kind == JointKind::fixed) made = create(std::type_identity<WeldJoint>{}, WeldJoint::Properties{});
        if (joint.kind == JointKind::hinge) {
            made = create(std::type_identity<RevoluteJoint>{}, RevoluteJoint::Properties{});
            static_cast<RevoluteJoint*>(made.first)->setAxis(axis);
        }
        if (joint.kind == JointKind::slider) {
            made = create(std::type_identity<PrismaticJoint>{}, PrismaticJoint::Properties{});
            static_cast<PrismaticJoint*>(made.first)->setAxis(axis);
        }
        Place at = Place::Identity();
        at.translation() = vec(joint.anchor);
        const Place above = node.parent == the_world ? Place::Identity() : place_of(scene_.bodies[node.parent]);
        made.first->setTransformFromParentBodyNode(above.inverse() * at);
        made.first->setTransformFromChildBodyNode(place_of(scene_.bodies[node.body]).inverse() * at);
        return made.second;
    }

    void set_motion(dart::dynamics::Joint& made, const JointForest::Node& node) {
        const SceneJoint& joint = scene_.joints[node.joint];
        const Vector axis = axis_for(joint, node.body),
                     spin = spin_of(scene_, node.body) - spin_of(scene_, node.parent),
                     slip =
                         velocity_at(scene_, node.body, joint.anchor) - velocity_at(scene_, node.parent, joint.anchor);
        if (joint.kind == JointKind::ball) made.setVelocities(vec(spin));
        if (joint.kind == JointKind::hinge) made.setVelocity(0, dot(axis, spin));
        if (joint.kind == JointKind::slider) made.setVelocity(0, dot(axis, slip));
        if (joint.limits) {
            made.setLimitEnforcement(true);
            made.setPositionLowerLimit(0, (*joint.limits)[0]);
            made.setPositionUpperLimit(0, (*joint.limits)[1]);
        }
        if (joint.speed) {
            made.setActuatorType(dart::dynamics::Joint::SERVO);
            made.setForceUpperLimit(0, joint.strength);
            made.setForceLowerLimit(0, -joint.strength);
            motors_.push_back({&made, *joint.speed});
        }
    }

    // A ball: a point. A hinge: two points on its axis, as far apart as the smaller body is long.
    void close_loop(const SceneJoint& joint) {
        std::size_t a = joint.first, b = joint.second;
        if (is_fixed(scene_, a)) std::swap(a, b);
        BodyNode* other = is_fixed(scene_, b) ? nullptr : bodies_[b];
        const auto solver = world_->getConstraintSolver();
        const auto hold = [&](const Vector& point) {
            using dart::constraint::BallJointConstraint;
            solver->addConstraint(other ? std::make_shared<BallJointConstraint>(bodies_[a], other, vec(point))
                                        : std::make_shared<BallJointConstraint>(bodies_[a], vec(point)));
        };
        const double half = std::min(scene_.bodies[a].reach(), other ? scene_.bodies[b].reach() : HUGE_VAL);
        const Vector axis = half / norm(joint.axis) * joint.axis;
        if (joint.kind == JointKind::ball) hold(joint.anchor);
        if (joint.kind == JointKind::hinge)
            for (const double side : {-1.0, 1.0}) hold(joint.anchor + side * axis);
        if (joint.kind == JointKind::fixed) {
            using dart::constraint::WeldJointConstraint;
            solver->addConstraint(other ? std::make_shared<WeldJointConstraint>(bodies_[a], other)
                                        : std::make_shared<WeldJointConstraint>(bodies_[a]));
        }
    }

    Scene scene_;
    dart::simulation::WorldPtr world_;
    std::vector<dart::dynamics::SkeletonPtr> skeletons_;
    std::vector<dart::dynamics::BodyNode*> bodies_;
    std::vector<std::size_t> joint_of_;                              // that a body hangs on
    std::vector<std::pair<dart::dynamics::Joint*, double>> motors_;  // rad/s or m/s
};

// Boxes and spheres only; no distances, cones, breaking joints, and no sliders that close loops.
bool can_represent(const Scene& scene) {
    for (const Body& body : scene.bodies)
        if (body.kind == Kind::hexahedron || body.kind == Kind::compound) return false;
    if (has_kind(scene, JointKind::distance) || has_cones(scene) || needs_breaking(scene)) return false;
    for (const std::size_t j : forest_of(scene).loops)
        if (scene.joints[j].kind == JointKind::slider) return false;
    return true;
}

Way way(const std::string& name, std::vector<Task> tasks) {
    return {name, std::move(tasks),
            [](const Scene& scene, double rate) -> std::unique_ptr<Simulator> {
                if (!can_represent(scene)) return nullptr;
                return std::make_unique<DartSimulator>(scene, rate, false);
            },
            250};
}

std::unique_ptr<Simulator> make_steady(const Scene& scene, double rate) {
    if (!can_represent(scene)) return nullptr;
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
    using enum JointTask;
    const JointWay joined{"Dantzig",
                          {precision, load, speed},
                          [](const Scene& scene, double rate) -> std::unique_ptr<Simulator> {
                              if (!can_represent(scene)) return nullptr;
                              // A step with more loops takes a minute.
                              if (forest_of(scene).loops.size() > 200) return nullptr;
                              return std::make_unique<DartSimulator>(scene, rate, false);
                          },
                          2000};  // each body resizes dense matrices of the whole tree: 10,000 take hours
    return run_peer(argc, argv,
                    {"DART",
                     {euler},
                     {way("Dantzig", {Task::spheres, Task::tower})},
                     {{"Dantzig", true, make_steady, 60}},
                     {joined}});
}
