// One body and the ground, against closed forms.
#include "accuracy/accuracy_case.h"

#include <algorithm>
#include <numbers>

namespace tumble::bench {
namespace {

// Clearance (m) of a ball released at height h over the ground that keeps the fraction e of its speed at each bounce: a
// fall of t0 = sqrt(2 h / g), then hops of 2 t0 e, 2 t0 e^2, ... that end at t0 (1 + e) / (1 - e).
double bouncing_clearance(double h, double e, double t) {
    double speed = std::sqrt(2.0 * g * h), start = std::sqrt(2.0 * h / g);
    if (t < start) return h - 0.5 * g * t * t;
    if (e == 1.0) {  // all hops are equal: no sum is needed
        const double hop = 2.0 * start, s = std::fmod(t - start, hop);
        return speed * s - 0.5 * g * s * s;
    }
    for (speed *= e; speed > 1e-12; speed *= e) {
        const double hop = 2.0 * speed / g;
        if (t < start + hop) return speed * (t - start) - 0.5 * g * (t - start) * (t - start);
        start += hop;
    }
    return 0.0;
}

double lowest_point(const Body& body, const Motion& motion) {
    if (body.kind == Kind::sphere) return motion.position.z - body.radius;
    const Vector up = rotate_back(motion.orientation, {0.0, 0.0, 1.0});
    return motion.position.z -
           0.5 * (std::abs(up.x) * body.size.x + std::abs(up.y) * body.size.y + std::abs(up.z) * body.size.z);
}

// Largest energy error over m g 1 m without contact (MuJoCo's contacts store energy as springs); for vertical falls
// also the height against the parabolas and the spin.
class ElasticObserver : public Observer {
public:
    ElasticObserver(const Scene& scene, bool straight, bool box) : scene_(scene), straight_(straight), box_(box) {}

    void see(long step, double rate, const std::vector<Motion>& motions) override {
        const Body& body = scene_.bodies[0];
        const double now = energy(scene_, motions);
        if (step == 0) start_ = now;
        if (lowest_point(body, motions[0]) >= 0.0)
            energy_ = std::max(energy_, std::abs(now - start_) / (body.mass * g * 1.0));
        spin_ = std::max(spin_, norm(motions[0].angular_velocity));
        const double fallen = bouncing_clearance(1.0, 1.0, double(step) / rate) - 1.0;
        height_ = std::max(height_, std::abs(motions[0].position.z - (body.position.z + fallen)));
    }

    std::vector<Error> errors() const override {
        std::vector<Error> all{{"energy", energy_, "m g 1 m"}};
        if (straight_) all.push_back({"height", height_, "m"});
        if (straight_ && box_) all.push_back({"spin", spin_, "rad/s"});
        return all;
    }

private:
    Scene scene_;
    bool straight_, box_;
    double start_ = 0.0, energy_ = 0.0, height_ = 0.0, spin_ = 0.0;
};

// A ball that bounces ever lower: height against the closed form, the time from which it rests, and its path.
class SettlingObserver : public Observer {
public:
    SettlingObserver(const Scene& scene, double h, double e) : ball_(scene.bodies[0]), h_(h), e_(e) {}

    void see(long step, double rate, const std::vector<Motion>& motions) override {
        const double t = double(step) / rate, clearance = motions[0].position.z - ball_.radius,
                     speed = motions[0].velocity.z;
        height_ = std::max(height_, std::abs(clearance - bouncing_clearance(h_, e_, t)));
        // At rest: slower than gravity's change of speed in two steps.
        if (std::abs(speed) > 2.0 * g / rate) rest_ = (double(step) + 1.0) / rate;
        if (step > 0) path_ += path_between(clearance_, speed_, clearance, speed, 1.0 / rate);
        clearance_ = clearance;
        speed_ = speed;
    }

    std::vector<Error> errors() const override {
        const double rest = std::sqrt(2.0 * h_ / g) * (1.0 + e_) / (1.0 - e_),
                     path = h_ * (1.0 + e_ * e_) / (1.0 - e_ * e_);
        return {{"height", height_, "m"},
                {"time of rest", std::abs(rest_ - rest), "s"},
                {"path", std::abs(path_ - path), "m"}};
    }

private:
    // Length of the path between two states a step apart. Free: through the turning point. With a bounce between them:
    // down from the first state, up to the second, and the hops in between if the step hides any.
    double path_between(double z0, double v0, double z1, double v1, double h) const {
        if (std::abs(v1 - v0 + g * h) < 1e-6 * g * h)
            return v0 > 0.0 && v1 < 0.0 ? (v0 * v0 + v1 * v1) / (2.0 * g) : std::abs(z1 - z0);
        const double up = std::max(v0, 0.0), down = std::max(-v1, 0.0), low = std::max(z0, 0.0),
                     high = std::max(z1, 0.0);
        double path = up * up / g + low + high + down * down / g;
        const double hit = std::sqrt(v0 * v0 + 2.0 * g * low), last = std::sqrt(v1 * v1 + 2.0 * g * high);
        for (double v = e_ * hit; v > 1e-12 && e_ * v > 0.999 * last; v *= e_) path += v * v / g;
        return path;
    }

    Body ball_;
    double h_, e_;
    double height_ = 0.0, rest_ = 0.0, path_ = 0.0, clearance_ = 0.0, speed_ = 0.0;
};

// The time of rest without the resolution of a step: bisection over the length of one single step.
std::vector<Error> time_of_rest(const Scene& scene, const Variant& variant) {
    const double h = scene.bodies[0].position.z - scene.bodies[0].radius, e = scene.bodies[0].restitution;
    const double rest = std::sqrt(2.0 * h / g) * (1.0 + e) / (1.0 - e);
    double moving = 0.9 * rest, still = 1.2 * rest;
    for (int i = 0; i < 40; ++i) {
        const double middle = 0.5 * (moving + still);
        const auto world = variant.make(scene, 1.0 / middle);
        world->step();
        (norm(world->motion(0).velocity) > 1e-7 ? moving : still) = middle;
    }
    return {{"time of rest", std::abs(still - rest), "s"}};
}

// A cube shot at a thin wall: the energy of its rebound; 1 when it does not rebound.
class WallObserver : public Observer {
public:
    explicit WallObserver(const Scene& scene) : scene_(scene) {}
    void see(long step, double, const std::vector<Motion>& motions) override {
        const double now = energy(scene_, motions);
        if (step == 0) start_ = now;
        const bool back = motions[0].velocity.x < 0.0 && motions[0].position.x < 0.0;
        error_ = back ? std::abs(now / start_ - 1.0) : 1.0;
    }
    std::vector<Error> errors() const override { return {{"energy", error_, "1"}}; }

private:
    Scene scene_;
    double start_ = 0.0, error_ = 0.0;
};

Body ground(double restitution) {
    Body plane;
    plane.kind = Kind::plane;
    plane.restitution = restitution;
    return plane;
}

AccuracyCase elastic(const std::string& name, const Body& body) {
    AccuracyCase c;
    c.name = name;
    c.scene.bodies = {body, ground(1.0)};
    c.rates = ladder();
    const bool box = body.kind == Kind::box, straight = !box || body.orientation.w == 1.0;
    c.observe = [=](const Scene& s, double) { return std::make_unique<ElasticObserver>(s, straight, box); };
    return c;
}

}  // namespace

void add_bounces(std::vector<AccuracyCase>& cases) {
    Body sphere;
    sphere.radius = 0.5;
    sphere.position = {0.0, 0.0, 1.5};  // 1 m of clearance
    cases.push_back(elastic("elastic sphere", sphere));

    Body box;
    box.kind = Kind::box;
    box.size = {1.0, 1.0, 1.0};
    box.position = {0.0, 0.0, 1.5};
    cases.push_back(elastic("elastic box, flat", box));

    box.orientation = turn({1.0, 2.0, 0.0}, 0.5);
    box.position.z = 0.0;
    box.position.z = 1.0 - lowest_point(box, {box.position, box.orientation, {}, {}});
    cases.push_back(elastic("elastic box, tilted", box));

    Body ball;
    ball.radius = 0.1;
    ball.restitution = 0.8;
    ball.position = {0.0, 0.0, 5.1};
    AccuracyCase settling;
    settling.name = "ball coming to rest";
    settling.scene.bodies = {ball, ground(0.8)};
    settling.seconds = settling.quick_seconds = 12.0;
    settling.rates = ladder();
    settling.observe = [](const Scene& s, double) { return std::make_unique<SettlingObserver>(s, 5.0, 0.8); };
    settling.probe = time_of_rest;
    cases.push_back(settling);

    for (const double thickness : {0.01, 0.001}) {
        Body cube, wall;
        cube.kind = wall.kind = Kind::box;
        cube.size = {0.1, 0.1, 0.1};
        cube.velocity = {500.0, 0.0, 0.0};
        cube.position = {-3.0, 0.0, 0.0};
        wall.size = {thickness, 4.0, 4.0};
        wall.fixed = true;
        AccuracyCase c;
        c.name = thickness > 0.005 ? "500 m/s at 10 mm" : "500 m/s at 1 mm";
        c.demand = Demand::thin_wall;
        c.scene.gravity = 0.0;
        c.scene.bodies = {cube, wall};
        c.seconds = c.quick_seconds = 0.1;
        c.rates = ladder();
        c.observe = [](const Scene& s, double) { return std::make_unique<WallObserver>(s); };
        cases.push_back(c);
    }
}

}  // namespace tumble::bench
