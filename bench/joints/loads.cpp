// Joints under load: chains at rest, heavy loads on light links.
#include "joints/joint_shapes.h"

#include <algorithm>
#include <numbers>

namespace tumble::bench {
namespace {

// The largest deviation of a joint's height, and of the force at the first end, in the last second.
class RestWatch : public Watch {
public:
    RestWatch(const Scene& scene, double seconds, std::size_t lowest, double sag, double force)
        : scene_(scene), seconds_(seconds), lowest_(lowest), sag_(sag), force_(force) {}

    void see(double time, const Simulator& simulator, const std::vector<Motion>& m) override {
        gap_ = std::max(gap_, largest_gap(scene_, m));
        if (time == 0.0 || time < seconds_ - 1.0) return;
        const Joint& joint = scene_.joints[lowest_];
        off_ = std::max(off_, std::fabs(moved(scene_, joint.second, m[joint.second], joint.anchor).z + sag_));
        if (const auto force = simulator.joint_force(0))
            force_off_ = std::max(force_off_.value_or(0.0), std::fabs(norm(*force) - force_));
    }
    std::vector<Quantity> tell() const override {
        std::vector<Quantity> all{{"error", off_, "m"}, {"gap", gap_, "m"}};
        if (force_off_) all.push_back({"force", *force_off_, "N"});
        return all;
    }

private:
    Scene scene_;
    double seconds_;
    std::size_t lowest_;
    double sag_, force_, gap_ = 0.0, off_ = 0.0;
    std::optional<double> force_off_;
};

JointCase hanging_case(const std::string& name, const std::vector<double>& masses, double link, double thick,
                       double span, double sag, double force) {
    JointCase c;
    c.name = name;
    c.task = JointTask::load;
    c.scene.contacts = false;
    const HangingChain chain = hanging(masses, link, span);
    std::size_t lowest = 0;
    for (std::size_t i = 0; i < masses.size(); ++i) {
        Body body = box({link, thick, thick}, masses[i], 0.5 * (chain.joints[i] + chain.joints[i + 1]));
        body.orientation = along(chain.directions[i]);
        c.scene.bodies.push_back(body);
        c.scene.joints.push_back(ball_joint(i == 0 ? the_world : i - 1, i, chain.joints[i]));
        if (chain.joints[i].z < chain.joints[lowest].z - 1e-9) lowest = i;
    }
    c.scene.joints.push_back(ball_joint(masses.size() - 1, the_world, chain.joints.back()));
    c.seconds = 10.0;
    c.quick_seconds = 1.0;
    c.rates = {60.0, 240.0, 960.0};
    c.quick_rates = {60.0};
    c.look_every = 1.0 / 60.0;
    c.watch = [=](const Scene& scene, double seconds) {
        return std::make_unique<RestWatch>(scene, seconds, lowest, sag, force);
    };
    return c;
}

// J7: 20 links of 0.1 m and 1 kg with a ball of 0.2 m radius at the end, released 30 degrees aside.
JointCase wrecking_ball(double mass, double seconds, const std::string& name) {
    JointCase c;
    c.name = name;
    c.task = JointTask::load;
    c.scene.contacts = false;
    const double lean = std::numbers::pi / 6.0;
    const Vector down{std::sin(lean), 0.0, -std::cos(lean)};
    for (std::size_t i = 0; i < 20; ++i) {
        Body link = box({0.1, 0.02, 0.02}, 1.0, (0.1 * double(i) + 0.05) * down);
        link.orientation = along(down);
        c.scene.bodies.push_back(link);
        c.scene.joints.push_back(ball_joint(i == 0 ? the_world : i - 1, i, 0.1 * double(i) * down));
    }
    c.scene.bodies.push_back(sphere(0.2, mass, 2.2 * down));
    c.scene.joints.push_back(ball_joint(19, 20, 2.0 * down));
    c.seconds = seconds;
    c.quick_seconds = 0.1;
    c.rates = {60.0, 240.0, 960.0, 3840.0};
    c.quick_rates = {60.0};
    c.look_every = 1.0 / 60.0;
    // The fall of all parts to the lowest position.
    c.watch = watch_end(std::nullopt, (1.0 - std::cos(lean)) * g * (2.2 * mass + 20.0));
    return c;
}

class SagWatch : public Watch {
public:
    explicit SagWatch(const Scene& scene) : scene_(scene) {}

    void see(double, const Simulator&, const std::vector<Motion>& m) override {
        gap_ = std::max(gap_, largest_gap(scene_, m));
        sag_ = std::max(sag_, norm(m.back().position - scene_.bodies.back().position));
    }
    std::vector<Quantity> tell() const override { return {{"error", sag_, "m"}, {"gap", gap_, "m"}}; }

private:
    Scene scene_;
    double sag_ = 0.0, gap_ = 0.0;
};

// J22: ten boxes of 0.2 m and 1 kg, fixed to each other and to the ground, leaning by 30 degrees, 100 kg on top.
JointCase leaning_tower() {
    JointCase c;
    c.name = "leaning tower, 100 kg on top";
    c.task = JointTask::load;
    c.scene.contacts = false;
    const double lean = std::numbers::pi / 6.0, side = 0.2;
    const Vector axis{std::sin(lean), 0.0, std::cos(lean)};
    for (std::size_t i = 0; i <= 10; ++i) {
        Body part = box({side, side, side}, i < 10 ? 1.0 : 100.0, side * (double(i) + 0.5) * axis);
        part.orientation = turn({0.0, 1.0, 0.0}, lean);
        c.scene.bodies.push_back(part);
        c.scene.joints.push_back(fixed_joint(i == 0 ? the_world : i - 1, i, side * double(i) * axis));
    }
    c.seconds = 5.0;
    c.quick_seconds = 0.5;
    c.rates = {60.0, 240.0, 960.0};
    c.quick_rates = {60.0};
    c.look_every = 1.0 / 60.0;
    c.watch = [](const Scene& scene, double) { return std::make_unique<SagWatch>(scene); };
    return c;
}

}  // namespace

void add_loads(std::vector<JointCase>& cases) {
    // J5 and J6. Sag of the lowest joint in m and force at the end in N, of 30 digits.
    const std::vector<double> even(20, 1.0);
    cases.push_back(hanging_case("hanging chain", even, 0.1, 0.02, 1.0, 0.79827310891563972, 100.651790329227215));
    std::vector<double> loaded(21, 1.0);
    loaded[10] = 1000.0;
    cases.push_back(
        hanging_case("bridge, 1000 kg on 1 kg", loaded, 0.5, 0.1, 10.0, 1.56122670906513271, 15881.2055290885987));
    cases.push_back(wrecking_ball(1e3, 5.0, "wrecking ball of 1000 kg"));
    cases.push_back(wrecking_ball(1e6, 1.0, "wrecking ball of 1e6 kg"));
    cases.push_back(leaning_tower());
}

}  // namespace tumble::bench
