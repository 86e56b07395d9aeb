// Many bodies: conservation of energy.
#include "accuracy/accuracy_case.h"
#include "harness/shapes.h"

#include <algorithm>
#include <cstdint>

namespace tumble::bench {
namespace {

// SimBenchmark's metric (Kang and Hwangbo 2018): the mean over the steps of (E - E0)^2, sampled before each step.
class MeanSquareObserver : public Observer {
public:
    MeanSquareObserver(const Scene& scene, double seconds) : scene_(scene), seconds_(seconds) {}
    void see(long step, double rate, const std::vector<Motion>& motions) override {
        if (step >= std::lround(seconds_ * rate)) return;
        const double now = energy(scene_, motions);
        if (step == 0) start_ = now;
        sum_ += (now - start_) * (now - start_);
        ++count_;
    }
    std::vector<Error> errors() const override { return {{"energy", sum_ / double(std::max(count_, 1L)), "J^2"}}; }

private:
    Scene scene_;
    double seconds_, start_ = 0.0, sum_ = 0.0;
    long count_ = 0;
};

// Largest relative error of the energy over all steps.
class RelativeObserver : public Observer {
public:
    explicit RelativeObserver(const Scene& scene) : scene_(scene) {}
    void see(long step, double, const std::vector<Motion>& motions) override {
        const double now = energy(scene_, motions);
        if (step == 0) start_ = now;
        error_ = std::max(error_, std::abs(now / start_ - 1.0));
    }
    std::vector<Error> errors() const override { return {{"energy", error_, "1"}}; }

private:
    Scene scene_;
    double start_ = 0.0, error_ = 0.0;
};

// splitmix64 (Steele, Lea and Flood 2014), so that every program gets the same scene.
class Jitter {
public:
    double operator()() {  // 0 .. 1
        std::uint64_t z = state_ += 0x9e3779b97f4a7c15u;
        z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9u;
        z = (z ^ (z >> 27)) * 0x94d049bb133111ebu;
        return double((z ^ (z >> 31)) >> 11) * 0x1p-53;
    }

private:
    std::uint64_t state_ = 42;
};

}  // namespace

void add_crowds(std::vector<AccuracyCase>& cases) {
    Body sphere = bench::sphere(0.1, 10.0, {});

    // SimBenchmark "bouncing": 49 spheres released with their centers at 5 m.
    AccuracyCase bouncing;
    bouncing.name = "SimBenchmark bouncing";
    for (int i = 0; i < 49; ++i) {
        sphere.position = {2.0 * (i % 7), 2.0 * (i / 7), 5.0};
        bouncing.scene.bodies.push_back(sphere);
    }
    bouncing.scene.bodies.push_back(plane({0.0, 0.0, 1.0}, 0.0));
    bouncing.demand = Demand::crowd;
    bouncing.seconds = bouncing.quick_seconds = 20.0;
    bouncing.rates = {10.0, 100.0, 1000.0, 10000.0};
    bouncing.quick_rates = {10.0, 100.0};
    bouncing.observe = [](const Scene& s, double seconds) { return std::make_unique<MeanSquareObserver>(s, seconds); };
    cases.push_back(bouncing);

    // SimBenchmark "elastic 666": 1 mm of upward jitter of the grid, as in the original.
    AccuracyCase elastic;
    elastic.name = "SimBenchmark elastic 666";
    Jitter jitter;
    for (int i = 0; i < 216; ++i) {
        const double x = 0.21 * (i % 6) + 0.001 * jitter(), y = 0.21 * (i / 6 % 6) + 0.001 * jitter();
        sphere.position = {x, y, 1.101 + 0.21 * (i / 36) + 0.001 * jitter()};
        elastic.scene.bodies.push_back(sphere);
    }
    elastic.scene.bodies.push_back(plane({0.0, 0.0, 1.0}, 0.0));
    elastic.demand = Demand::crowd;
    elastic.seconds = 10.0;
    elastic.quick_seconds = 0.6;
    elastic.quick_rates = {60.0};
    elastic.rates = {60.0, 120.0, 240.0, 480.0, 1000.0};  // SimBenchmark publishes the last one
    elastic.observe = bouncing.observe;
    cases.push_back(elastic);

    // Spheres of 1 m that fall into a walled pit.
    AccuracyCase pit;
    pit.name = "elastic spheres in a pit";
    Jitter shake;
    sphere.radius = 0.5;
    for (int i = 0; i < 216; ++i) {
        const auto place = [&](int k) { return 1.05 * (k - 2.5) + 0.01 * (2.0 * shake() - 1.0); };
        const double x = place(i % 6), y = place(i / 6 % 6);
        sphere.position = {x, y, 0.55 + 1.05 * (i / 36) + 0.01 * shake()};
        pit.scene.bodies.push_back(sphere);
    }
    pit.scene.bodies.push_back(plane({0.0, 0.0, 1.0}, 0.0));
    for (const double side : {1.0, -1.0}) {
        pit.scene.bodies.push_back(plane({side, 0.0, 0.0}, -3.2));
        pit.scene.bodies.push_back(plane({0.0, side, 0.0}, -3.2));
    }
    pit.demand = Demand::crowd;
    pit.seconds = 2.0;
    pit.quick_seconds = 0.25;
    pit.quick_rates = {60.0};
    pit.rates = {60.0, 120.0, 240.0, 480.0, 960.0};
    pit.observe = [](const Scene& s, double) { return std::make_unique<RelativeObserver>(s); };
    cases.push_back(pit);
}

}  // namespace tumble::bench
