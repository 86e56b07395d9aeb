// Free rotation: conserved quantities.
#include "harness/shapes.h"
#include "stability/stability_case.h"

#include <algorithm>
#include <memory>

namespace tumble::bench {
namespace {

// The larger of the relative errors of rotational energy and angular momentum (a vector), over 1 %.
auto kept(const Scene& scene) {
    const Body body = scene.bodies[0];
    const Motion start{body.position, body.orientation, body.velocity, body.angular_velocity};
    const auto energy_of = [body](const Motion& m) { return dot(m.angular_velocity, angular_momentum(body, m)); };
    const double energy = energy_of(start);
    const Vector momentum = angular_momentum(body, start);
    return [=](double, const std::vector<Motion>& motions) {
        const double lost = std::abs(energy_of(motions[0]) / energy - 1.0);
        return std::max(lost, norm(angular_momentum(body, motions[0]) - momentum) / norm(momentum)) / 0.01;
    };
}

Trial spinning(const Vector& size, const Vector& spin, double seconds, long look_every) {
    Scene scene;
    scene.gravity = 0.0;
    scene.bodies.push_back(box(size, 1.0, {}));
    scene.bodies[0].angular_velocity = spin;
    return {scene, seconds, look_every, kept(scene)};
}

}  // namespace

void add_spins(std::vector<StabilityCase>& cases) {
    const char* kept_line = "energy and angular momentum stay within 1 %";
    cases.push_back({"spin",
                     "rad/s",
                     std::string("box of 1.0 x 0.6 x 0.2 m about its middle axis, 5 s; ") + kept_line,
                     {1.0, 10.0, 1e2, 1e3, 1e4, 1e5},
                     stability_rates(),
                     [](double spin, double) {
                         return spinning({1.0, 0.6, 0.2}, {0.002 * spin, spin, 0.002 * spin}, 5.0, 1);
                     },
                     true});

    // A needle of edges 1 and w has moments in the ratio (1 + w^2) / (2 w^2).
    cases.push_back({"inertia ratio",
                     "largest over smallest moment",
                     std::string("needle of 1 m, 10 rad/s about a slanting axis, 5 s; ") + kept_line,
                     {1.0, 10.0, 1e2, 1e3, 1e4, 1e5, 1e6},
                     stability_rates(),
                     [](double ratio, double) {
                         const double w = std::sqrt(1.0 / (2.0 * ratio - 1.0));
                         return spinning({1.0, w, w}, {6.0, 8.0, 0.0}, 5.0, 1);
                     },
                     true});

    cases.push_back({"a million steps of tumbling",
                     "rad/s",
                     std::string("box of 1.0 x 0.6 x 0.2 m; ") + kept_line,
                     {1.0, 10.0, 100.0},
                     {60.0, 240.0, 1920.0},
                     [](double spin, double rate) {
                         return spinning({1.0, 0.6, 0.2}, {0.002 * spin, spin, 0.002 * spin}, 1e6 / rate, 1000);
                     },
                     true});
}

}  // namespace tumble::bench
