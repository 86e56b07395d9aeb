// ODE 0.16 in double precision, gyroscopic terms on (its default).
#include "accuracy/program.h"

#include <ode/ode.h>

#include <algorithm>

namespace {

using namespace tumble::bench;

class OdeSimulator : public Simulator {
public:
    OdeSimulator(const Scene& scene, double rate)
        : scene_(scene),
          h_(1.0 / rate),
          world_(dWorldCreate()),
          space_(dHashSpaceCreate(nullptr)),
          contacts_(dJointGroupCreate(0)) {
        dWorldSetGravity(world_, 0.0, 0.0, -scene.gravity);
        // Pushing overlaps out adds energy: SimBenchmark's elastic cases have it off too.
        dWorldSetERP(world_, 0.0);
        dWorldSetCFM(world_, 0.0);
        dWorldSetAutoDisableFlag(world_, 0);
        for (std::size_t i = 0; i < scene.bodies.size(); ++i) add(i);
    }
    ~OdeSimulator() override {
        dJointGroupDestroy(contacts_);
        dSpaceDestroy(space_);
        dWorldDestroy(world_);
    }

    void step() override {
        if (scene_.air || scene_.push) {
            for (std::size_t i = 0; i < bodies_.size(); ++i) {
                if (!bodies_[i]) continue;
                const Wrench w = wrench(scene_, i, motion(i));
                dBodyAddForce(bodies_[i], w.force.x, w.force.y, w.force.z);
                dBodyAddTorque(bodies_[i], w.torque.x, w.torque.y, w.torque.z);
            }
        }
        dSpaceCollide(space_, this, &OdeSimulator::touch);
        dWorldQuickStep(world_, h_);
        dJointGroupEmpty(contacts_);
    }

    Motion motion(std::size_t i) const override {
        const dReal *x = dBodyGetPosition(bodies_[i]), *q = dBodyGetQuaternion(bodies_[i]),
                    *v = dBodyGetLinearVel(bodies_[i]), *w = dBodyGetAngularVel(bodies_[i]);
        return {{x[0], x[1], x[2]}, {q[0], q[1], q[2], q[3]}, {v[0], v[1], v[2]}, {w[0], w[1], w[2]}};
    }

private:
    void add(std::size_t i) {
        const Body& body = scene_.bodies[i];
        dGeomID geom = nullptr;
        if (body.kind == Kind::plane)
            geom = dCreatePlane(space_, body.normal.x, body.normal.y, body.normal.z, body.offset);
        if (body.kind == Kind::box) geom = dCreateBox(space_, body.size.x, body.size.y, body.size.z);
        if (body.kind == Kind::sphere) geom = dCreateSphere(space_, body.radius);
        dGeomSetData(geom, &scene_.bodies[i]);
        const dQuaternion q{body.orientation.w, body.orientation.x, body.orientation.y, body.orientation.z};
        bodies_.push_back(body.moves() ? dBodyCreate(world_) : nullptr);
        if (!body.moves()) {
            if (body.kind == Kind::plane) return;  // has no place of its own
            dGeomSetPosition(geom, body.position.x, body.position.y, body.position.z);
            dGeomSetQuaternion(geom, q);
            return;
        }
        const dBodyID rigid = bodies_.back();
        dMass mass;
        const Vector inertia = body.principal_inertia();
        dMassSetParameters(&mass, body.mass, 0.0, 0.0, 0.0, inertia.x, inertia.y, inertia.z, 0.0, 0.0, 0.0);
        dBodySetMass(rigid, &mass);
        dGeomSetBody(geom, rigid);
        dBodySetPosition(rigid, body.position.x, body.position.y, body.position.z);
        dBodySetQuaternion(rigid, q);
        dBodySetLinearVel(rigid, body.velocity.x, body.velocity.y, body.velocity.z);
        dBodySetAngularVel(rigid, body.angular_velocity.x, body.angular_velocity.y, body.angular_velocity.z);
        dBodySetGyroscopicMode(rigid, 1);
    }

    static void touch(void* self, dGeomID a, dGeomID b) {
        constexpr int most = 8;
        dContact contacts[most];
        const int n = dCollide(a, b, most, &contacts[0].geom, sizeof(dContact));
        const double restitution = std::max(static_cast<const Body*>(dGeomGetData(a))->restitution,
                                            static_cast<const Body*>(dGeomGetData(b))->restitution);
        auto* world = static_cast<OdeSimulator*>(self);
        for (int i = 0; i < n; ++i) {
            contacts[i].surface = dSurfaceParameters{};
            contacts[i].surface.mode = dContactBounce;
            contacts[i].surface.bounce = restitution;  // from any speed on: bounce_vel is 0
            dJointAttach(dJointCreateContact(world->world_, world->contacts_, &contacts[i]), dGeomGetBody(a),
                         dGeomGetBody(b));
        }
    }

    Scene scene_;
    double h_;
    dWorldID world_;
    dSpaceID space_;
    dJointGroupID contacts_;
    std::vector<dBodyID> bodies_;
};

}  // namespace

int main(int argc, char** argv) {
    dInitODE2(0);
    // The full step (dWorldStep) is left out: in flight it is the quick step, in crowds its dense matrix takes minutes,
    // and on rows its LCP solver gives up ("internal error, s <= 0").
    const Variant quickstep{"quickstep", [](Demand) { return true; },
                            [](const Scene& scene, double rate) -> std::unique_ptr<Simulator> {
                                return std::make_unique<OdeSimulator>(scene, rate);
                            }};
    const int code = run_accuracy(argc, argv, "ODE", {quickstep});
    dCloseODE();
    return code;
}
