// The time of a step: a humanoid of 27 degrees of freedom, and ragdolls that fall on a floor.
#include "harness/random.h"
#include "joints/joint_shapes.h"

#include <numbers>

namespace tumble::bench {
namespace {

constexpr double degree = std::numbers::pi / 180.0;
constexpr double density = 1000.0;  // kg/m^3

// Bodies and joints of a figure that stands upright and looks along x, around its pelvis. Sizes and places have y up
// and z to its right, as in scene files.
class Figure {
public:
    std::size_t add(const Vector& size, const Vector& position) {
        Body body =
            box({size.x, size.z, size.y}, density * size.x * size.y * size.z, up(position.x, position.y, position.z));
        body.friction = 0.5;
        body.restitution = 0.0;
        bodies.push_back(body);
        return bodies.size() - 1;
    }
    std::size_t add_ball(double radius, const Vector& position) {
        Body body = sphere(radius, density * 4.0 / 3.0 * std::numbers::pi * radius * radius * radius,
                           up(position.x, position.y, position.z));
        body.friction = 0.5;
        body.restitution = 0.0;
        bodies.push_back(body);
        return bodies.size() - 1;
    }
    void ball(std::size_t a, std::size_t b, const Vector& at, const Vector& axis, double cone) {
        joints.push_back(ball_joint(a, b, up(at.x, at.y, at.z)));
        joints.back().axis = up(axis.x, axis.y, axis.z);
        joints.back().cone = cone * degree;
    }
    void hinge(std::size_t a, std::size_t b, const Vector& at, const Vector& axis, double lower, double upper) {
        joints.push_back(hinge_joint(a, b, up(at.x, at.y, at.z), up(axis.x, axis.y, axis.z)));
        joints.back().limits = {lower * degree, upper * degree};
    }
    void weld(std::size_t a, std::size_t b, const Vector& at) {
        joints.push_back(fixed_joint(a, b, up(at.x, at.y, at.z)));
    }

    // Turned about its pelvis, and moved there.
    void put_into(Scene& scene, const Vector& place, const Orientation& q, const Vector& spin, bool cones) const {
        const std::size_t first = scene.bodies.size();
        for (Body body : bodies) {
            const Vector arm = rotate(q, body.position);
            body.position = place + arm;
            body.orientation = q;
            body.velocity = cross(spin, arm);
            body.angular_velocity = spin;
            scene.bodies.push_back(body);
        }
        for (Joint joint : joints) {
            joint.first += first;
            joint.second += first;
            joint.anchor = place + rotate(q, joint.anchor);
            joint.axis = rotate(q, joint.axis);
            if (!cones) joint.cone.reset();
            scene.joints.push_back(joint);
        }
    }

    std::vector<Body> bodies;
    std::vector<Joint> joints;
};

constexpr Vector sideways{0.0, 0.0, 1.0};

// 17 bodies on three balls, twelve hinges and a fixed joint: 6 + 9 + 12 degrees of freedom.
Figure humanoid() {
    Figure f;
    const std::size_t pelvis = f.add({0.16, 0.16, 0.3}, {}), torso = f.add({0.18, 0.4, 0.3}, {0.0, 0.32, 0.0}),
                      head = f.add({0.18, 0.22, 0.16}, {0.0, 0.67, 0.0});
    f.ball(pelvis, torso, {0.0, 0.1, 0.0}, {0.0, 1.0, 0.0}, 60.0);
    f.weld(torso, head, {0.0, 0.54, 0.0});
    for (const double s : {-1.0, 1.0}) {
        const std::size_t thigh = f.add({0.14, 0.38, 0.12}, {0.0, -0.27, 0.09 * s}),
                          shin = f.add({0.1, 0.38, 0.1}, {0.0, -0.67, 0.09 * s}),
                          foot = f.add({0.24, 0.06, 0.1}, {0.05, -0.91, 0.09 * s});
        f.ball(pelvis, thigh, {0.0, -0.08, 0.09 * s}, {0.0, -1.0, 0.0}, 90.0);
        f.hinge(thigh, shin, {0.0, -0.47, 0.09 * s}, -1.0 * sideways, -2.0, 150.0);
        f.hinge(shin, foot, {0.0, -0.87, 0.09 * s}, sideways, -45.0, 45.0);
        const std::size_t shoulder = f.add({0.12, 0.1, 0.1}, {0.0, 0.46, 0.2 * s}),
                          upper = f.add({0.09, 0.28, 0.09}, {0.0, 0.31, 0.3 * s}),
                          lower = f.add({0.08, 0.26, 0.08}, {0.0, 0.03, 0.3 * s}),
                          hand = f.add({0.08, 0.12, 0.05}, {0.0, -0.17, 0.3 * s});
        f.hinge(torso, shoulder, {0.0, 0.46, 0.15 * s}, {1.0, 0.0, 0.0}, -80.0, 80.0);
        f.hinge(shoulder, upper, {0.0, 0.46, 0.3 * s}, sideways, -85.0, 170.0);
        f.hinge(upper, lower, {0.0, 0.165, 0.3 * s}, sideways, -2.0, 140.0);
        f.hinge(lower, hand, {0.0, -0.105, 0.3 * s}, sideways, -60.0, 60.0);
    }
    return f;
}

JointCase one_humanoid(bool contact) {
    JointCase c;
    c.name = contact ? "humanoid on the floor" : "humanoid in flight";
    c.task = JointTask::speed;
    c.scene.contacts = contact;
    const Orientation q = turn({0.2, 1.0, 0.1}, 1.3);
    humanoid().put_into(c.scene, {0.0, 0.0, contact ? 0.6 : 0.0}, q, contact ? Vector{} : Vector{1.0, 2.0, 0.5}, false);
    if (contact)
        c.scene.bodies.push_back(plane({0.0, 0.0, 1.0}, 0.0));
    else
        for (Joint& joint : c.scene.joints) joint.limits.reset();
    set_materials(c.scene, 0.5, 0.0);
    c.seconds = contact ? 4.0 : 1.0;
    c.quick_seconds = 0.1;
    c.rates = {240.0, 960.0};
    c.quick_rates = {240.0};
    c.look_every = 0.1;
    c.links = 1;
    c.watch = watch_calm();
    return c;
}

// The mannequin of assets/scenes/ragdoll.toml in boxes and balls: 15 bodies, 14 joints.
Figure ragdoll() {
    Figure f;
    const std::size_t pelvis = f.add({0.16, 0.14, 0.24}, {}), abdomen = f.add_ball(0.1, {0.0, 0.15, 0.0}),
                      chest = f.add({0.18, 0.26, 0.32}, {0.0, 0.36, 0.0}), head = f.add_ball(0.11, {0.0, 0.65, 0.0});
    f.ball(pelvis, abdomen, {0.0, 0.08, 0.0}, {0.0, 1.0, 0.0}, 25.0);
    f.ball(abdomen, chest, {0.0, 0.24, 0.0}, {0.0, 1.0, 0.0}, 25.0);
    f.ball(chest, head, {0.0, 0.53, 0.0}, {0.0, 1.0, 0.0}, 40.0);
    for (const double s : {-1.0, 1.0}) {
        const std::size_t thigh = f.add({0.12, 0.38, 0.12}, {0.0, -0.26, 0.1 * s}),
                          shin = f.add({0.1, 0.38, 0.1}, {0.0, -0.67, 0.1 * s}),
                          foot = f.add({0.24, 0.07, 0.09}, {0.06, -0.9, 0.1 * s});
        f.ball(pelvis, thigh, {0.0, -0.05, 0.1 * s}, {0.0, -1.0, 0.0}, 70.0);
        f.hinge(thigh, shin, {0.0, -0.47, 0.1 * s}, -1.0 * sideways, -2.0, 140.0);
        f.hinge(shin, foot, {0.0, -0.865, 0.1 * s}, sideways, -40.0, 25.0);
        const std::size_t upper = f.add({0.08, 0.27, 0.08}, {0.0, 0.315, 0.25 * s}),
                          lower = f.add({0.07, 0.24, 0.07}, {0.0, 0.04, 0.25 * s}),
                          hand = f.add_ball(0.05, {0.0, -0.13, 0.25 * s});
        f.ball(chest, upper, {0.0, 0.46, 0.25 * s}, {0.0, -0.6, 0.8 * s}, 85.0);
        f.hinge(upper, lower, {0.0, 0.17, 0.25 * s}, sideways, -2.0, 140.0);
        f.ball(lower, hand, {0.0, -0.09, 0.25 * s}, {0.0, -1.0, 0.0}, 50.0);
    }
    return f;
}

JointCase ragdolls(int rows, bool cones) {
    JointCase c;
    c.name = std::to_string(rows * rows) + (cones ? " ragdolls with cones" : " ragdolls");
    c.task = JointTask::settling;
    const Figure figure = ragdoll();
    Random random(15);
    for (int i = 0; i < rows; ++i)
        for (int k = 0; k < rows; ++k) {
            const Vector place{2.0 * (i - 0.5 * rows), 2.0 * (k - 0.5 * rows), 1.2 + 0.5 * random.unit()};
            figure.put_into(c.scene, place, random.turned(std::numbers::pi), {}, cones);
        }
    c.links = c.scene.bodies.size();
    c.scene.bodies.push_back(plane({0.0, 0.0, 1.0}, 0.0));
    set_materials(c.scene, 0.5, 0.0);
    c.seconds = 2.5;  // they land after 0.5 s
    c.quick_seconds = 0.2;
    c.rates = {60.0};
    if (!cones) c.rates.push_back(240.0);
    if (rows < 5) c.quick_rates = {60.0};
    c.look_every = 0.25;
    c.watch = watch_calm();
    return c;
}

}  // namespace

void add_figures(std::vector<JointCase>& cases) {
    cases.push_back(one_humanoid(false));
    cases.push_back(one_humanoid(true));
    cases.push_back(ragdolls(2, false));
    cases.push_back(ragdolls(10, false));
    cases.push_back(ragdolls(10, true));
}

}  // namespace tumble::bench
