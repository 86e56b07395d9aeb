// MuJoCo 2.2: Euler and RK4. Contacts are springs: e = 1 is an undamped one, as stiff as the step allows, e < 1 a
// damped one with the logarithmic decrement of e.
#include "peers/peer.h"

#include <mujoco/mujoco.h>

#include <algorithm>
#include <cstring>
#include <numbers>
#include <sstream>
#include <stdexcept>

namespace {

using namespace tumble::bench;

std::string text(const Vector& v) {
    std::ostringstream out;
    out.precision(17);
    out << v.x << ' ' << v.y << ' ' << v.z;
    return out.str();
}

struct Settings {
    std::string integrator = "Euler", solver = "Newton";
    bool stiff = true;  // the shortest stable time constant, two steps; else the default of 20 ms
};

// (-stiffness, -damping) of a contact, per unit of effective mass. The period is 12 steps (a stiffer spring gains
// energy); e = exp(-zeta pi / sqrt(1 - zeta^2)).
std::string solref(const Scene& scene, double h, bool stiff) {
    double e = 0.0;
    for (const Body& body : scene.bodies)
        if (body.moves()) e = std::max(e, body.restitution);
    if (e == 0.0) return std::to_string(stiff ? 2.0 * h : std::max(0.02, 2.0 * h)) + " 1";
    const double omega = 2.0 * std::numbers::pi / (12.0 * h), decrement = -std::log(e);
    const double zeta = decrement / std::sqrt(std::numbers::pi * std::numbers::pi + decrement * decrement);
    std::ostringstream out;
    out.precision(17);
    out << -omega * omega << ' ' << -2.0 * zeta * omega;
    return out.str();
}

std::string solimp(const Scene& scene, bool stiff) {
    for (const Body& body : scene.bodies)
        if (body.moves() && body.restitution > 0.0) return " solimp='0.9999 0.9999 0.001'";
    return stiff ? " solimp='0.99 0.999 0.001'" : "";  // nearer to 1, CG does not converge
}

std::string model_of(const Scene& scene, double h, const Settings& settings) {
    bool rough = false;
    for (const Body& body : scene.bodies) rough |= body.friction > 0.0;
    std::size_t shapes = 0;
    for (const Body& body : scene.bodies) shapes += std::max<std::size_t>(1, 2 * body.parts.size());
    const std::size_t contacts = std::max<std::size_t>(100, 8 * shapes), rows = (rough ? 3 : 1) * contacts;
    std::ostringstream xml;
    xml.precision(17);
    xml << "<mujoco><option timestep='" << h << "' gravity='0 0 " << -scene.gravity << "' integrator='"
        << settings.integrator << "' solver='" << settings.solver << "' cone='elliptic'/><size nconmax='" << contacts
        << "' njmax='" << rows << "' nstack='20000000'/><default><geom condim='" << (rough ? 3 : 1) << "' solref='"
        << solref(scene, h, settings.stiff) << "'" << solimp(scene, settings.stiff) << "/></default><asset>";
    for (std::size_t i = 0; i < scene.bodies.size(); ++i) {
        if (scene.bodies[i].kind != Kind::hexahedron) continue;
        xml << "<mesh name='" << i << "' vertex='";
        for (const Vector& corner : scene.bodies[i].corners) xml << text(corner) << ' ';
        xml << "'/>";
    }
    xml << "</asset><worldbody>";
    for (std::size_t i = 0; i < scene.bodies.size(); ++i) {
        const Body& body = scene.bodies[i];
        const Orientation& q = body.orientation;
        std::ostringstream material;  // a pair uses that of the higher priority, or the larger friction
        material << " friction='" << told_friction(scene, body) << "' priority='" << (body.moves() ? 0 : 1) << "'";
        std::string geom;
        if (body.kind == Kind::sphere) geom = "type='sphere' size='" + text({body.radius, 0.0, 0.0}) + "'";
        if (body.kind == Kind::box) geom = "type='box' size='" + text(0.5 * body.size) + "'";
        if (body.kind == Kind::hexahedron) geom = "type='mesh' mesh='" + std::to_string(i) + "'";
        geom += material.str();
        if (body.kind == Kind::plane) {
            xml << "<geom type='plane' size='0 0 1' pos='" << text(body.offset * body.normal) << "' zaxis='"
                << text(body.normal) << "'" << material.str() << "/>";
        } else if (body.fixed) {
            xml << "<geom " << geom << " pos='" << text(body.position) << "' quat='" << q.w << ' ' << q.x << ' ' << q.y
                << ' ' << q.z << "'/>";
        } else {
            xml << "<body pos='" << text(body.position) << "' quat='" << q.w << ' ' << q.x << ' ' << q.y << ' ' << q.z
                << "'><freejoint/><inertial pos='0 0 0' mass='" << body.mass << "' diaginertia='"
                << text(body.principal_inertia()) << "'/>";
            if (body.kind != Kind::compound) xml << "<geom " << geom << "/>";
            for (const BoxPart& part : body.parts)
                xml << "<geom type='box' size='" << text(0.5 * part.size) << "' pos='" << text(part.position)
                    << "' quat='" << part.orientation.w << ' ' << part.orientation.x << ' ' << part.orientation.y << ' '
                    << part.orientation.z << "'" << material.str() << "/>";
            xml << "</body>";
        }
    }
    xml << "</worldbody></mujoco>";
    return xml.str();
}

class MujocoSimulator : public Simulator {
public:
    MujocoSimulator(const Scene& scene, double rate, const Settings& settings) : scene_(scene) {
        const std::string xml = model_of(scene, 1.0 / rate, settings);
        auto files = std::make_unique<mjVFS>();
        mj_defaultVFS(files.get());
        mj_makeEmptyFileVFS(files.get(), "scene.xml", int(xml.size()));
        std::memcpy(files->filedata[0], xml.data(), xml.size());
        char error[1000] = "";
        model_ = mj_loadXML("scene.xml", files.get(), error, sizeof error);
        mj_deleteVFS(files.get());
        if (!model_) throw std::runtime_error(error);
        data_ = mj_makeData(model_);
        int joints = 0;
        for (const Body& body : scene.bodies) {
            joint_.push_back(body.moves() ? joints++ : -1);
            if (!body.moves()) continue;
            const Vector w = rotate_back(body.orientation, body.angular_velocity);  // body frame
            const double velocity[6] = {body.velocity.x, body.velocity.y, body.velocity.z, w.x, w.y, w.z};
            std::copy(velocity, velocity + 6, data_->qvel + 6 * joint_.back());
        }
    }
    ~MujocoSimulator() override {
        mj_deleteData(data_);
        mj_deleteModel(model_);
    }

    void step() override {
        const bool driven = scene_.air || scene_.push;
        if (driven) {  // evaluated at each stage of RK4 too
            current_ = this;
            mjcb_passive = &MujocoSimulator::push;
        }
        mj_step(model_, data_);
        if (driven) mjcb_passive = nullptr;
    }

    Motion motion(std::size_t i) const override {
        const double *x = data_->qpos + 7 * joint_[i], *v = data_->qvel + 6 * joint_[i];
        const Orientation q{x[3], x[4], x[5], x[6]};
        return {{x[0], x[1], x[2]}, q, {v[0], v[1], v[2]}, rotate(q, {v[3], v[4], v[5]})};
    }

private:
    static void push(const mjModel*, mjData* data) {
        const MujocoSimulator& self = *current_;
        for (std::size_t i = 0; i < self.joint_.size(); ++i) {
            if (self.joint_[i] < 0) continue;
            const Motion m = self.motion(i);
            const Wrench w = wrench(self.scene_, i, m);
            const Vector torque = rotate_back(m.orientation, w.torque);
            const double force[6] = {w.force.x, w.force.y, w.force.z, torque.x, torque.y, torque.z};
            for (int k = 0; k < 6; ++k) data->qfrc_passive[6 * self.joint_[i] + k] += force[k];
        }
    }

    static inline const MujocoSimulator* current_ = nullptr;  // MuJoCo's callback has no user pointer

    Scene scene_;
    mjModel* model_ = nullptr;
    mjData* data_ = nullptr;
    std::vector<int> joint_;
};

Variant variant(const std::string& integrator) {
    return {integrator,
            [](Demand demand) {
                // Crowds: the springs store energy that must not count as lost. Thin walls: MuJoCo has no continuous
                // collision detection.
                return demand != Demand::crowd && demand != Demand::thin_wall;
            },
            [=](const Scene& scene, double rate) -> std::unique_ptr<Simulator> {
                return std::make_unique<MujocoSimulator>(scene, rate, Settings{integrator});
            }};
}

Way way(const std::string& name, std::vector<Task> tasks, const Settings& settings) {
    return {name, std::move(tasks),
            [=](const Scene& scene, double rate) -> std::unique_ptr<Simulator> {
                return std::make_unique<MujocoSimulator>(scene, rate, settings);
            },
            300};
}

// Replaces its log file and, on errors, the exit of the program. A world that diverges would be reset to its start.
void complain(const char* text) { throw std::runtime_error(text); }

}  // namespace

int main(int argc, char** argv) {
    mju_user_error = mju_user_warning = complain;
    Peer peer{"MuJoCo", {variant("Euler"), variant("RK4")}, {}, {}};
    peer.contact = {way("CG, stiff", {Task::spheres}, {"Euler", "CG", true}),
                    way("Newton", {Task::tower}, {"Euler", "Newton", false}),
                    way("Newton, stiff", {Task::tower}, {"Euler", "Newton", true})};
    const auto steady = [](const std::string& integrator) {
        return [=](const Scene& scene, double rate) -> std::unique_ptr<Simulator> {
            return std::make_unique<MujocoSimulator>(scene, rate, Settings{integrator, "Newton", true});
        };
    };
    peer.stability = {{"Newton, stiff", true, steady("Euler"), 200}, {"RK4", false, steady("RK4"), 200}};
    return run_peer(argc, argv, peer);
}
