// ODE 0.16 in double precision, gyroscopic terms on (its default).
#include "harness/joints.h"
#include "peers/peer.h"

#include <ode/ode.h>

#include <algorithm>
#include <cstdarg>
#include <set>
#include <stdexcept>

namespace {

using namespace tumble::bench;

struct Settings {
    bool elastic = true;  // settings for bounces; otherwise for rest
    bool full = false;    // dWorldStep instead of the quick step
    bool sleep = false;
};

// A hexahedron in ODE's format, which keeps pointers to it.
struct Hull {
    explicit Hull(const Corners& corners) {
        for (std::size_t i = 0; i < 8; ++i) {
            points[3 * i] = corners[i].x;
            points[3 * i + 1] = corners[i].y;
            points[3 * i + 2] = corners[i].z;
        }
        for (std::size_t i = 0; i < 6; ++i) {
            polygons[5 * i] = 4;
            for (std::size_t k = 0; k < 4; ++k) polygons[5 * i + 1 + k] = unsigned(sides[i][k]);
            const auto corner = [&](int k) { return corners[std::size_t(sides[i][k])]; };
            Vector n = cross(corner(1) - corner(0), corner(3) - corner(0));
            n = 1.0 / norm(n) * n;
            planes[4 * i] = n.x;
            planes[4 * i + 1] = n.y;
            planes[4 * i + 2] = n.z;
            planes[4 * i + 3] = dot(n, corner(0));
        }
    }
    dReal points[24], planes[24];
    unsigned polygons[30];
};

class OdeSimulator : public Simulator {
public:
    OdeSimulator(const Scene& scene, double rate, const Settings& settings)
        : scene_(scene),
          full_(settings.full),
          h_(1.0 / rate),
          world_(dWorldCreate()),
          space_(dHashSpaceCreate(nullptr)),
          contacts_(dJointGroupCreate(0)) {
        dWorldSetGravity(world_, 0.0, 0.0, -scene.gravity);
        if (settings.elastic) {  // position correction adds energy: SimBenchmark's elastic cases have it off too
            dWorldSetERP(world_, 0.0);
            dWorldSetCFM(world_, 0.0);
        }
        dWorldSetAutoDisableFlag(world_, settings.sleep);
        for (std::size_t i = 0; i < scene.bodies.size(); ++i) add(i);
        feedback_.resize(scene.joints.size());
        for (const Joint& joint : scene.joints) add(joint);
    }
    ~OdeSimulator() override {
        dJointGroupDestroy(contacts_);
        dSpaceDestroy(space_);
        dWorldDestroy(world_);
    }

    void step() override {
        if (scene_.has_forces()) {
            for (std::size_t i = 0; i < bodies_.size(); ++i) {
                if (!bodies_[i]) continue;
                const Wrench w = wrench(scene_, i, motion(i));
                dBodyAddForce(bodies_[i], w.force.x, w.force.y, w.force.z);
                dBodyAddTorque(bodies_[i], w.torque.x, w.torque.y, w.torque.z);
            }
        }
        if (scene_.contacts) dSpaceCollide(space_, this, &OdeSimulator::touch);
        full_ ? dWorldStep(world_, h_) : dWorldQuickStep(world_, h_);
        dJointGroupEmpty(contacts_);
        for (std::size_t j = 0; j < joints_.size(); ++j) {
            const double most = scene_.joints[j].break_force;
            if (most > 0.0 && norm(*joint_force(j)) > most) dJointDisable(joints_[j]);
        }
    }

    std::optional<Vector> joint_force(std::size_t joint) const override {
        // The first force is that on the body in place of a first one that is the world.
        const dReal *f1 = feedback_[joint].f1, *f2 = feedback_[joint].f2;
        if (scene_.joints[joint].first == the_world) return Vector{f1[0], f1[1], f1[2]};
        if (scene_.joints[joint].second == the_world) return Vector{-f1[0], -f1[1], -f1[2]};
        return Vector{f2[0], f2[1], f2[2]};
    }

    Motion motion(std::size_t i) const override {
        const dReal *x = dBodyGetPosition(bodies_[i]), *q = dBodyGetQuaternion(bodies_[i]),
                    *v = dBodyGetLinearVel(bodies_[i]), *w = dBodyGetAngularVel(bodies_[i]);
        return {{x[0], x[1], x[2]}, {q[0], q[1], q[2], q[3]}, {v[0], v[1], v[2]}, {w[0], w[1], w[2]}};
    }

private:
    dBodyID body_of(std::size_t body) const { return body == the_world ? nullptr : bodies_[body]; }

    // ODE measures the first body relative to the second, and turns the two around where the first is the world.
    void add(const Joint& joint) {
        const dBodyID first = body_of(joint.first), second = body_of(joint.second);
        const Vector &p = joint.anchor, a = (first ? -1.0 : 1.0) * joint.axis;
        const auto [lower, upper] = joint.limits.value_or(std::array<double, 2>{-dInfinity, dInfinity});
        dJointID made = nullptr;
        if (joint.kind == JointKind::ball) {
            made = dJointCreateBall(world_, nullptr);
            dJointAttach(made, first, second);
            dJointSetBallAnchor(made, p.x, p.y, p.z);
        }
        if (joint.kind == JointKind::hinge) {
            made = dJointCreateHinge(world_, nullptr);
            dJointAttach(made, first, second);
            dJointSetHingeAnchor(made, p.x, p.y, p.z);
            dJointSetHingeAxis(made, a.x, a.y, a.z);
            set(made, dJointSetHingeParam, joint, lower, upper);
        }
        if (joint.kind == JointKind::slider) {
            made = dJointCreateSlider(world_, nullptr);
            dJointAttach(made, first, second);
            dJointSetSliderAxis(made, a.x, a.y, a.z);
            set(made, dJointSetSliderParam, joint, lower, upper);
        }
        if (joint.kind == JointKind::fixed) {
            made = dJointCreateFixed(world_, nullptr);
            dJointAttach(made, first, second);
            dJointSetFixed(made);
        }
        if (joint.kind == JointKind::distance) {
            const Vector& other = joint.second_anchor;
            made = dJointCreateDBall(world_, nullptr);
            dJointAttach(made, first, second);
            dJointSetDBallAnchor1(made, p.x, p.y, p.z);
            dJointSetDBallAnchor2(made, other.x, other.y, other.z);
        }
        dJointSetFeedback(made, &feedback_[joints_.size()]);
        joints_.push_back(made);
        if (!joint.collide) apart_.insert(std::minmax(joint.first, joint.second));
    }

    template <typename Set>
    static void set(dJointID made, Set parameter, const Joint& joint, double lower, double upper) {
        parameter(made, dParamLoStop, lower);
        parameter(made, dParamHiStop, upper);
        if (!joint.speed) return;
        parameter(made, dParamVel, *joint.speed);
        parameter(made, dParamFMax, joint.strength);
    }

    void add(std::size_t i) {
        const Body& body = scene_.bodies[i];
        dGeomID geom = nullptr;
        if (body.kind == Kind::plane)
            geom = dCreatePlane(space_, body.normal.x, body.normal.y, body.normal.z, body.offset);
        if (body.kind == Kind::box) geom = dCreateBox(space_, body.size.x, body.size.y, body.size.z);
        if (body.kind == Kind::sphere) geom = dCreateSphere(space_, body.radius);
        if (body.kind == Kind::hexahedron) {
            hulls_.push_back(std::make_unique<Hull>(body.corners));
            const Hull& hull = *hulls_.back();
            geom = dCreateConvex(space_, hull.planes, 6, hull.points, 8, hull.polygons);
        }
        if (geom) dGeomSetData(geom, &scene_.bodies[i]);
        const dQuaternion q{body.orientation.w, body.orientation.x, body.orientation.y, body.orientation.z};
        bodies_.push_back(body.moves() ? dBodyCreate(world_) : nullptr);
        if (!body.moves()) {
            if (body.kind == Kind::plane) return;  // a plane has no position of its own
            dGeomSetPosition(geom, body.position.x, body.position.y, body.position.z);
            dGeomSetQuaternion(geom, q);
            return;
        }
        const dBodyID rigid = bodies_.back();
        dMass mass;
        const Vector inertia = body.principal_inertia();
        dMassSetParameters(&mass, body.mass, 0.0, 0.0, 0.0, inertia.x, inertia.y, inertia.z, 0.0, 0.0, 0.0);
        dBodySetMass(rigid, &mass);
        if (geom) dGeomSetBody(geom, rigid);
        for (const BoxPart& part : body.parts) {
            const dGeomID piece = dCreateBox(space_, part.size.x, part.size.y, part.size.z);
            const Orientation& turned = part.orientation;
            const dQuaternion offset{turned.w, turned.x, turned.y, turned.z};
            dGeomSetData(piece, &scene_.bodies[i]);
            dGeomSetBody(piece, rigid);
            dGeomSetOffsetPosition(piece, part.position.x, part.position.y, part.position.z);
            dGeomSetOffsetQuaternion(piece, offset);
        }
        dBodySetPosition(rigid, body.position.x, body.position.y, body.position.z);
        dBodySetQuaternion(rigid, q);
        dBodySetLinearVel(rigid, body.velocity.x, body.velocity.y, body.velocity.z);
        dBodySetAngularVel(rigid, body.angular_velocity.x, body.angular_velocity.y, body.angular_velocity.z);
        dBodySetGyroscopicMode(rigid, 1);
    }

    bool apart(const Body& a, const Body& b) const {
        const auto index = [&](const Body& body) { return std::size_t(&body - scene_.bodies.data()); };
        return apart_.count(std::minmax(index(a), index(b))) > 0;
    }

    static void touch(void* self, dGeomID a, dGeomID b) {
        constexpr int most = 8;
        dContact contacts[most];
        const int n = dCollide(a, b, most, &contacts[0].geom, sizeof(dContact));
        const auto &first = *static_cast<const Body*>(dGeomGetData(a)),
                   &second = *static_cast<const Body*>(dGeomGetData(b));
        if (&first == &second || (!first.moves() && !second.moves())) return;
        auto* world = static_cast<OdeSimulator*>(self);
        if (world->apart(first, second)) return;
        const double restitution =
            std::max(first.moves() ? first.restitution : 0.0, second.moves() ? second.restitution : 0.0);
        for (int i = 0; i < n; ++i) {
            contacts[i].surface = dSurfaceParameters{};
            contacts[i].surface.mode = dContactBounce | dContactApprox1;
            contacts[i].surface.mu = std::sqrt(first.friction * second.friction);
            contacts[i].surface.bounce = restitution;  // at any speed: bounce_vel is 0
            dJointAttach(dJointCreateContact(world->world_, world->contacts_, &contacts[i]), dGeomGetBody(a),
                         dGeomGetBody(b));
        }
    }

    Scene scene_;
    bool full_;
    double h_;
    dWorldID world_;
    dSpaceID space_;
    dJointGroupID contacts_;
    std::vector<dBodyID> bodies_;
    std::vector<std::unique_ptr<Hull>> hulls_;
    std::vector<dJointID> joints_;
    std::vector<dJointFeedback> feedback_;
    std::set<std::pair<std::size_t, std::size_t>> apart_;  // joined bodies that do not collide
};

Way way(const std::string& name, std::vector<Task> tasks, const Settings& settings, std::size_t most_bodies) {
    return {name, std::move(tasks),
            [=](const Scene& scene, double rate) -> std::unique_ptr<Simulator> {
                return std::make_unique<OdeSimulator>(scene, rate, settings);
            },
            most_bodies};
}

std::unique_ptr<Simulator> make_steady(const Scene& scene, double rate) {
    Settings settings;
    settings.elastic = false;
    for (const Body& body : scene.bodies)
        if (body.moves() && body.restitution > 0.0) settings.elastic = true;
    return std::make_unique<OdeSimulator>(scene, rate, settings);
}

// Replaces the exit of the program, and a message at each step in which its solver fails.
void fail(int, const char* text, va_list) { throw std::runtime_error(text); }
void be_silent(int, const char*, va_list) {}

}  // namespace

int main(int argc, char** argv) {
    dInitODE2(0);
    dSetErrorHandler(fail);
    dSetDebugHandler(fail);
    dSetMessageHandler(be_silent);
    Peer peer{"ODE", {}, {}, {}, {}};
    // The full step (dWorldStep) is excluded elsewhere: in flight it is the quick step, in crowds its dense matrix
    // takes minutes, and on rows its LCP solver fails ("internal error, s <= 0").
    peer.accuracy = {{"quickstep", [](Demand) { return true; },
                      [](const Scene& scene, double rate) -> std::unique_ptr<Simulator> {
                          return std::make_unique<OdeSimulator>(scene, rate, Settings{});
                      }}};
    const Settings rest{false, false, false}, sleep{false, false, true}, full{false, true, false};
    peer.contact = {way("quickstep", {Task::pile, Task::spheres, Task::tower}, rest, 100000),
                    way("sleep", {Task::pile, Task::sleeping}, sleep, 100000),
                    way("full step", {Task::tower}, full, 30)};  // its dense matrix takes minutes for more bodies
    peer.stability = {{"quickstep", true, make_steady}};
    using enum JointTask;
    const auto joined = [](const Settings& settings) {
        return [=](const Scene& scene, double rate) -> std::unique_ptr<Simulator> {
            return std::make_unique<OdeSimulator>(scene, rate, settings);
        };
    };
    peer.joints = {{"full step", {precision, load, speed}, joined(full), 200},
                   {"quickstep", {precision, load, speed, settling}, joined(rest)},
                   {"sleep", {settling}, joined(sleep)}};
    return run_peer(argc, argv, peer);  // without dCloseODE(), which fails after an error in a step
}
