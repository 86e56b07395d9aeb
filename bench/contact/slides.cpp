// Sticking or sliding, rolling, and 600 s of rest.
#include "contact/witness.h"
#include "harness/shapes.h"

#include <algorithm>

namespace tumble::bench {
namespace {

// Displacement down an incline from 1 s on, compared with Coulomb's law, and the gap to the slope at the end.
class Slide : public Witness {
public:
    Slide(const Vector& down, double acceleration) : down_(down), acceleration_(acceleration) {}
    void see(double time, const std::vector<Motion>& motions) override {
        const double way = dot(down_, motions[0].position);
        if (time <= 1.0 + 1e-9) {
            start_ = way;
            from_ = time;
        }
        way_ = way - start_;
        exact_ = 0.5 * acceleration_ * (time * time - from_ * from_);
    }
    std::vector<Quantity> tell() const override {
        return {{"distance", way_, "m"}, {"error of the distance", std::abs(way_ - exact_), "m"}};
    }

private:
    Vector down_;
    double acceleration_, start_ = 0.0, from_ = 0.0, way_ = 0.0, exact_ = 0.0;
};

// A box on a slope of atan(0.6), with friction `share` times tan of the slope.
ContactCase incline(const std::string& name, double share) {
    const double slope = std::atan(0.6);
    ContactCase c;
    c.name = name;
    const Orientation q = turn({0.0, 1.0, 0.0}, slope);
    const Vector normal = rotate(q, {0.0, 0.0, 1.0}), down = rotate(q, {1.0, 0.0, 0.0});
    c.scene.bodies = {box({1.0, 1.0, 1.0}, 1.0, 0.5 * normal), fixed_box({200.0, 200.0, 2.0}, -1.0 * normal)};
    for (Body& body : c.scene.bodies) body.orientation = q;
    set_materials(c.scene, 0.6 * share, 0.0);
    const double acceleration = std::max(0.0, g * std::sin(slope) * (1.0 - share));
    c.witness = [=](const Scene&) { return std::make_unique<Slide>(down, acceleration); };
    return c;
}

// SimBenchmark "rolling": the mean over the steps of the squared errors of the velocities of plate and first ball.
class Rolling : public Witness {
public:
    explicit Rolling(const Vector& along) : along_(along) {}
    void see(double time, const std::vector<Motion>& motions) override {
        const double limit = 0.4 * 35.0 * g, second = (150.0 - limit) / (3.5 * 10.0 + 25.0);
        const Vector plate = motions[0].velocity - 3.5 * second * time * along_;
        const Vector ball = motions[1].velocity - second * time * along_;
        sum_ += dot(plate, plate) + dot(ball, ball);
        ++looks_;
    }
    std::vector<Quantity> tell() const override { return {{"velocity", sum_ / double(looks_), "m^2/s^2"}}; }

private:
    Vector along_;
    double sum_ = 0.0;
    long looks_ = 0;
};

ContactCase rolling(const std::string& name, const Vector& along) {
    ContactCase c;
    c.name = name;
    c.rate = 1000.0;
    c.seconds = 4.0;
    c.look_every = 0.001;
    Body plate = box({20.0, 20.0, 1.0}, 10.0, {0.0, 0.0, 0.5});
    plate.friction = 0.8;
    c.scene.bodies.push_back(plate);
    for (int i = 0; i < 25; ++i) {
        Body ball = sphere(0.5, 1.0, {2.0 * (i % 5 - 2), 2.0 * (i / 5 - 2), 1.5});
        ball.friction = 0.8;
        c.scene.bodies.push_back(ball);
    }
    Body ground = plane({0.0, 0.0, 1.0}, 0.0);
    ground.friction = 0.2;  // between ground and plate: sqrt(0.2 * 0.8) = 0.4
    c.scene.bodies.push_back(ground);
    for (Body& body : c.scene.bodies) body.restitution = 0.0;
    c.scene.push = PointForce{{0.0, 0.0, 0.0}, 150.0 * along};
    c.witness = [along](const Scene&) { return std::make_unique<Rolling>(along); };
    return c;
}

}  // namespace

void add_slides(std::vector<ContactCase>& cases) {
    cases.push_back(incline("incline: friction 0.1 % above tan", 1.001));
    cases.push_back(incline("incline: friction 0.1 % below tan", 0.999));
    cases.push_back(incline("incline: friction 10 % below tan", 0.9));
    cases.push_back(rolling("SimBenchmark rolling", {1.0, 0.0, 0.0}));
    cases.push_back(rolling("SimBenchmark rolling, diagonal", {0.5, std::sqrt(0.75), 0.0}));
    ContactCase rest;
    rest.name = "a box at rest";
    rest.seconds = 600.0;
    rest.look_every = 1.0;
    rest.scene.bodies = {box({1.0, 1.0, 1.0}, 1.0, {0.0, 0.0, 0.5}), plane({0.0, 0.0, 1.0}, 0.0)};
    set_materials(rest.scene, 0.5, 0.0);
    rest.witness = [](const Scene& scene) { return witness_of_standing(scene, 0.1); };
    cases.push_back(rest);
}

}  // namespace tumble::bench
