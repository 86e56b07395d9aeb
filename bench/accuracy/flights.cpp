// Flights without impacts, against references in 113-bit arithmetic.
#include "accuracy/accuracy_case.h"
#include "accuracy/high_precision.h"

#include <algorithm>

namespace tumble::bench {
namespace {

// Largest errors over the frames of a 60 Hz clip (30 Hz at a step of 1/30 s). The largest angle between two rotating
// bodies soon reaches pi where one flips before the other: the angle at the end distinguishes such methods.
class FlightObserver : public Observer {
public:
    FlightObserver(const Scene& scene, bool free) : scene_(scene), free_(free), reference_(scene) {}

    void see(long step, double rate, const std::vector<Motion>& motions) override {
        const double frames = std::min(rate, 60.0);
        const long stride = std::lround(rate / frames);
        if (step % stride != 0) return;
        if (step > 0) reference_.advance(Quad(1) / frames);
        const Motion& m = motions[0];
        position_ = std::max(position_, reference_.position_error(m));
        last_orientation_ = reference_.orientation_error(m);
        orientation_ = std::max(orientation_, last_orientation_);
        const Vector spin = angular_momentum(scene_.bodies[0], m);
        const double now = energy(scene_, motions);
        if (step == 0) {
            spin_ = spin;
            energy_ = now;
        }
        energy_error_ = std::max(energy_error_, std::abs(now / energy_ - 1.0));
        spin_error_ = std::max(spin_error_, norm(spin - spin_) / norm(spin_));
    }

    std::vector<Error> errors() const override {
        if (!free_) return {{"orientation", orientation_, "rad"}, {"position", position_, "m"}};
        return {{"orientation", orientation_, "rad"},
                {"orientation at the end", last_orientation_, "rad"},
                {"energy", energy_error_, "1"},
                {"angular momentum", spin_error_, "1"}};
    }

private:
    Scene scene_;
    bool free_;
    ReferenceFlight reference_;
    double position_ = 0.0, orientation_ = 0.0, last_orientation_ = 0.0, energy_ = 0.0, energy_error_ = 0.0,
           spin_error_ = 0.0;
    Vector spin_;
};

AccuracyCase flight(const std::string& name, const Scene& scene, double seconds) {
    AccuracyCase c;
    c.name = name;
    c.demand = Demand::flight;
    c.scene = scene;
    c.seconds = seconds;
    c.quick_seconds = 1.0;
    c.rates = ladder();
    const bool free = !scene.air && !scene.push;
    c.observe = [free](const Scene& s, double) { return std::make_unique<FlightObserver>(s, free); };
    return c;
}

Body brick() {
    Body box;
    box.kind = Kind::box;
    box.size = {1.0, 0.6, 0.2};
    return box;
}

}  // namespace

void add_flights(std::vector<AccuracyCase>& cases) {
    // Spun about the middle axis (y: 1/12 (1 + 0.04)), which it leaves and flips over, again and again.
    Scene free;
    free.gravity = 0.0;
    free.bodies.push_back(brick());
    free.bodies[0].angular_velocity = {0.01, 5.0, 0.01};
    cases.push_back(flight("torque-free box", free, 10.0));

    // Forces that are not constant: air drag, and a push fixed in the rotating body.
    Scene driven;
    driven.bodies.push_back(brick());
    driven.bodies[0].velocity = {3.0, 0.0, 6.0};
    driven.bodies[0].angular_velocity = {1.0, 2.0, 3.0};
    driven.air = Air{{-4.0, 1.0, 0.0}, 1.2, 1.0};
    driven.push = PointForce{{0.3, 0.1, 0.05}, {0.05, 0.1, 0.2}};
    cases.push_back(flight("box in the wind, pushed", driven, 4.0));
}

}  // namespace tumble::bench
