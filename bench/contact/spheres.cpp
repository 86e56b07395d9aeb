// Spheres without friction that come to rest.
#include "contact/contact_case.h"
#include "harness/penetration.h"
#include "harness/random.h"
#include "harness/shapes.h"

#include <algorithm>

namespace tumble::bench {
namespace {

// The mean over time, from `from` on, of the mean and of the largest penetration.
class Settled : public Witness {
public:
    Settled(const Scene& scene, double from) : scene_(scene), from_(from) {}
    void see(double time, const std::vector<Motion>& motions) override {
        if (time <= from_) return;
        const Penetration p = penetration(scene_, motions);
        mean_ += p.mean;
        largest_ += p.largest;
        ++looks_;
    }
    std::vector<Quantity> tell() const override {
        const double n = double(std::max(looks_, 1L));
        return {{"mean penetration", 1e3 * mean_ / n, "mm"}, {"largest penetration", 1e3 * largest_ / n, "mm"}};
    }

private:
    Scene scene_;
    double from_, mean_ = 0.0, largest_ = 0.0;
    long looks_ = 0;
};

// SimBenchmark's metric: the mean over the steps of the sum of squared penetrations.
class Squares : public Witness {
public:
    explicit Squares(const Scene& scene) : scene_(scene) {}
    void see(double, const std::vector<Motion>& motions) override {
        sum_ += penetration(scene_, motions).squares;
        ++looks_;
    }
    std::vector<Quantity> tell() const override { return {{"penetration", sum_ / double(looks_), "m^2"}}; }

private:
    Scene scene_;
    double sum_ = 0.0;
    long looks_ = 0;
};

}  // namespace

void add_spheres(std::vector<ContactCase>& cases) {
    for (const int rate : {60, 120, 240, 480}) {
        ContactCase c;
        c.name = "216 spheres at rest at 1/" + std::to_string(rate);
        c.task = Task::spheres;
        c.rate = rate;
        c.look_every = 1.0 / 60.0;
        c.witness = [](const Scene& scene) { return std::make_unique<Settled>(scene, 5.0); };
        Random random(666);
        for (int i = 0; i < 216; ++i) {
            const double z = 0.55 + 1.05 * (i / 36) + 0.01 * random.both();
            const double y = (i / 6 % 6 - 2.5) * 1.05 + 0.01 * random.both();
            const double x = (i % 6 - 2.5) * 1.05 + 0.01 * random.both();
            c.scene.bodies.push_back(sphere(0.5, 10.0, {x, y, z}));
        }
        add_pit(c.scene, 3.2, 12.0);
        set_materials(c.scene, 0.0, 0.0);
        cases.push_back(c);
    }
    for (const int rate : {100, 1000}) {
        ContactCase c;
        c.name = "SimBenchmark 666 at 1/" + std::to_string(rate);
        c.task = Task::spheres;
        c.rate = rate;
        c.look_every = 1.0 / rate;
        c.witness = [](const Scene& scene) { return std::make_unique<Squares>(scene); };
        Random random(1);
        for (int i = 0; i < 216; ++i) {  // up to 1 mm off the grid, so that it does not stand as columns
            const double x = 0.21 * (i % 6) + 0.001 * random.unit(), y = 0.21 * (i / 6 % 6) + 0.001 * random.unit();
            c.scene.bodies.push_back(sphere(0.1, 10.0, {x, y, 0.101 + 0.21 * (i / 36) + 0.001 * random.unit()}));
        }
        c.scene.bodies.push_back(plane({0.0, 0.0, 1.0}, 0.0));
        set_materials(c.scene, 0.0, 0.0);
        cases.push_back(c);
    }
}

}  // namespace tumble::bench
