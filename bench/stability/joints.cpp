// Joined bodies: chains under load and of many links, motors, limits at speed, and the time of a break.
#include "joints/joint_shapes.h"
#include "stability/stability_case.h"

#include <algorithm>
#include <memory>
#include <numbers>

namespace tumble::bench {
namespace {

constexpr double gap_limit = 1e-3;  // m

// The larger of the gap over its limit and the gain of energy over one percent of `scale` (J).
auto gap_and_gain(const Scene& scene, double scale) {
    const auto start = std::make_shared<double>(HUGE_VAL);
    return [=](double, const std::vector<Motion>& motions) {
        if (*start == HUGE_VAL) {
            std::vector<Motion> at(scene.bodies.size());
            for (std::size_t i = 0; i < at.size(); ++i)
                at[i] = {scene.bodies[i].position, scene.bodies[i].orientation, scene.bodies[i].velocity,
                         scene.bodies[i].angular_velocity};
            *start = energy(scene, at);
        }
        const double gain = (energy(scene, motions) - *start) / (0.01 * scale);
        return std::max(largest_gap(scene, motions) / gap_limit, gain);
    };
}

// Links of 0.1 m and 1 kg in a row, hung up at one end 30 degrees aside, with a ball at the other.
Trial swinging_chain(std::size_t links, double ball, double rate) {
    constexpr double link = 0.1, radius = 0.2, lean = std::numbers::pi / 6.0;
    const Vector down{std::sin(lean), 0.0, -std::cos(lean)};
    Trial trial;
    Scene& scene = trial.scene;
    scene.contacts = false;
    for (std::size_t i = 0; i < links; ++i) {
        Body body = box({link, 0.02, 0.02}, 1.0, (link * (double(i) + 0.5)) * down);
        body.orientation = along(down);
        scene.bodies.push_back(body);
        scene.joints.push_back(ball_joint(i == 0 ? the_world : i - 1, i, (link * double(i)) * down));
    }
    const double length = link * double(links);
    if (ball > 0.0) {
        scene.bodies.push_back(sphere(radius, ball, (length + radius) * down));
        scene.joints.push_back(ball_joint(links - 1, links, length * down));
    }
    trial.seconds = 2.0;
    trial.look_every = std::max(1l, std::lround(rate / 60.0));
    const double depth = (1.0 - std::cos(lean)) * (0.5 * length * double(links) + (length + radius) * ball);
    trial.watch = gap_and_gain(scene, g * depth);
    return trial;
}

// A bar of 1 m and 1 kg on a hinge at its end, along x; no gravity.
Scene turned_bar() {
    Scene scene;
    scene.gravity = 0.0;
    scene.contacts = false;
    scene.bodies = {box({1.0, 0.1, 0.1}, 1.0, {0.5, 0.0, 0.0})};
    scene.joints = {hinge_joint(the_world, 0, {}, {0.0, 0.0, 1.0})};
    return scene;
}

// A second bar hangs loose on the first, which a motor turns at 10 rad/s: its speed and the gaps.
Trial driven_bars(double strength, double rate) {
    constexpr double speed = 10.0;
    Trial trial;
    Scene& scene = trial.scene = turned_bar();
    scene.gravity = g;
    scene.bodies.push_back(box({1.0, 0.1, 0.1}, 1.0, {1.5, 0.0, 0.0}));
    scene.joints.push_back(hinge_joint(0, 1, {1.0, 0.0, 0.0}, {0.0, 0.0, 1.0}));
    scene.joints[0].speed = speed;
    scene.joints[0].strength = strength;
    trial.look_every = std::max(1l, std::lround(rate / 240.0));
    trial.watch = [scene](double time, const std::vector<Motion>& motions) {
        const double off = std::fabs(motions[0].angular_velocity.z - speed) / (0.01 * speed);
        return std::max(largest_gap(scene, motions) / gap_limit, time > 1.0 ? off : 0.0);
    };
    return trial;
}

// The bar hits a limit without restitution at 90 degrees.
Trial hit_limit(double speed, double rate) {
    constexpr double limit = 0.5 * std::numbers::pi, allowed = 0.01;  // rad
    Trial trial;
    Scene& scene = trial.scene = turned_bar();
    scene.joints[0].limits = {-limit, limit};
    scene.bodies[0].angular_velocity = {0.0, 0.0, speed};
    scene.bodies[0].velocity = {0.0, 0.5 * speed, 0.0};
    trial.seconds = 2.0 * limit / speed + 1.0;
    const double start = energy(scene, {{{0.5, 0.0, 0.0}, {}, scene.bodies[0].velocity, {0.0, 0.0, speed}}});
    trial.watch = [=](double time, const std::vector<Motion>& motions) {
        const Vector x = rotate(motions[0].orientation, {1.0, 0.0, 0.0});
        const double angle = std::atan2(x.y, x.x), gain = energy(scene, motions) / start - 1.0;
        // An angle far beyond the limit may look negative: the bar must be at the limit in the end.
        const double at = time > 1.5 * limit / speed + 2.0 / rate ? std::fabs(angle - limit) : angle - limit;
        return std::max({at / allowed, gain / 0.01, largest_gap(scene, motions) / gap_limit});
    };
    return trial;
}

// When the force in the hinge of a bar that is let go level reaches `force` (N), by 1e-6 s.
double time_of_break(double force) {
    constexpr double inertia = (1.0 + 0.01) / 12.0 + 0.25, h = 1e-6;
    double angle = 0.5 * std::numbers::pi, speed = 0.0, time = 0.0;  // from hanging
    for (;; time += h) {
        const double rate = -0.5 * g * std::sin(angle) / inertia;
        const double along = g * std::cos(angle) + 0.5 * speed * speed, across = g * std::sin(angle) + 0.5 * rate;
        if (std::hypot(along, across) >= force) return time;
        speed += h * rate;
        angle += h * speed;
    }
}

// The bar breaks off while it swings: it stays before that time, and is off shortly after it.
Trial breaking_bar(double force, double rate) {
    Trial trial;
    Scene& scene = trial.scene = turned_bar();
    scene.gravity = g;
    scene.joints[0].axis = {0.0, 1.0, 0.0};
    scene.joints[0].break_force = force;
    const double broken = time_of_break(force);
    trial.seconds = broken + 0.1;
    trial.watch = [=](double time, const std::vector<Motion>& motions) {
        const double gap = largest_gap(scene, motions);
        // The ends part with the acceleration that the force had given: 1 mm in sqrt(2 mm / a) at the latest.
        const double parted = broken + 2.0 / rate + std::sqrt(2.0 * gap_limit / force);
        if (time < broken - 2.0 / rate) return gap / gap_limit;
        return time > parted && gap < gap_limit ? HUGE_VAL : 0.0;
    };
    return trial;
}

}  // namespace

void add_joints(std::vector<StabilityCase>& cases) {
    const std::string swing = "gaps up to 1 mm; the energy never gains 1 % of the swing's";
    cases.push_back({"chain under load",
                     "load over a link",
                     "20 links of 1 kg, let go 30 degrees aside, 2 s; " + swing,
                     {1.0, 10.0, 1e2, 1e3, 1e4, 1e5, 1e6},
                     stability_rates(),
                     [](double load, double rate) { return swinging_chain(20, load, rate); }});

    cases.push_back({"chain length",
                     "links",
                     "let go 30 degrees aside, 2 s; " + swing,
                     {10, 100, 1000, 10000},
                     stability_rates(),
                     [](double links, double rate) { return swinging_chain(std::size_t(links), 0.0, rate); }});

    cases.push_back({"motor strength",
                     "N m",
                     "two bars of 1 kg on a motor of 10 rad/s, 5 s; gaps up to 1 mm, the speed within 1 % from 1 s on",
                     {1e2, 1e3, 1e4, 1e6, 1e9},
                     stability_rates(),
                     driven_bars});

    cases.push_back(
        {"limit at speed",
         "rad/s",
         "bar that hits a limit, and 1 s; never more than 0.01 rad beyond it, at it in the end, no energy gained",
         {1.0, 10.0, 100.0, 1000.0},
         stability_rates(),
         hit_limit});

    cases.push_back({"break",
                     "strength, N",
                     "swinging bar; its hinge breaks within 2 steps of the exact time",
                     {8.0, 10.0, 15.0, 20.0, 24.0},
                     stability_rates(),
                     breaking_bar});
}

}  // namespace tumble::bench
