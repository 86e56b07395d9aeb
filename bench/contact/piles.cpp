// Many boxes: speed and overlap.
#include "contact/witness.h"
#include "harness/random.h"
#include "harness/shapes.h"

#include <algorithm>
#include <numbers>

namespace tumble::bench {
namespace {

// side^3 unit boxes dropped into a pit: in a grid with small tilts, or with random rotations.
ContactCase pile(const std::string& name, int side, bool rotated) {
    const double pitch = rotated ? 1.8 : 1.25, lowest = rotated ? 1.0 : 0.75, middle = 0.5 * (side - 1);
    ContactCase c;
    c.name = name;
    c.task = Task::pile;
    c.look_every = 10.0;
    c.witness = witness_of_overlap;
    Random random(42);
    for (int k = 0; k < side; ++k)
        for (int j = 0; j < side; ++j)
            for (int i = 0; i < side; ++i) {
                // z, y, x: the order of the draws in the measurements behind the published tables.
                const double z = lowest + pitch * k + 0.05 * random.both();
                const double y = (j - middle) * pitch + 0.05 * random.both();
                const double x = (i - middle) * pitch + 0.05 * random.both();
                Body b = box({1.0, 1.0, 1.0}, 1.0, {x, y, z});
                b.orientation = random.turned(rotated ? std::numbers::pi : 0.1);
                c.scene.bodies.push_back(b);
            }
    add_pit(c.scene, 0.5 * side * pitch + 0.25, pitch * side + 5.0);
    set_materials(c.scene, 0.5, 0.0);
    return c;
}

// A ball that bounces without end, alone or beside boxes at rest: only the ball should have a cost.
ContactCase sleepers(const std::string& name, int side) {
    ContactCase c;
    c.name = name;
    c.task = Task::sleeping;
    c.look_every = 10.0;
    c.witness = witness_of_overlap;
    c.scene.bodies.push_back(plane({0.0, 0.0, 1.0}, 0.0));
    for (int j = 0; j < side; ++j)
        for (int i = 0; i < side; ++i) c.scene.bodies.push_back(box({1.0, 1.0, 1.0}, 1.0, {1.5 * i, 1.5 * j, 0.5}));
    set_materials(c.scene, 0.5, 0.0);
    Body ball = sphere(0.5, 1.0, {-5.0, 0.0, 1.5});
    ball.restitution = 1.0;
    c.scene.bodies.push_back(ball);
    return c;
}

// Change of the mechanical energy between observations.
class Gain : public Witness {
public:
    explicit Gain(const Scene& scene) : scene_(scene) {}
    void see(double, const std::vector<Motion>& motions) override {
        const double now = energy(scene_, motions);
        if (first_) start_ = last_ = now;
        first_ = false;
        const double gain = now - last_;
        largest_ = std::isnan(now) ? HUGE_VAL : std::max(largest_, gain / start_);
        if (gain > 0.0) sum_ += gain / start_;
        last_ = now;
    }
    std::vector<Quantity> tell() const override {
        return {{"largest gain of energy in a step", largest_, "of the start"}, {"sum of gains", sum_, "of the start"}};
    }

private:
    Scene scene_;
    bool first_ = true;
    double start_ = 0.0, last_ = 0.0, largest_ = 0.0, sum_ = 0.0;
};

ContactCase mixed_boxes(double friction) {
    ContactCase c;
    c.name = friction > 0.0 ? "60 boxes in a pit: energy" : "60 smooth boxes in a pit: energy";
    c.look_every = 1.0 / 60.0;
    c.witness = [](const Scene& scene) { return std::make_unique<Gain>(scene); };
    Random random(7);
    for (int i = 0; i < 60; ++i) {
        const double mass = 1.0 + 3.0 * random.unit();
        Body b = box({1.0, 0.6, 0.8}, mass, {(i % 3 - 1) * 1.4, (i / 3 % 3 - 1) * 1.4, 1.0 + 1.3 * (i / 9)});
        b.orientation = random.turned(3.0);
        c.scene.bodies.push_back(b);
    }
    add_pit(c.scene, 2.4, 20.0);
    set_materials(c.scene, friction, 0.0);
    return c;
}

}  // namespace

void add_piles(std::vector<ContactCase>& cases) {
    cases.push_back(pile("pile of 1000", 10, false));
    cases.push_back(pile("pile of 1000 rotated", 10, true));
    cases.push_back(pile("pile of 8000", 20, false));
    cases.push_back(pile("pile of 8000 rotated", 20, true));
    for (const bool rotated : {false, true}) {  // with time to come to rest
        cases.push_back(pile(rotated ? "pile of 1000 rotated, settled" : "pile of 1000, settled", 10, rotated));
        cases.back().task = Task::settled;
        cases.back().seconds = 30.0;
        cases.back().look_every = 30.0;
    }
    cases.push_back(sleepers("a ball alone", 0));
    cases.push_back(sleepers("a ball and 10,000 sleeping boxes", 100));
    cases.push_back(mixed_boxes(0.5));
    cases.push_back(mixed_boxes(0.0));
}

}  // namespace tumble::bench
