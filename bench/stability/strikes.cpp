// Bodies that fly, slide or fall, or start with an overlap.
#include "harness/penetration.h"
#include "harness/random.h"
#include "harness/shapes.h"
#include "stability/stability_case.h"

#include <algorithm>
#include <memory>

namespace tumble::bench {
namespace {

// Ten spheres and ten cubes of 0.1 m, from different distances, at a wall of 1 cm.
Trial thin_wall(double speed, double rate) {
    Trial trial;
    Scene& scene = trial.scene;
    scene.gravity = 0.0;
    for (int i = 0; i < 20; ++i) {
        const Vector place{-20.0 - 0.413 * (i / 2), i - 9.5, 0.0};
        Body body = i % 2 == 0 ? sphere(0.05, 1.0, place) : box({0.1, 0.1, 0.1}, 1.0, place);
        if (i % 4 == 1) body.orientation = turn({1.0, 2.0, 3.0}, 0.7 + 0.1 * i);
        body.velocity = {speed, 0.0, 0.0};
        scene.bodies.push_back(body);
    }
    scene.bodies.push_back(fixed_box({0.01, 40.0, 10.0}, {}));
    set_materials(scene, 0.0, 0.0);
    trial.seconds = std::max(30.0 / speed, 5.0 / rate);
    trial.watch = [](double, const std::vector<Motion>& motions) {
        double worst = 0.0;
        for (std::size_t i = 0; i < 20; ++i) worst = std::max(worst, motions[i].position.x > 0.0 ? 2.0 : 0.0);
        return worst;
    };
    return trial;
}

// A ball released at 1 m: its first rebound, against e^2, and its energy.
Trial rebound(double e, double) {
    Trial trial;
    trial.scene.bodies = {sphere(0.5, 1.0, {0.0, 0.0, 1.5}), plane({0.0, 0.0, 1.0}, 0.0)};
    set_materials(trial.scene, 0.0, e);
    const double fall = std::sqrt(2.0 / g), apex = fall + e * fall, landing = fall + 2.0 * e * fall;
    trial.seconds = 3.0;
    const auto highest = std::make_shared<double>(0.0);
    trial.watch = [=, scene = trial.scene](double time, const std::vector<Motion>& motions) {
        const double height = motions[0].position.z - 0.5;
        if (time > fall + 0.5 * (apex - fall) && time < landing) *highest = std::max(*highest, height);
        const double gain = (energy(scene, motions) / (g * 1.5) - 1.0) / 0.01;
        const bool over = time >= trial.seconds - 1e-9;
        return std::max(gain, over && e > 0.0 ? std::abs(*highest - e * e) / 0.05 : 0.0);
    };
    return trial;
}

// A box on a slope of atan(0.6): stick or slip, and its displacement.
Trial slope(double friction, double) {
    const double angle = std::atan(0.6);
    const Orientation q = turn({0.0, 1.0, 0.0}, angle);
    const Vector normal = rotate(q, {0.0, 0.0, 1.0}), down = rotate(q, {1.0, 0.0, 0.0});
    Trial trial;
    trial.scene.bodies = {box({1.0, 0.6, 0.4}, 1.0, 0.2 * normal), fixed_box({200.0, 200.0, 2.0}, -1.0 * normal)};
    for (Body& body : trial.scene.bodies) body.orientation = q;
    set_materials(trial.scene, friction, 0.0);
    trial.seconds = 3.0;
    const double acceleration = std::max(0.0, g * (std::sin(angle) - friction * std::cos(angle)));
    trial.watch = [=](double time, const std::vector<Motion>& motions) {
        const double way = 0.5 * acceleration * time * time, late = acceleration * time / 30.0;
        return std::abs(dot(down, motions[0].position) - way) / (0.01 * std::max(1.0, way) + late);
    };
    return trial;
}

// Two boxes that overlap, without gravity.
Trial overlapping(double share, double) {
    Trial trial;
    trial.scene.gravity = 0.0;
    trial.scene.bodies = {box({1.0, 1.0, 1.0}, 1.0, {}), box({1.0, 1.0, 1.0}, 1.0, {1.0 - share, 0.0, 0.0})};
    set_materials(trial.scene, 0.5, 0.0);
    trial.watch = [scene = trial.scene, seconds = trial.seconds](double time, const std::vector<Motion>& motions) {
        const double speed = std::max(norm(motions[0].velocity), norm(motions[1].velocity)) / 10.0;
        if (time < seconds - 1e-9) return speed;
        return std::max(speed, penetration(scene, motions).largest / 0.01);
    };
    return trial;
}

// A needle of 1 m that falls on its tip; it should end on the floor, no faster than it started.
Trial needle(double width, double) {
    Trial trial;
    trial.scene.bodies = {box({1.0, width, width}, 1.0, {0.0, 0.0, 1.0}), floor_box()};
    trial.scene.bodies[0].orientation = turn({0.2, 1.0, 0.0}, -1.0);
    set_materials(trial.scene, 0.5, 0.0);
    trial.watch = [scene = trial.scene](double, const std::vector<Motion>& motions) {
        const double gain = (energy(scene, motions) / g - 1.0) / 0.01, below = motions[0].position.z < 0.0 ? 2.0 : 0.0;
        return std::max(gain, below);
    };
    return trial;
}

}  // namespace

void add_strikes(std::vector<StabilityCase>& cases) {
    cases.push_back({"thin wall",
                     "m/s",
                     "spheres and cubes of 0.1 m at a wall of 1 cm; none of 20 gets to the other side",
                     {10.0, 1e2, 1e3, 1e4},
                     stability_rates(),
                     thin_wall});
    cases.push_back({"restitution",
                     "e",
                     "ball from 1 m, 3 s; first rebound e^2 m within 5 cm, energy never 1 % above the start",
                     {0.0, 0.25, 0.5, 0.75, 0.9, 1.0},
                     stability_rates(),
                     rebound});
    cases.push_back({"friction",
                     "mu",
                     "box on a slope of tan 0.6, 3 s; distance as by Coulomb's law within 1 % or 1 cm, and 1/30 s",
                     {0.0, 0.1, 0.3, 0.59, 0.61, 1.0, 10.0},
                     stability_rates(),
                     slope});
    cases.push_back({"deep overlap",
                     "share",
                     "two boxes of 1 m, 5 s; never faster than 10 m/s, apart to 1 cm at the end",
                     {0.01, 0.1, 0.5, 0.9, 1.0},
                     stability_rates(),
                     overlapping});
    cases.push_back({"needle falling",
                     "width, m",
                     "needle of 1 m on a floor, 5 s; never below it, energy never 1 % above the start",
                     {0.1, 0.01, 1e-3},
                     stability_rates(),
                     needle});
}

}  // namespace tumble::bench
