// A ball strikes a spinning plate of cells in free space.
#include "harness/shapes.h"
#include "stability/stability_case.h"

#include <algorithm>
#include <numbers>

namespace tumble::bench {
namespace {

constexpr double restitution = 0.5;

// The largest stress (Pa) in a free bar of the plate's section that a blow bends in its middle: by F L / 8.
double bending_stress(const Body& plate, const Body& ball) {
    const double mass = plate.mass * ball.mass / (plate.mass + ball.mass);
    const double force = (1.0 + restitution) * mass * std::abs(ball.velocity.z) / plate.breakage->blow_time;
    return force * plate.size.x / 8.0 / (plate.size.y * plate.size.z * plate.size.z / 6.0);
}

Trial struck_plate(int cells, double strength) {
    constexpr double density = 2500.0, radius = 0.05, clear = 10.0;
    Trial trial;
    Scene& scene = trial.scene;
    scene.gravity = 0.0;
    const Vector size{0.6, 0.5, 0.05};
    Body plate = box(size, density * size.x * size.y * size.z, {});
    plate.angular_velocity = {0.4, -0.3, 0.2};
    const double stiffness = 1000.0 * strength, toughness = 1.0;
    plate.breakage = {cells, strength, stiffness, toughness, 2.0 * norm(size) / std::sqrt(stiffness / density)};
    Body ball = sphere(radius, 7800.0 * 4.0 / 3.0 * std::numbers::pi * radius * radius * radius, {0.03, 0.04, 0.3});
    ball.velocity = {0.2, -0.1, -9.0};
    scene.bodies = {plate, ball};
    set_materials(scene, 0.3, restitution);
    trial.seconds = 0.5;

    std::vector<Motion> start;
    for (const Body& body : scene.bodies)
        start.push_back({body.position, body.orientation, body.velocity, body.angular_velocity});
    const double kinetic = energy(scene, start), thrust = ball.mass * norm(ball.velocity);
    const Vector momentum = ball.mass * ball.velocity;
    const Vector angular = cross(ball.position, momentum) + angular_momentum(plate, start[0]);
    const double stress = bending_stress(plate, ball);
    trial.watch = [](double, const std::vector<Motion>&) { return 0.0; };
    trial.watch_totals = [=, seconds = trial.seconds](double time, const Totals& totals) {
        const double worst = std::max({norm(totals.momentum - momentum) / (1e-9 * thrust),
                                       norm(totals.angular_momentum - angular) / (1e-3 * thrust * size.x),
                                       (totals.kinetic / kinetic - 1.0) / 1e-6});
        const bool broken = totals.bodies > 2;
        const bool wrong = broken ? stress * clear < strength : time > seconds - 1e-9 && stress > clear * strength;
        return wrong ? HUGE_VAL : worst;
    };
    return trial;
}

}  // namespace

void add_breaking(std::vector<StabilityCase>& cases) {
    const std::string line =
        "ball of 4 kg at 9 m/s on a spinning plate, 0.5 s; momentum of all pieces constant to 1e-9, angular momentum "
        "to "
        "1e-3, kinetic energy never 1e-6 above the start; ";
    cases.push_back({"breaking plate",
                     "cells",
                     line + "it breaks: it is loaded to 23 times its strength",
                     {2, 8, 30, 100, 300},
                     stability_rates(),
                     [](double cells, double) { return struck_plate(int(cells), 1e5); },
                     true});
    cases.push_back({"plate strength",
                     "strength, Pa",
                     line + "it breaks where it is loaded to more than 10 times its strength, and holds below a tenth",
                     {1e2, 1e4, 1e6, 1e8, 1e10, 1e12},
                     stability_rates(),
                     [](double strength, double) { return struck_plate(30, strength); },
                     true});
}

}  // namespace tumble::bench
