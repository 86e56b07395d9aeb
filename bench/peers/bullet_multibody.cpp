#include "peers/bullet_multibody.h"

#include "harness/joints.h"
#include "peers/bullet_shapes.h"

#include <BulletDynamics/Featherstone/btMultiBody.h>
#include <BulletDynamics/Featherstone/btMultiBodyConstraintSolver.h>
#include <BulletDynamics/Featherstone/btMultiBodyDynamicsWorld.h>
#include <BulletDynamics/Featherstone/btMultiBodyFixedConstraint.h>
#include <BulletDynamics/Featherstone/btMultiBodyJointFeedback.h>
#include <BulletDynamics/Featherstone/btMultiBodyJointLimitConstraint.h>
#include <BulletDynamics/Featherstone/btMultiBodyJointMotor.h>
#include <BulletDynamics/Featherstone/btMultiBodyLinkCollider.h>
#include <BulletDynamics/Featherstone/btMultiBodyPoint2Point.h>

#include <algorithm>
#include <map>

namespace tumble::bench {
namespace {

using Node = JointForest::Node;

// Where a body is: a multibody, and a link of it or its base (-1).
struct Place {
    btMultiBody* multibody = nullptr;
    int link = -1;
};

class MultibodySimulator : public Simulator {
public:
    MultibodySimulator(const Scene& scene, double rate, const MultibodySettings& settings)
        : scene_(scene),
          settings_(settings),
          h_(1.0 / rate),
          dispatcher_(&configuration_),
          world_(&dispatcher_, &broad_phase_, &solver_, &configuration_),
          places_(scene.bodies.size()),
          joint_of_(scene.bodies.size(), the_world),
          feedback_(scene.bodies.size()) {
        world_.getSolverInfo().m_jointFeedbackInWorldSpace = true;
        world_.setGravity(vec({0.0, 0.0, -scene.gravity}));
        world_.getSolverInfo().m_restitutionVelocityThreshold = 0.0f;
        world_.getSolverInfo().m_numIterations = settings.iterations;
        const JointForest forest = forest_of(scene);
        for (std::size_t k = 0; k < forest.nodes.size();) {  // tree by tree
            std::size_t end = k;
            while (end < forest.nodes.size() && forest.nodes[end].root == forest.nodes[k].root) ++end;
            add_tree({forest.nodes.begin() + long(k), forest.nodes.begin() + long(end)});
            k = end;
        }
        for (std::size_t i = 0; i < scene.bodies.size(); ++i)
            if (!scene.bodies[i].moves()) add_fixed(scene.bodies[i]);
        for (const std::size_t j : forest.loops) close_loop(scene.joints[j]);
        read_velocities();
    }
    ~MultibodySimulator() override {
        for (const auto& c : constraints_) world_.removeMultiBodyConstraint(c.get());
        for (const auto& m : multibodies_) world_.removeMultiBody(m.get());
        for (const auto& c : colliders_) world_.removeCollisionObject(c.get());
        for (const auto& f : fixed_) world_.removeRigidBody(f.get());
    }

    void step() override {
        if (scene_.has_forces()) push();
        world_.stepSimulation(btScalar(h_), 0, btScalar(h_));
        fresh_ = false;
    }

    Motion motion(std::size_t i) const override {
        if (!fresh_) read_velocities();
        const auto& [m, link] = places_[i];
        const btTransform at = link < 0 ? m->getBaseWorldTransform() : m->getLink(link).m_cachedWorldTransform;
        const auto& [velocity, spin] = velocities_.at(m)[std::size_t(link + 1)];
        const btMatrix3x3& turn = at.getBasis();
        return {vector(at.getOrigin()), orientation(at.getRotation()), vector(turn * velocity), vector(turn * spin)};
    }

    // At the end of the step, of trees without constraints. The report of a step counts centrifugal forces twice.
    std::optional<Vector> joint_force(std::size_t joint) const override {
        for (const std::size_t body : {scene_.joints[joint].first, scene_.joints[joint].second}) {
            if (is_fixed(scene_, body) || joint_of_[body] != joint) continue;
            compute_forces(*places_[body].multibody);
            const btVector3& force = feedback_[body].m_reactionForces.m_topVec;
            return vector(body == scene_.joints[joint].second ? force : -force);
        }
        return std::nullopt;  // it closes a loop
    }

private:
    void compute_forces(btMultiBody& m) const {
        for (int i = 0; i < m.getNumLinks(); ++i) m.addLinkForce(i, m.getLinkMass(i) * world_.getGravity());
        btAlignedObjectArray<btScalar> numbers;
        btAlignedObjectArray<btVector3> vectors;
        btAlignedObjectArray<btMatrix3x3> matrices;
        m.computeAccelerationsArticulatedBodyAlgorithmMultiDof(0, numbers, vectors, matrices, false, true, false);
        m.clearForcesAndTorques();
    }

    // Forces of the start of the step.
    void push() {
        for (std::size_t i = 0; i < places_.size(); ++i) {
            const auto& [m, link] = places_[i];
            if (!m) continue;
            const Wrench w = wrench(scene_, i, motion(i));
            if (link < 0) {
                m->addBaseForce(vec(w.force));
                m->addBaseTorque(vec(w.torque));
            } else {
                m->addLinkForce(link, vec(w.force));
                m->addLinkTorque(link, vec(w.torque));
            }
        }
    }

    // The base is the first body; or it is fixed to the world at the joint of the first body.
    void add_tree(const std::vector<Node>& nodes) {
        const bool grounded = nodes[0].joint != the_world;
        const Body& first = scene_.bodies[nodes[0].body];
        const int links = int(nodes.size()) - (grounded ? 0 : 1);
        auto made = grounded ? std::make_unique<btMultiBody>(links, btScalar(0), btVector3(0, 0, 0), true, false)
                             : std::make_unique<btMultiBody>(links, btScalar(first.mass),
                                                             vec(first.principal_inertia()), false, false);
        btMultiBody& m = *made;
        multibodies_.push_back(std::move(made));
        int link = grounded ? 0 : -1;
        for (const Node& node : nodes) {
            places_[node.body] = {&m, link};
            if (link >= 0) set_link(m, link, node);
            if (link >= 0 && scene_.breaks_watched) {
                joint_of_[node.body] = node.joint;
                m.getLink(link).m_jointFeedback = &feedback_[node.body];
            }
            ++link;
        }
        m.setBaseWorldTransform(grounded ? btTransform::getIdentity() : pose(first.orientation, first.position));
        m.finalizeMultiDof();
        if (!grounded) {
            m.setBaseVel(vec(first.velocity));
            m.setBaseOmega(vec(first.angular_velocity));
        }
        m.setLinearDamping(0);
        m.setAngularDamping(0);
        m.setUseGyroTerm(true);
        m.setCanSleep(false);
        m.setHasSelfCollision(true);
        m.useRK4Integration(settings_.rk4);
        m.useGlobalVelocities(false);
        m.setMaxAppliedImpulse(BT_LARGE_FLOAT);
        m.setMaxCoordinateVelocity(BT_LARGE_FLOAT);  // default 100 rad/s
        world_.addMultiBody(&m);
        for (const Node& node : nodes) {
            const int at = places_[node.body].link;
            if (at >= 0) set_motion(m, at, node);
            add_collider(m, at, scene_.bodies[node.body]);  // constraints on links without one are not solved
        }
        btAlignedObjectArray<btQuaternion> scratch_q;
        btAlignedObjectArray<btVector3> scratch_v;
        m.forwardKinematics(scratch_q, scratch_v);
        m.updateCollisionObjectWorldTransforms(scratch_q, scratch_v);
    }

    void set_link(btMultiBody& m, int link, const Node& node) {
        const Body& body = scene_.bodies[node.body];
        const Joint& joint = scene_.joints[node.joint];
        const btTransform here = pose(body.orientation, body.position),
                          there = node.parent == the_world ? btTransform::getIdentity()
                                                           : pose(scene_.bodies[node.parent].orientation,
                                                                  scene_.bodies[node.parent].position);
        const int parent = node.parent == the_world ? -1 : places_[node.parent].link;
        const btQuaternion to_this = here.getRotation().inverse() * there.getRotation();
        const btVector3 anchor = vec(joint.anchor), pivot = there.inverse() * anchor,
                        center = -(here.inverse() * anchor),
                        axis = here.getBasis().transpose() * vec(axis_for(joint, node.body)),
                        inertia = vec(body.principal_inertia());
        const btScalar mass = btScalar(body.mass);
        if (joint.kind == JointKind::ball)
            m.setupSpherical(link, mass, inertia, parent, to_this, pivot, center, !joint.collide);
        if (joint.kind == JointKind::hinge)
            m.setupRevolute(link, mass, inertia, parent, to_this, axis, pivot, center, !joint.collide);
        if (joint.kind == JointKind::slider)
            m.setupPrismatic(link, mass, inertia, parent, to_this, axis, pivot, center, !joint.collide);
        if (joint.kind == JointKind::fixed) m.setupFixed(link, mass, inertia, parent, to_this, pivot, center);
    }

    // The link's velocity relative to its parent, limits and motor.
    void set_motion(btMultiBody& m, int link, const Node& node) {
        const Joint& joint = scene_.joints[node.joint];
        const Vector axis = axis_for(joint, node.body),
                     spin = spin_of(scene_, node.body) - spin_of(scene_, node.parent),
                     slip =
                         velocity_at(scene_, node.body, joint.anchor) - velocity_at(scene_, node.parent, joint.anchor);
        if (joint.kind == JointKind::ball) {
            const Vector local = rotate_back(scene_.bodies[node.body].orientation, spin);
            btScalar speed[3] = {btScalar(local.x), btScalar(local.y), btScalar(local.z)};
            m.setJointVelMultiDof(link, speed);
        }
        if (joint.kind == JointKind::hinge) m.setJointVel(link, btScalar(dot(axis, spin)));
        if (joint.kind == JointKind::slider) m.setJointVel(link, btScalar(dot(axis, slip)));
        if (joint.limits)
            add(std::make_unique<btMultiBodyJointLimitConstraint>(&m, link, btScalar((*joint.limits)[0]),
                                                                  btScalar((*joint.limits)[1])));
        if (joint.speed)
            add(std::make_unique<btMultiBodyJointMotor>(&m, link, btScalar(*joint.speed),
                                                        btScalar(joint.strength * h_)));
    }

    void add_collider(btMultiBody& m, int link, const Body& body) {
        auto made = std::make_unique<btMultiBodyLinkCollider>(&m, link);
        made->setCollisionShape(shapes_.make(body));
        made->setWorldTransform(pose(body.orientation, body.position));
        made->setFriction(btScalar(std::sqrt(body.friction)));
        made->setRestitution(btScalar(body.restitution));
        (link < 0 ? m.setBaseCollider(made.get()) : void(m.getLink(link).m_collider = made.get()));
        world_.addCollisionObject(made.get(), btBroadphaseProxy::DefaultFilter,
                                  scene_.contacts ? btBroadphaseProxy::AllFilter : 0);
        colliders_.push_back(std::move(made));
    }

    void add_fixed(const Body& body) {
        btRigidBody::btRigidBodyConstructionInfo info(0, nullptr, shapes_.make(body));
        info.m_startWorldTransform = pose(body.orientation, body.position);
        info.m_friction = btScalar(std::sqrt(body.friction));
        info.m_restitution = 1;
        fixed_.push_back(std::make_unique<btRigidBody>(info));
        world_.addRigidBody(fixed_.back().get());
    }

    void add(std::unique_ptr<btMultiBodyConstraint> made) {
        world_.addMultiBodyConstraint(made.get());
        made->finalizeMultiDof();
        constraints_.push_back(std::move(made));
    }

    // A ball: a point. A hinge: two points on its axis, as far apart as the smaller body is long.
    void close_loop(const Joint& joint) {
        std::size_t a = joint.first, b = joint.second;
        if (is_fixed(scene_, a)) std::swap(a, b);
        const Place& at = places_[a];
        const auto local = [&](std::size_t body, const Vector& point) {
            return pose(scene_.bodies[body].orientation, scene_.bodies[body].position).inverse() * vec(point);
        };
        const auto hold = [&](const Vector& point) {
            if (is_fixed(scene_, b)) {
                add(std::make_unique<btMultiBodyPoint2Point>(at.multibody, at.link, &btTypedConstraint::getFixedBody(),
                                                             local(a, point), vec(point)));
                return;
            }
            add(std::make_unique<btMultiBodyPoint2Point>(at.multibody, at.link, places_[b].multibody, places_[b].link,
                                                         local(a, point), local(b, point)));
        };
        double half = scene_.bodies[a].reach();
        if (!is_fixed(scene_, b)) half = std::min(half, scene_.bodies[b].reach());
        const Vector axis = half / norm(joint.axis) * joint.axis;
        if (joint.kind == JointKind::ball) hold(joint.anchor);
        if (joint.kind == JointKind::hinge)
            for (const double side : {-1.0, 1.0}) hold(joint.anchor + side * axis);
    }

    void read_velocities() const {
        for (const auto& m : multibodies_) {
            auto& rows = velocities_[m.get()];
            rows.resize(std::size_t(m->getNumLinks()) + 1);
            btAlignedObjectArray<btVector3> spin, velocity;
            btAlignedObjectArray<btQuaternion> scratch_q;
            btAlignedObjectArray<btVector3> scratch_v;
            m->forwardKinematics(scratch_q, scratch_v);  // after a step the poses of the links are those of its start
            spin.resize(m->getNumLinks() + 1);
            velocity.resize(m->getNumLinks() + 1);
            m->compTreeLinkVelocities(&spin[0], &velocity[0]);
            for (int i = 0; i <= m->getNumLinks(); ++i) rows[std::size_t(i)] = {velocity[i], spin[i]};
        }
        fresh_ = true;
    }

    Scene scene_;
    MultibodySettings settings_;
    double h_;
    btDefaultCollisionConfiguration configuration_;
    btCollisionDispatcher dispatcher_;
    btDbvtBroadphase broad_phase_;
    btMultiBodyConstraintSolver solver_;
    btMultiBodyDynamicsWorld world_;
    std::vector<Place> places_;
    std::vector<std::size_t> joint_of_;               // that a body hangs on, where its force is asked for
    std::vector<btMultiBodyJointFeedback> feedback_;  // by body
    BulletShapes shapes_;
    std::vector<std::unique_ptr<btMultiBody>> multibodies_;
    std::vector<std::unique_ptr<btMultiBodyLinkCollider>> colliders_;
    std::vector<std::unique_ptr<btRigidBody>> fixed_;
    std::vector<std::unique_ptr<btMultiBodyConstraint>> constraints_;
    // Velocities of the base and the links, in their own frames, m/s and rad/s; read after a step when it is asked for.
    mutable std::map<const btMultiBody*, std::vector<std::pair<btVector3, btVector3>>> velocities_;
    mutable bool fresh_ = false;
};

}  // namespace

std::unique_ptr<Simulator> make_bullet_multibody(const Scene& scene, double rate, const MultibodySettings& settings) {
    if (has_kind(scene, JointKind::distance) || has_cones(scene) || needs_breaking(scene)) return nullptr;
    for (const std::size_t j : forest_of(scene).loops)
        if (scene.joints[j].kind != JointKind::ball && scene.joints[j].kind != JointKind::hinge) return nullptr;
    return std::make_unique<MultibodySimulator>(scene, rate, settings);
}

}  // namespace tumble::bench
