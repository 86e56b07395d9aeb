// The time of a step: free chains of 10 to 10,000 links, and nets.
#include "harness/random.h"
#include "joints/joint_shapes.h"

namespace tumble::bench {
namespace {

std::string with_commas(int n) {
    const std::string text = std::to_string(n);
    return n < 1000 ? text : text.substr(0, text.size() - 3) + "," + text.substr(text.size() - 3);
}

// Rods of 1 m and 1 kg in a row without gravity, with small fitting speeds of the joints that cancel over the chain.
// Hinges turn about z and y alternately.
JointCase free_chain_of(int links, JointKind kind) {
    JointCase c;
    c.name = (kind == JointKind::ball ? "ball chain of " : "hinge chain of ") + with_commas(links);
    c.task = JointTask::speed;
    c.scene.contacts = false;
    c.scene.gravity = 0.0;
    Random random(7);
    Vector spin{0.0, -0.1, -0.1}, velocity;  // the mean over four links is zero
    for (int i = 0; i < links; ++i) {
        const Vector axis = i % 2 ? Vector{0.0, 1.0, 0.0} : Vector{0.0, 0.0, 1.0};
        // Each second pair of links takes back the speed of the pair before.
        const double speed = (i / 2 % 2 ? -1.0 : 1.0) * 0.2;
        spin = spin + speed * (kind == JointKind::ball ? Vector{0.3 * speed * random.both(), axis.y, axis.z} : axis);
        Body body = box({1.0, 0.1, 0.1}, 1.0, {double(i), 0.0, 0.0});
        const Vector half = cross(spin, {0.5, 0.0, 0.0});
        body.angular_velocity = spin;
        body.velocity = velocity + half;
        velocity = body.velocity + half;
        c.scene.bodies.push_back(body);
        if (i == 0) continue;
        const Vector anchor{i - 0.5, 0.0, 0.0};
        const std::size_t second = std::size_t(i);
        c.scene.joints.push_back(kind == JointKind::ball ? ball_joint(second - 1, second, anchor)
                                                         : hinge_joint(second - 1, second, anchor, axis));
    }
    c.links = std::size_t(links);
    c.seconds = links > 5000 ? 0.25 : links > 500 ? 0.5 : 2.0;
    c.quick_seconds = 2.0 / 240.0;
    c.rates = {240.0};
    if (links <= 1000) c.quick_rates = {240.0};
    c.look_every = 0.25;
    c.watch = watch_calm();
    return c;
}

// Box3D's joint_grid: balls of 0.4 m radius, 1 m apart, on ball joints between all neighbors; the upper row is fixed.
JointCase net(int side) {
    JointCase c;
    c.name = "net of " + std::to_string(side) + " x " + std::to_string(side) + " balls";
    c.task = JointTask::speed;
    c.scene.contacts = false;
    const auto index = [=](int row, int column) { return std::size_t(row * side + column); };
    for (int row = 0; row < side; ++row)
        for (int column = 0; column < side; ++column) {
            Body body = sphere(0.4, 268.0, {double(column), 0.0, -double(row)});
            body.fixed = row == 0;
            c.scene.bodies.push_back(body);
            if (row > 0)
                c.scene.joints.push_back(
                    ball_joint(index(row - 1, column), index(row, column), {double(column), 0.0, 0.5 - row}));
            if (row > 0 && column > 0)
                c.scene.joints.push_back(
                    ball_joint(index(row, column - 1), index(row, column), {column - 0.5, 0.0, -double(row)}));
        }
    c.links = c.scene.joints.size();
    c.seconds = 100.0 / 60.0;
    c.quick_seconds = 1.0 / 60.0;
    c.rates = {60.0};
    if (side < 20) c.quick_rates = {60.0};
    c.look_every = 0.5;
    c.watch = watch_calm();
    return c;
}

}  // namespace

void add_chains(std::vector<JointCase>& cases) {
    for (const JointKind kind : {JointKind::hinge, JointKind::ball})
        for (const int links : {10, 30, 100, 1000, 10000}) cases.push_back(free_chain_of(links, kind));
    for (const int side : {10, 30, 100}) cases.push_back(net(side));
}

}  // namespace tumble::bench
