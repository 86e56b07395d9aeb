// Bullet 3.24, btDiscreteDynamicsWorld, sequential impulses: in double precision, and (contacts alone) in single.
#include "peers/bullet_joints.h"
#include "peers/bullet_multibody.h"
#include "peers/peer.h"

#include <BulletDynamics/MLCPSolvers/btDantzigSolver.h>
#include <BulletDynamics/MLCPSolvers/btMLCPSolver.h>

namespace {

using namespace tumble::bench;

struct Settings {
    int gyroscopic = BT_ENABLE_GYROSCOPIC_FORCE_IMPLICIT_BODY;
    bool swept = false;   // a sphere swept with fast bodies
    bool elastic = true;  // settings for bounces; otherwise for rest
    int iterations = 50;  // default 10
    bool sleep = false;
    bool direct = false;  // Dantzig's solver for all constraints at once, in place of sequential impulses
};

class BulletSimulator : public Simulator {
public:
    BulletSimulator(const Scene& scene, double rate, const Settings& settings)
        : scene_(scene),
          h_(1.0 / rate),
          dispatcher_(&configuration_),
          solver_(solver_of(settings)),
          world_(&dispatcher_, &broad_phase_, solver_.get(), &configuration_) {
        world_.setGravity(vec({0.0, 0.0, -scene.gravity}));
        btContactSolverInfo& info = world_.getSolverInfo();
        info.m_restitutionVelocityThreshold = 0.0f;  // default 0.2 m/s: slower impacts do not bounce
        info.m_numIterations = settings.iterations;
        if (settings.elastic) info.m_erp2 = 0.0f;  // no position correction: that adds energy, up to 40-fold in the pit
        for (const Body& body : scene.bodies) add(body, settings);
        feedback_.resize(scene.joints.size());
        for (const Joint& joint : scene.joints) add(joint);
    }
    ~BulletSimulator() override {
        for (const auto& joint : joints_) world_.removeConstraint(joint.get());
        for (const auto& body : bodies_) world_.removeRigidBody(body.get());
    }

    void step() override {
        if (scene_.has_forces()) {
            for (std::size_t i = 0; i < bodies_.size(); ++i) {
                if (!scene_.bodies[i].moves()) continue;
                const Wrench w = wrench(scene_, i, motion(i));
                bodies_[i]->applyCentralForce(vec(w.force));
                bodies_[i]->applyTorque(vec(w.torque));
            }
        }
        world_.stepSimulation(btScalar(h_), 0, btScalar(h_));  // no substeps: exactly this step
    }

    Motion motion(std::size_t i) const override {
        const btRigidBody& body = *bodies_[i];
        const btTransform& pose = body.getWorldTransform();
        return {vector(pose.getOrigin()), orientation(pose.getRotation()), vector(body.getLinearVelocity()),
                vector(body.getAngularVelocity())};
    }

    std::optional<Vector> joint_force(std::size_t joint) const override {
        return vector(feedback_[joint].m_appliedForceBodyB);
    }

private:
    static std::unique_ptr<btConstraintSolver> solver_of(const Settings& settings) {
        static btDantzigSolver dantzig;
        if (settings.direct) return std::make_unique<btMLCPSolver>(&dantzig);
        return std::make_unique<btSequentialImpulseConstraintSolver>();
    }

    btRigidBody& side(std::size_t body) {
        return body == the_world ? btTypedConstraint::getFixedBody() : *bodies_[body];
    }

    void add(const Joint& joint) {
        auto made = constraint_of(joint, side(joint.first), side(joint.second), h_);
        made->setJointFeedback(&feedback_[joints_.size()]);
        world_.addConstraint(made.get(), !joint.collide);
        joints_.push_back(std::move(made));
    }

    void add(const Body& body, const Settings& settings) {
        btCollisionShape* shape = shapes_.make(body);
        const bool moves = body.moves();
        const btVector3 inertia = moves ? vec(body.principal_inertia()) : btVector3(0, 0, 0);
        btRigidBody::btRigidBodyConstructionInfo info(btScalar(moves ? body.mass : 0.0), nullptr, shape, inertia);
        info.m_startWorldTransform = pose(body.orientation, body.position);
        info.m_friction = btScalar(std::sqrt(body.friction));           // a pair uses the product
        info.m_restitution = btScalar(moves ? body.restitution : 1.0);  // a pair uses the product
        auto rigid = std::make_unique<btRigidBody>(info);
        rigid->setLinearVelocity(vec(body.velocity));
        rigid->setAngularVelocity(vec(body.angular_velocity));
        rigid->setDamping(0, 0);
        // Otherwise a contact found before the touch cancels the bounce.
        if (settings.elastic) rigid->setContactProcessingThreshold(0);
        if (!settings.sleep) rigid->setActivationState(DISABLE_DEACTIVATION);
        rigid->setFlags(settings.gyroscopic);
        if (settings.swept && moves) {
            const double radius = body.kind == Kind::sphere ? body.radius : 0.5 * body.size.x;
            rigid->setCcdMotionThreshold(btScalar(0.5 * radius));
            rigid->setCcdSweptSphereRadius(btScalar(0.9 * radius));
        }
        if (scene_.contacts)
            world_.addRigidBody(rigid.get());
        else
            world_.addRigidBody(rigid.get(), btBroadphaseProxy::DefaultFilter, 0);
        bodies_.push_back(std::move(rigid));
    }

    Scene scene_;
    double h_;
    btDefaultCollisionConfiguration configuration_;
    btCollisionDispatcher dispatcher_;
    btDbvtBroadphase broad_phase_;
    std::unique_ptr<btConstraintSolver> solver_;
    btDiscreteDynamicsWorld world_;
    BulletShapes shapes_;
    std::vector<std::unique_ptr<btRigidBody>> bodies_;
    std::vector<btJointFeedback> feedback_;
    std::vector<std::unique_ptr<btTypedConstraint>> joints_;
};

Variant variant(const std::string& name, const Settings& settings, std::vector<Demand> demands) {
    return {name,
            [=](Demand demand) {
                for (const Demand d : demands)
                    if (d == demand) return true;
                return false;
            },
            [=](const Scene& scene, double rate) -> std::unique_ptr<Simulator> {
                return std::make_unique<BulletSimulator>(scene, rate, settings);
            }};
}

std::unique_ptr<Simulator> make(const Scene& scene, double rate, const Settings& settings) {
    return std::make_unique<BulletSimulator>(scene, rate, settings);
}

Way way(const std::string& name, std::vector<Task> tasks, int iterations, bool sleep) {
    Settings settings;
    settings.elastic = false;
    settings.iterations = iterations;
    settings.sleep = sleep;
    return {name, std::move(tasks), [=](const Scene& scene, double rate) { return make(scene, rate, settings); }};
}

// Settings for bounces where there are any, with swept spheres.
std::unique_ptr<Simulator> make_steady(const Scene& scene, double rate) {
    Settings settings;
    settings.elastic = false;
    settings.swept = true;
    for (const Body& body : scene.bodies)
        if (body.moves() && body.restitution > 0.0) settings.elastic = true;
    return make(scene, rate, settings);
}

JointWay joined(const std::string& name, std::vector<JointTask> tasks, int iterations, bool sleep,
                bool direct = false) {
    Settings settings;
    settings.elastic = false;
    settings.iterations = iterations;
    settings.sleep = sleep;
    settings.direct = direct;
    const std::size_t most = direct ? 100 : 100000;  // its dense matrix takes minutes for more bodies
    return {
        name, std::move(tasks),
        [=](const Scene& scene, double rate) { return bullet_can_join(scene) ? make(scene, rate, settings) : nullptr; },
        most};
}

JointWay multibody(const std::string& name, std::vector<JointTask> tasks, const MultibodySettings& settings) {
    return {name, std::move(tasks),
            [=](const Scene& scene, double rate) { return make_bullet_multibody(scene, rate, settings); }};
}

}  // namespace

int main(int argc, char** argv) {
    const std::vector<Task> all{Task::pile, Task::spheres, Task::tower}, sleeping{Task::pile, Task::sleeping};
#ifdef BT_USE_DOUBLE_PRECISION
    // The choice of the gyroscopic term matters in flight alone.
    const int body = BT_ENABLE_GYROSCOPIC_FORCE_IMPLICIT_BODY;
    Peer peer{"Bullet", {}, {}, {}, {}};
    peer.accuracy = {variant("gyro implicit body", {body}, {Demand::flight}),
                     variant("gyro implicit world", {BT_ENABLE_GYROSCOPIC_FORCE_IMPLICIT_WORLD}, {Demand::flight}),
                     variant("gyro explicit", {BT_ENABLE_GYROSCOPIC_FORCE_EXPLICIT}, {Demand::flight}),
                     variant("sequential impulses", {body},
                             {Demand::impact, Demand::crowd, Demand::row_propagating, Demand::row_simultaneous}),
                     variant("swept sphere", {body, true}, {Demand::thin_wall})};
    peer.contact = {way("f64, default", {Task::pile}, 10, false), way("f64, sleep", sleeping, 10, true),
                    way("f64, 50 iterations", {Task::spheres, Task::tower}, 50, false)};
    peer.stability = {{"f64, 50 iterations", true, make_steady}};
    using enum JointTask;
    peer.joints = {joined("constraints, 10 iterations", {precision, load, speed, settling}, 10, false),
                   joined("constraints, 100 iterations", {load}, 100, false),
                   joined("constraints, Dantzig", {precision, load}, 10, false, true),
                   joined("constraints, sleep", {settling}, 10, true),
                   multibody("multibody", {precision, load, speed, settling}, {10, false}),
                   multibody("multibody, RK4", {precision}, {10, true})};
#else
    Peer peer{"Bullet", {}, {}, {}, {}};
    peer.contact = {way("f32, default", all, 10, false), way("f32, sleep", sleeping, 10, true)};
    using enum JointTask;
    peer.joints = {joined("f32, constraints, 10 iterations", {speed, settling}, 10, false),
                   joined("f32, constraints, sleep", {settling}, 10, true),
                   multibody("f32, multibody", {speed, settling}, {10, false})};
#endif
    return run_peer(argc, argv, peer);
}
