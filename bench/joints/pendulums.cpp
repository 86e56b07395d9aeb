// Pendulums and tops against closed forms and integrations of 30 digits; a free chain.
#include "harness/breaking_pendulum.h"
#include "harness/random.h"
#include "harness/shapes.h"
#include "joints/watches.h"

#include <algorithm>
#include <numbers>

namespace tumble::bench {
namespace {

constexpr double degree = std::numbers::pi / 180.0;

// A rod 1 m long, 0.1 m thick, 1 kg, from the given end along the direction (sin a, -cos a) of x and y up.
Body rod(const Vector& end, double angle) {
    const Vector along = up(std::sin(angle), -std::cos(angle), 0.0);
    Body body = box({1.0, 0.1, 0.1}, 1.0, end + 0.5 * along);
    body.orientation = turn({0.0, -1.0, 0.0}, angle - 90.0 * degree);
    return body;
}

Joint hinge(std::size_t first, std::size_t second, const Vector& anchor, const Vector& axis) {
    Joint joint;
    joint.kind = JointKind::hinge;
    joint.first = first;
    joint.second = second;
    joint.anchor = anchor;
    joint.axis = axis;
    return joint;
}

// Angle of a rod from hanging.
double angle_of(const Motion& m) {
    const Vector along = rotate(m.orientation, {1.0, 0.0, 0.0});
    return std::atan2(along.x, -along.z);
}

double wrapped(double angle) { return std::remainder(angle, 2.0 * std::numbers::pi); }

// J1: period 4 K(sin^2(a / 2)) / w0. After 1 1/4 periods the rod hangs.
JointCase pendulum(double start, double period) {
    JointCase c;
    c.name = "pendulum from " + std::to_string(int(start)) + " degrees";
    c.scene.contacts = false;
    c.scene.bodies = {rod({}, start * degree)};
    c.scene.joints = {hinge(the_world, 0, {}, {0.0, 1.0, 0.0})};
    c.seconds = 1.25 * period;
    for (int steps = 64; steps <= 4096; steps *= 2) c.rates.push_back(steps / period);
    c.quick_rates = {64 / period, 512 / period};
    c.watch = watch_end(
        EndError{"rad", [](const Simulator&, const std::vector<Motion>& m) { return std::fabs(angle_of(m[0])); }},
        0.5 * g * (1.0 - std::cos(start * degree)));
    return c;
}

// Looks for the break. Afterwards the angular velocity is constant, and the angle follows at the moment of the break.
class BreakWatch : public Watch {
public:
    explicit BreakWatch(const Scene& scene) : scene_(scene) {}

    void see(double time, const Simulator& simulator, const std::vector<Motion>& m) override {
        if (std::isfinite(error_)) return;
        const std::optional<double> told = simulator.broken_at(0);
        const std::optional<Vector> force = simulator.joint_force(0);
        if (!told && !(time > 0.0 && force && norm(*force) > breaking_pendulum::strength)) {
            gap_ = std::max(gap_, largest_gap(scene_, m));
            return;
        }
        const double at = told.value_or(time), speed = m[0].angular_velocity.y;
        error_ = std::fabs(at - breaking_pendulum::time);
        angle_ = std::fabs(angle_of(m[0]) + speed * (time - at) - breaking_pendulum::angle);
        speed_ = std::fabs(speed - breaking_pendulum::angular_speed);
    }
    std::vector<Quantity> tell() const override {
        return {{"error", error_, "s"},
                {"angle", angle_, "rad"},
                {"angular velocity", speed_, "rad/s"},
                {"gap", gap_, "m"}};
    }

private:
    Scene scene_;
    double error_ = HUGE_VAL, angle_ = HUGE_VAL, speed_ = HUGE_VAL, gap_ = 0.0;
};

// J1c: the hinge breaks. A program without breaking joints tells the force of the hinge.
JointCase breaking() {
    JointCase c;
    c.name = "pendulum that breaks";
    c.scene.contacts = false;
    c.scene.breaks_watched = true;
    c.scene.bodies = {rod({}, 90.0 * degree)};
    c.scene.joints = {hinge(the_world, 0, {}, {0.0, 1.0, 0.0})};
    c.scene.joints[0].break_force = breaking_pendulum::strength;
    c.seconds = 0.5;
    c.rates = {60.0, 120.0, 240.0, 480.0, 960.0, 1920.0, 3840.0};
    c.quick_rates = {60.0, 960.0};
    c.watch = [](const Scene& scene, double) { return std::make_unique<BreakWatch>(scene); };
    return c;
}

// J2: two rods end to end, released from the horizontal.
JointCase double_pendulum(double seconds, double first, double second) {
    JointCase c;
    c.name = "double pendulum, " + std::to_string(int(seconds)) + " s";
    c.scene.contacts = false;
    c.scene.bodies = {rod({}, 90.0 * degree), rod({1.0, 0.0, 0.0}, 90.0 * degree)};
    const Vector y{0.0, 1.0, 0.0};
    c.scene.joints = {hinge(the_world, 0, {}, y), hinge(0, 1, {1.0, 0.0, 0.0}, y)};
    c.seconds = seconds;
    c.rates = {60.0, 120.0, 240.0, 480.0, 960.0, 1920.0, 3840.0};
    c.quick_rates = {60.0, 240.0};
    c.watch = watch_end(EndError{"rad",
                                 [=](const Simulator&, const std::vector<Motion>& m) {
                                     return std::max(std::fabs(wrapped(angle_of(m[0]) - first)),
                                                     std::fabs(wrapped(angle_of(m[1]) - second)));
                                 }},
                        2.0 * g);
    return c;
}

struct Top {
    std::string name;
    double lean;                   // rad from up
    double rate, spin;             // rad/s: angular velocity rate (up - cos lean e) + spin e
    double seconds, end, azimuth;  // the axis after these seconds: rad from up, and rad of turn
};

// J3, J4: a box 0.2 x 0.1 x 0.2 m of 1 kg on a ball joint to the world, on its axis, 0.1 m from its center.
JointCase top(const Top& t) {
    JointCase c;
    c.name = t.name;
    c.scene.contacts = false;
    const Vector z{0.0, 0.0, 1.0}, e{std::sin(t.lean), 0.0, std::cos(t.lean)};
    Body body = box({0.2, 0.2, 0.1}, 1.0, 0.1 * e);
    body.orientation = turn({0.0, 1.0, 0.0}, t.lean);
    body.angular_velocity = t.rate * (z - std::cos(t.lean) * e) + t.spin * e;
    body.velocity = cross(body.angular_velocity, body.position);
    c.scene.bodies = {body};
    Joint ball;
    ball.second = 0;
    c.scene.joints = {ball};
    c.seconds = t.seconds;
    for (int steps = 64; steps <= 4096; steps *= 2) c.rates.push_back(steps / t.seconds);
    c.quick_rates = {128 / t.seconds, 1024 / t.seconds};
    const Vector there{std::sin(t.end) * std::cos(t.azimuth), std::sin(t.end) * std::sin(t.azimuth), std::cos(t.end)};
    c.watch = watch_end(
        EndError{"rad", [=](const Simulator&,
                            const std::vector<Motion>& m) { return norm(rotate(m[0].orientation, z) - there); }},
        0.1 * g);
    return c;
}

// J13: eight boxes on ball joints without gravity, with fitting velocities.
JointCase free_chain() {
    JointCase c;
    c.name = "free chain of 8";
    c.scene.contacts = false;
    c.scene.gravity = 0.0;
    Random random(8);
    Vector velocity{0.1, -0.2, 0.15};
    for (int i = 0; i < 8; ++i) {
        Body body = box({1.0, 0.1, 0.2}, 1.0, {double(i), 0.0, 0.0});
        body.angular_velocity = {0.5 * random.both(), 0.5 * random.both(), 0.5 * random.both()};
        const Vector half = cross(body.angular_velocity, {0.5, 0.0, 0.0});
        body.velocity = velocity + half;
        velocity = body.velocity + half;
        c.scene.bodies.push_back(body);
        if (i == 0) continue;
        Joint ball;
        ball.first = std::size_t(i - 1);
        ball.second = std::size_t(i);
        ball.anchor = {i - 0.5, 0.0, 0.0};
        c.scene.joints.push_back(ball);
    }
    c.seconds = 10.0;
    c.quick_seconds = 1.0;
    c.rates = {30.0, 60.0, 120.0, 240.0, 480.0, 960.0, 1920.0};
    c.quick_rates = {60.0};
    c.watch = watch_momentum();
    return c;
}

}  // namespace

void add_pendulums(std::vector<JointCase>& cases) {
    cases.push_back(pendulum(90.0, 1.9357500144084348));
    cases.push_back(pendulum(170.0, 4.00053715316770717));
    cases.push_back(breaking());
    cases.push_back(double_pendulum(2.0, -0.0845270358378211, 0.3920419302606883));
    cases.push_back(double_pendulum(5.0, 0.8485748006037753, 2.3633801429516465));
    // After two periods of the angle from up it is at its start again, with the azimuth of two periods.
    const double lean = 120.0 * degree, period = 0.405923390506001434;
    cases.push_back(top({"spherical pendulum", lean, 4.0, 0.0, 2.0 * period, lean, 2.0 * 3.65683761240802185}));
    // After two and a half nutations the top leans most.
    cases.push_back(top({"top with cusps", 30.0 * degree, 0.0, 60.0, 2.5 * 0.26316142503658788,
                         36.4057298110046825 * degree, 2.5 * 0.698304010919854458}));
    cases.push_back(free_chain());
}

}  // namespace tumble::bench
