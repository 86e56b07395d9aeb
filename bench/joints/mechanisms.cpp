// Closed loops, one of them over-constrained, and a door with a motor and a limit.
#include "harness/squeezer.h"
#include "joints/joint_shapes.h"

#include <algorithm>
#include <numbers>

namespace tumble::bench {
namespace {

// J9, IFToMM's A02: N + 1 upright cranks and N couplers, thin rods of 1 m and 1 kg; the top of the first has 1 m/s. The
// cranks stay parallel and lie flat twice a turn, where the mechanism is singular. Rods pass each other in four layers.
JointCase four_bars(int loops, double x, double height) {
    JointCase c;
    c.name = "four-bars, " + std::to_string(loops) + " loops";
    c.scene.contacts = false;
    const Vector axis{0.0, -1.0, 0.0};
    // A box with the inertia of a thin rod of 1 m about y.
    const double thick = 0.05, flat = 0.01, layer = 0.012, length = std::sqrt(1.0 - thick * thick);
    for (int i = 0; i <= loops; ++i) {
        Body crank = box({thick, flat, length}, 1.0, up(i, 0.5, layer * (i % 2)));
        crank.velocity = {0.5, 0.0, 0.0};
        crank.angular_velocity = -1.0 * axis;
        c.scene.bodies.push_back(crank);
        c.scene.joints.push_back(hinge_joint(the_world, std::size_t(i), {double(i), 0.0, 0.0}, axis));
    }
    for (int i = 0; i < loops; ++i) {
        Body coupler = box({length, flat, thick}, 1.0, up(i + 0.5, 1.0, layer * (2 + i % 2)));
        coupler.velocity = {1.0, 0.0, 0.0};
        const std::size_t body = c.scene.bodies.size();
        c.scene.bodies.push_back(coupler);
        c.scene.joints.push_back(hinge_joint(std::size_t(i), body, up(i, 1.0, 0.0), axis));
        c.scene.joints.push_back(hinge_joint(std::size_t(i + 1), body, up(i + 1, 1.0, 0.0), axis));
    }
    c.seconds = 10.0;
    c.quick_seconds = 0.1;
    c.rates = {120.0, 240.0, 480.0, 960.0, 1920.0, 3840.0};
    c.quick_rates = {240.0};
    const Scene scene = c.scene;
    const Vector there = up(x, height, 0.0);
    c.watch = watch_end(EndError{"m",
                                 [=](const Simulator&, const std::vector<Motion>& m) {
                                     return norm(moved(scene, 0, m[0], up(0.0, 1.0, 0.0)) - there);
                                 }},
                        g * (loops + 1));
    return c;
}

Vector in_plane(const squeezer::Point& p, double z = 0.0) { return up(p.x, p.y, z); }

class SqueezerWatch : public Watch {
public:
    explicit SqueezerWatch(const Scene& scene) : scene_(scene), last_(scene.bodies.size()) {}

    // The turns of all plates, which are at most half a turn from look to look.
    void see(double time, const Simulator&, const std::vector<Motion>& m) override {
        gap_ = std::max(gap_, largest_gap(scene_, m));
        const Vector x{1.0, 0.0, 0.0}, axis = up(0.0, 0.0, 1.0);
        for (std::size_t i = 0; i < m.size(); ++i) {
            const Vector now = rotate(m[i].orientation, x);
            if (time > 0.0) turned_[i] += angle_about(axis, last_[i], now);
            last_[i] = now;
        }
        const auto hinges = squeezer::hinges();
        error_ = 0.0;
        for (std::size_t k = 0; k < squeezer::ends.size(); ++k) {
            const auto turn_of = [&](int plate) { return plate < 0 ? 0.0 : turned_[std::size_t(plate)]; };
            const double angle = squeezer::starts[k] + turn_of(hinges[k].second) - turn_of(hinges[k].first);
            error_ = std::max(error_, std::fabs(angle - squeezer::ends[k]));
        }
    }
    std::vector<Quantity> tell() const override { return {{"error", error_, "rad"}, {"gap", gap_, "m"}}; }

private:
    Scene scene_;
    std::vector<Vector> last_;  // where a direction of each plate points
    std::array<double, 7> turned_{};
    double error_ = HUGE_VAL, gap_ = 0.0;
};

// J10: harness/squeezer.h.
JointCase squeezing() {
    JointCase c;
    c.name = "Andrews' squeezer";
    c.scene.contacts = false;
    c.scene.gravity = 0.0;
    const Vector axis = up(0.0, 0.0, 1.0);
    for (const squeezer::Plate& plate : squeezer::plates()) {
        const double side = plate.side(), z = squeezer::layer * double(c.scene.bodies.size());
        Body body = box({side, squeezer::thickness, side}, plate.mass, in_plane(plate.center, z));
        body.orientation = turn(axis, plate.angle);
        c.scene.bodies.push_back(body);
    }
    for (const squeezer::Hinge& h : squeezer::hinges())
        c.scene.joints.push_back(hinge_joint(h.first == squeezer::ground ? the_world : std::size_t(h.first),
                                             std::size_t(h.second), in_plane(h.at), axis));
    c.scene.torques = {{0, squeezer::torque * axis}};
    const Body& sprung = c.scene.bodies[squeezer::spring_plate];
    const Vector point = rotate_back(sprung.orientation, in_plane(squeezer::spring_end()) - sprung.position);
    c.scene.springs = {
        {squeezer::spring_plate, in_plane(squeezer::c), point, squeezer::stiffness, squeezer::rest_length}};
    c.seconds = squeezer::duration;
    c.rates = {3000.0, 6000.0, 12000.0, 24000.0, 48000.0, 96000.0};
    c.quick_rates = {12000.0, 48000.0};
    c.watch = [](const Scene& scene, double) { return std::make_unique<SqueezerWatch>(scene); };
    return c;
}

// J11, IFToMM's A04: five boxes along the edges of a cube, six hinges, one more than a spatial loop may have.
JointCase bricard() {
    JointCase c;
    c.name = "Bricard's mechanism";
    c.scene.contacts = false;
    const Vector corners[6] = {up(0, 0, 0), up(1, 0, 0), up(1, -1, 0), up(1, -1, 1), up(0, -1, 1), up(0, 0, 1)};
    const Vector x = up(1, 0, 0), y = up(0, 1, 0), z = up(0, 0, 1), axes[6] = {y, z, x, y, z, x};
    for (std::size_t i = 0; i < 5; ++i) {
        const Vector d = corners[i + 1] - corners[i];
        const auto size = [](double length) { return std::max(0.1, std::fabs(length)); };
        c.scene.bodies.push_back(box({size(d.x), size(d.y), size(d.z)}, 1.0, 0.5 * (corners[i] + corners[i + 1])));
    }
    for (std::size_t i = 0; i < 6; ++i)
        c.scene.joints.push_back(hinge_joint(i == 0 ? the_world : i - 1, i == 5 ? the_world : i, corners[i], axes[i]));
    c.seconds = 2.0;
    c.rates = {60.0, 120.0, 240.0, 480.0, 960.0, 1920.0, 3840.0};
    c.quick_rates = {60.0, 240.0};
    const Scene scene = c.scene;
    const Vector from = corners[3], there = up(-0.9693403447777, -1.2212468949563, 0.7542780107798);
    c.watch = watch_end(
        EndError{"m", [=](const Simulator&,
                          const std::vector<Motion>& m) { return norm(moved(scene, 2, m[2], from) - there); }},
        5.0 * g);
    return c;
}

class DoorWatch : public Watch {
public:
    explicit DoorWatch(const Scene& scene) : scene_(scene) {}

    void see(double time, const Simulator&, const std::vector<Motion>& m) override {
        gap_ = std::max(gap_, largest_gap(scene_, m));
        const Vector x{1.0, 0.0, 0.0};
        const double angle = angle_about({0.0, 0.0, 1.0}, x, rotate(m[0].orientation, x));
        // 10 N m until 1 rad/s, then this speed.
        const double full = inertia / 10.0;
        if (std::fabs(time - 1.5) < 1e-6) error_ = std::fabs(angle - (1.5 - 0.5 * full));
        beyond_ = std::max(beyond_, angle - limit);
        end_ = std::fabs(angle - limit);
    }
    std::vector<Quantity> tell() const override {
        return {{"error", error_, "rad"},
                {"beyond the limit", beyond_, "rad"},
                {"off the limit at the end", end_, "rad"},
                {"gap", gap_, "m"}};
    }

    static constexpr double limit = 0.5 * std::numbers::pi;
    static constexpr double inertia = 20.0 * ((0.9 * 0.9 + 0.04 * 0.04) / 12.0 + 0.45 * 0.45);  // kg m^2

private:
    Scene scene_;
    double error_ = HUGE_VAL, beyond_ = 0.0, end_ = HUGE_VAL, gap_ = 0.0;
};

// J18: a door of 20 kg on a vertical hinge, turned at 1 rad/s with at most 10 N m, up to a limit at 90 degrees.
JointCase door() {
    JointCase c;
    c.name = "door with motor and limit";
    c.scene.contacts = false;
    c.scene.bodies = {box({0.9, 0.04, 2.0}, 20.0, {0.45, 0.0, 0.0})};
    Joint joint = hinge_joint(the_world, 0, {}, {0.0, 0.0, 1.0});
    joint.speed = 1.0;
    joint.strength = 10.0;
    joint.limits = {-0.1, DoorWatch::limit};
    c.scene.joints = {joint};
    c.seconds = 4.0;
    c.rates = {60.0, 240.0, 960.0, 3840.0};
    c.quick_rates = {60.0};
    c.watch = [](const Scene& scene, double) { return std::make_unique<DoorWatch>(scene); };
    return c;
}

}  // namespace

void add_mechanisms(std::vector<JointCase>& cases) {
    cases.push_back(four_bars(2, 0.328458111540815379, 0.944538518178600962));
    cases.push_back(four_bars(40, 0.18051222668672839, 0.983572740582311575));
    cases.push_back(squeezing());
    cases.push_back(bricard());
    cases.push_back(door());
}

}  // namespace tumble::bench
