// MuJoCo 2.2: Euler and RK4. Contacts are springs: e = 1 is an undamped one, as stiff as the step allows, e < 1 a
// damped one with the logarithmic decrement of e.
#include "peers/mujoco_model.h"
#include "peers/peer.h"

#include <mujoco/mujoco.h>

#include <algorithm>
#include <cstring>
#include <map>
#include <stdexcept>

namespace {

using namespace tumble::bench;
using Settings = MujocoSettings;

class MujocoSimulator : public Simulator {
public:
    MujocoSimulator(const Scene& scene, double rate, const Settings& settings) : scene_(scene) {
        const JointForest forest = forest_of(scene);
        const std::string xml = mujoco_model(scene, forest, 1.0 / rate, settings);
        auto files = std::make_unique<mjVFS>();
        mj_defaultVFS(files.get());
        mj_makeEmptyFileVFS(files.get(), "scene.xml", int(xml.size()));
        std::memcpy(files->filedata[0], xml.data(), xml.size());
        char error[1000] = "";
        model_ = mj_loadXML("scene.xml", files.get(), error, sizeof error);
        mj_deleteVFS(files.get());
        if (!model_) throw std::runtime_error(error);
        data_ = mj_makeData(model_);
        for (std::size_t i = 0; i < scene.bodies.size(); ++i)
            body_.push_back(scene.bodies[i].moves() ? mj_name2id(model_, mjOBJ_BODY, std::to_string(i).c_str()) : -1);
        for (const JointForest::Node& node : forest.nodes) start(node);
        for (int i = 0; i < model_->nu; ++i)
            data_->ctrl[i] = *scene.joints[std::stoul(mj_id2name(model_, mjOBJ_ACTUATOR, i))].speed;
        for (const JointForest::Node& node : forest.nodes) {
            jointed_ |= node.joint != the_world;
            if (node.joint != the_world) node_of_[node.joint] = node.body;
        }
    }
    ~MujocoSimulator() override {
        mj_deleteData(data_);
        mj_deleteModel(model_);
    }

    void step() override {
        const bool driven = scene_.has_forces();
        if (driven) {  // evaluated at each stage of RK4 too
            current_ = this;
            mjcb_passive = &MujocoSimulator::push;
        }
        mj_step(model_, data_);
        if (driven) mjcb_passive = nullptr;
        fresh_ = false;
    }

    Motion motion(std::size_t i) const override {
        if (jointed_) return joined_motion(i);
        const double *x = data_->qpos + position(i), *v = data_->qvel + velocity(i);
        const Orientation q{x[3], x[4], x[5], x[6]};
        return {{x[0], x[1], x[2]}, q, {v[0], v[1], v[2]}, rotate(q, {v[3], v[4], v[5]})};
    }

    // At the end of the step; the interaction force of a body acts on it.
    std::optional<Vector> joint_force(std::size_t joint) const override {
        const auto node = node_of_.find(joint);
        if (node == node_of_.end()) return std::nullopt;  // it closes a loop
        mj_forward(model_, data_);
        mj_rnePostConstraint(model_, data_);
        const double* f = data_->cfrc_int + 6 * body_[node->second] + 3;
        const double sign = node->second == scene_.joints[joint].second ? 1.0 : -1.0;
        return Vector{sign * f[0], sign * f[1], sign * f[2]};
    }

private:
    int position(std::size_t body) const { return model_->jnt_qposadr[model_->body_jntadr[body_[body]]]; }
    int velocity(std::size_t body) const { return model_->body_dofadr[body_[body]]; }

    void start(const JointForest::Node& node) {
        const Body& body = scene_.bodies[node.body];
        if (model_->body_dofnum[body_[node.body]] == 0) return;  // welded to its parent
        double* v = data_->qvel + velocity(node.body);
        const auto local = [&](const Vector& w) { return rotate_back(body.orientation, w); };
        const auto put = [&](double* at, const Vector& a) {
            at[0] = a.x;
            at[1] = a.y;
            at[2] = a.z;
        };
        if (node.joint == the_world) {
            put(v, body.velocity);
            put(v + 3, local(body.angular_velocity));
            return;
        }
        const Joint& joint = scene_.joints[node.joint];
        const Vector axis = axis_for(joint, node.body),
                     spin = spin_of(scene_, node.body) - spin_of(scene_, node.parent),
                     slip =
                         velocity_at(scene_, node.body, joint.anchor) - velocity_at(scene_, node.parent, joint.anchor);
        if (joint.kind == JointKind::ball) put(v, local(spin));
        if (joint.kind == JointKind::hinge) v[0] = dot(axis, spin);
        if (joint.kind == JointKind::slider) v[0] = dot(axis, slip);
    }

    // The poses of bodies in data are those of the step's start.
    Motion joined_motion(std::size_t i) const {
        if (!fresh_) {
            mj_kinematics(model_, data_);
            mj_comPos(model_, data_);
            mj_comVel(model_, data_);
            fresh_ = true;
        }
        return pose_in_data(i);
    }

    Motion pose_in_data(std::size_t i) const {
        const double *x = data_->xpos + 3 * body_[i], *q = data_->xquat + 4 * body_[i];
        double v[6];  // of rotation, then of the center of mass
        mj_objectVelocity(model_, data_, mjOBJ_BODY, body_[i], v, 0);
        return {{x[0], x[1], x[2]}, {q[0], q[1], q[2], q[3]}, {v[3], v[4], v[5]}, {v[0], v[1], v[2]}};
    }

    static void push(const mjModel* model, mjData* data) {
        const MujocoSimulator& self = *current_;
        for (std::size_t i = 0; i < self.body_.size(); ++i) {
            if (self.body_[i] < 0) continue;
            const Motion m = self.jointed_ ? self.pose_in_data(i) : self.motion(i);
            const Wrench w = wrench(self.scene_, i, m);
            if (self.jointed_) {
                const double at[3] = {m.position.x, m.position.y, m.position.z},
                             force[3] = {w.force.x, w.force.y, w.force.z},
                             torque[3] = {w.torque.x, w.torque.y, w.torque.z};
                mj_applyFT(model, data, force, torque, at, self.body_[i], data->qfrc_passive);
                continue;
            }
            const Vector torque = rotate_back(m.orientation, w.torque);
            const double force[6] = {w.force.x, w.force.y, w.force.z, torque.x, torque.y, torque.z};
            for (int k = 0; k < 6; ++k) data->qfrc_passive[self.velocity(i) + k] += force[k];
        }
    }

    static inline const MujocoSimulator* current_ = nullptr;  // MuJoCo's callback has no user pointer

    Scene scene_;
    mjModel* model_ = nullptr;
    mjData* data_ = nullptr;
    std::vector<int> body_;                       // of MuJoCo, for each moving body of the scene
    std::map<std::size_t, std::size_t> node_of_;  // body that hangs on a joint, by joint of the forest
    bool jointed_ = false;
    mutable bool fresh_ = false;
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
    Peer peer{"MuJoCo", {variant("Euler"), variant("RK4")}, {}, {}, {}};
    peer.contact = {way("CG, stiff", {Task::spheres}, {"Euler", "CG", true}),
                    way("Newton", {Task::tower}, {"Euler", "Newton", false}),
                    way("Newton, stiff", {Task::tower}, {"Euler", "Newton", true})};
    const auto steady = [](const std::string& integrator) {
        return [=](const Scene& scene, double rate) -> std::unique_ptr<Simulator> {
            if (!mujoco_can_represent(scene, forest_of(scene))) return nullptr;
            return std::make_unique<MujocoSimulator>(scene, rate, Settings{integrator, "Newton", true});
        };
    };
    peer.stability = {{"Newton, stiff", true, steady("Euler"), 200}, {"RK4", false, steady("RK4"), 200}};
    using enum JointTask;
    const auto joined = [](const Settings& settings) {
        return [=](const Scene& scene, double rate) -> std::unique_ptr<Simulator> {
            if (!mujoco_can_represent(scene, forest_of(scene))) return nullptr;
            return std::make_unique<MujocoSimulator>(scene, rate, settings);
        };
    };
    peer.joints = {{"Euler", {precision, load, speed}, joined({"Euler", "Newton", true}), 300},
                   {"implicit", {precision, load}, joined({"implicit", "Newton", true}), 300},
                   {"RK4", {precision, load, speed}, joined({"RK4", "Newton", true}), 300},
                   {"CG", {settling}, joined({"Euler", "CG", true}), 300}};
    return run_peer(argc, argv, peer);
}
