// Bodies at rest that should stay at rest.
#include "harness/shapes.h"
#include "stability/stability_case.h"

#include <algorithm>

namespace tumble::bench {
namespace {

// The largest displacement of any body from its start, over `limit` (m).
auto farthest(const Scene& scene, double limit) {
    std::vector<Vector> starts;
    std::vector<std::size_t> moving;
    for (std::size_t i = 0; i < scene.bodies.size(); ++i)
        if (scene.bodies[i].moves()) {
            moving.push_back(i);
            starts.push_back(scene.bodies[i].position);
        }
    return [=](double, const std::vector<Motion>& motions) {
        double worst = 0.0;
        for (std::size_t k = 0; k < moving.size(); ++k)
            worst = std::max(worst, norm(motions[moving[k]].position - starts[k]) / limit);
        return worst;
    };
}

Scene stack(int boxes, double size, double aside) {
    Scene scene;
    for (int i = 0; i < boxes; ++i)
        scene.bodies.push_back(box({size, size, size}, size * size * size, {aside, aside, (0.5 + i) * size}));
    scene.bodies.push_back(fixed_box({50.0 * size, 50.0 * size, 2.0 * size}, {aside, aside, -size}));
    set_materials(scene, 0.5, 0.0);
    return scene;
}

Trial resting(const Scene& scene, double seconds, double limit) {
    Trial trial{scene, seconds, 1, farthest(scene, limit)};
    return trial;
}

}  // namespace

void add_loads(std::vector<StabilityCase>& cases) {
    cases.push_back({"stack",
                     "boxes",
                     "5 s; no box moves by more than 1 cm",
                     {5, 10, 20, 50, 100},
                     stability_rates(),
                     [](double n, double) { return resting(stack(int(n), 1.0, 0.0), 5.0, 0.01); }});

    cases.push_back({"heavy on light",
                     "mass ratio",
                     "5 s; neither box moves by more than 1 mm",
                     {1.0, 1e2, 1e3, 1e4, 1e6, 1e8},
                     stability_rates(),
                     [](double ratio, double) {
                         Scene scene = stack(2, 1.0, 0.0);
                         scene.bodies[1].mass = ratio;
                         return resting(scene, 5.0, 1e-3);
                     }});

    cases.push_back({"scale",
                     "edge, m",
                     "stack of 5 boxes, 5 s; no box moves by more than 1 % of its edge",
                     {1e-3, 1e-2, 0.1, 1.0, 10.0, 100.0, 1e3},
                     stability_rates(),
                     [](double size, double) { return resting(stack(5, size, 0.0), 5.0, 0.01 * size); }});

    cases.push_back({"far from the origin",
                     "m, in x and y",
                     "stack of 5 boxes of 1 m, 5 s; no box moves by more than 1 cm",
                     {0.0, 1e2, 1e3, 1e4, 1e5},
                     stability_rates(),
                     [](double aside, double) { return resting(stack(5, 1.0, aside), 5.0, 0.01); }});

    cases.push_back({"600 s of rest",
                     "boxes",
                     "no box moves by more than 1 mm",
                     {1, 3},
                     {30.0, 60.0, 240.0, 960.0},
                     [](double n, double rate) {
                         Trial trial = resting(stack(int(n), 1.0, 0.0), 600.0, 1e-3);
                         trial.look_every = std::lround(rate);
                         return trial;
                     }});
}

}  // namespace tumble::bench
