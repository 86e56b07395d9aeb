// Bullet 3.24 in double precision: btDiscreteDynamicsWorld, sequential impulses.
#include "accuracy/program.h"

#include <btBulletDynamicsCommon.h>

namespace {

using namespace tumble::bench;

struct Settings {
    int gyroscopic;      // BT_ENABLE_GYROSCOPIC_FORCE_...
    bool swept = false;  // a sphere swept along with fast bodies
};

btVector3 vec(const Vector& v) { return {v.x, v.y, v.z}; }
Vector vector(const btVector3& v) { return {v.x(), v.y(), v.z()}; }

class BulletSimulator : public Simulator {
public:
    BulletSimulator(const Scene& scene, double rate, const Settings& settings)
        : scene_(scene),
          h_(1.0 / rate),
          dispatcher_(&configuration_),
          world_(&dispatcher_, &broad_phase_, &solver_, &configuration_) {
        world_.setGravity(btVector3(0.0, 0.0, -scene.gravity));
        btContactSolverInfo& info = world_.getSolverInfo();
        info.m_restitutionVelocityThreshold = 0.0;  // default 0.2 m/s: slower blows do not bounce
        info.m_numIterations = 50;
        info.m_erp2 = 0.0;  // overlaps are not pushed out: that adds energy, up to 40-fold in the pit
        for (const Body& body : scene.bodies) add(body, settings);
    }
    ~BulletSimulator() override {
        for (const auto& body : bodies_) world_.removeRigidBody(body.get());
    }

    void step() override {
        if (scene_.air || scene_.push) {
            for (std::size_t i = 0; i < bodies_.size(); ++i) {
                if (!scene_.bodies[i].moves()) continue;
                const Wrench w = wrench(scene_, i, motion(i));
                bodies_[i]->applyCentralForce(vec(w.force));
                bodies_[i]->applyTorque(vec(w.torque));
            }
        }
        world_.stepSimulation(h_, 0, h_);  // no substeps: just this step
    }

    Motion motion(std::size_t i) const override {
        const btRigidBody& body = *bodies_[i];
        const btTransform& pose = body.getWorldTransform();
        const btQuaternion q = pose.getRotation();
        return {vector(pose.getOrigin()),
                {q.w(), q.x(), q.y(), q.z()},
                vector(body.getLinearVelocity()),
                vector(body.getAngularVelocity())};
    }

private:
    void add(const Body& body, const Settings& settings) {
        std::unique_ptr<btCollisionShape> shape;
        if (body.kind == Kind::plane) shape = std::make_unique<btStaticPlaneShape>(vec(body.normal), body.offset);
        if (body.kind == Kind::box) shape = std::make_unique<btBoxShape>(0.5 * vec(body.size));
        if (body.kind == Kind::sphere) shape = std::make_unique<btSphereShape>(body.radius);
        const bool moves = body.moves();
        const btVector3 inertia = moves ? vec(body.principal_inertia()) : btVector3(0.0, 0.0, 0.0);
        btRigidBody::btRigidBodyConstructionInfo info(moves ? body.mass : 0.0, nullptr, shape.get(), inertia);
        const Orientation& q = body.orientation;
        info.m_startWorldTransform = btTransform(btQuaternion(q.x, q.y, q.z, q.w), vec(body.position));
        info.m_friction = 0.0;
        info.m_restitution = moves ? body.restitution : 1.0;  // a pair takes the product
        auto rigid = std::make_unique<btRigidBody>(info);
        rigid->setLinearVelocity(vec(body.velocity));
        rigid->setAngularVelocity(vec(body.angular_velocity));
        rigid->setDamping(0.0, 0.0);
        rigid->setContactProcessingThreshold(0.0);  // else a contact found before it touches takes the bounce away
        rigid->setActivationState(DISABLE_DEACTIVATION);
        rigid->setFlags(settings.gyroscopic);
        if (settings.swept && moves) {
            const double radius = body.kind == Kind::sphere ? body.radius : 0.5 * body.size.x;
            rigid->setCcdMotionThreshold(0.5 * radius);
            rigid->setCcdSweptSphereRadius(0.9 * radius);
        }
        world_.addRigidBody(rigid.get());
        shapes_.push_back(std::move(shape));
        bodies_.push_back(std::move(rigid));
    }

    Scene scene_;
    double h_;
    btDefaultCollisionConfiguration configuration_;
    btCollisionDispatcher dispatcher_;
    btDbvtBroadphase broad_phase_;
    btSequentialImpulseConstraintSolver solver_;
    btDiscreteDynamicsWorld world_;
    std::vector<std::unique_ptr<btCollisionShape>> shapes_;
    std::vector<std::unique_ptr<btRigidBody>> bodies_;
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

}  // namespace

int main(int argc, char** argv) {
    // Which gyroscopic term is taken matters in flight alone.
    const int body = BT_ENABLE_GYROSCOPIC_FORCE_IMPLICIT_BODY;
    return run_accuracy(argc, argv, "Bullet",
                        {variant("gyro implicit body", {body}, {Demand::flight}),
                         variant("gyro implicit world", {BT_ENABLE_GYROSCOPIC_FORCE_IMPLICIT_WORLD}, {Demand::flight}),
                         variant("gyro explicit", {BT_ENABLE_GYROSCOPIC_FORCE_EXPLICIT}, {Demand::flight}),
                         variant("sequential impulses", {body},
                                 {Demand::impact, Demand::crowd, Demand::row_propagating, Demand::row_simultaneous}),
                         variant("swept sphere", {body, true}, {Demand::thin_wall})});
}
