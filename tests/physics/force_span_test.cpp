// Forces over spans of time: for any span, step and impact mode, the impulse is the force times the span.
#include "support/scenes.h"

#include <gtest/gtest.h>

#include <array>

namespace tumble::force_span_test {
using namespace tumble::testing;

namespace {

struct Mode {
    const char* name;
    IntegratorKind integrator;
    ImpactMode impacts;
    int steps_per_frame;
};

std::vector<Mode> modes() {
    std::vector<Mode> list;
    for (const auto& [name, kind] :
         {std::pair("explicit-euler", IntegratorKind::explicit_euler),
          std::pair("symplectic-euler", IntegratorKind::symplectic_euler),
          std::pair("splitting", IntegratorKind::splitting), std::pair("rk4", IntegratorKind::runge_kutta_4),
          std::pair("exact", IntegratorKind::exact)})
        for (const ImpactMode impacts : {ImpactMode::stepped, ImpactMode::exact})
            for (const int steps : {1, 4, 16}) list.push_back({name, kind, impacts, steps});
    return list;
}

std::string text(const Mode& mode) {
    return std::string(mode.name) + (mode.impacts == ImpactMode::exact ? ", exact impacts, " : ", ") +
           std::to_string(mode.steps_per_frame) + " steps";
}

void set(SceneDescription& scene, const Mode& mode) {
    scene.simulation.integrator = mode.integrator;
    scene.simulation.impacts = mode.impacts;
    scene.simulation.steps_per_frame = mode.steps_per_frame;
}

ForceDescription& push(SceneDescription& scene, std::size_t body, const Vec3& force, double start, double span) {
    ForceDescription f;
    f.body = body;
    f.force = force;
    f.start = start;
    f.end = start + span;
    return scene.forces.emplace_back(f);
}

// Within one step, across a boundary, whole steps, many steps, longer than a frame; first and second: start and span,
// s.
constexpr std::array<std::pair<double, double>, 8> spans = {{{0.0101, 4e-4},
                                                             {0.0166, 4e-4},
                                                             {0.0, 4e-4},
                                                             {1.0 / 60.0, 4e-4},
                                                             {0.0301, 5e-3},
                                                             {0.05, 0.05},
                                                             {0.0333, 0.1234},
                                                             {0.07, 1e-9}}};

constexpr double mass = 2.0, impulse = 2.0;  // kg, N s

void expect_velocity(const World& world, std::size_t body, const Vec3& v, double allowed, const std::string& what) {
    EXPECT_LT((world.snapshot().bodies[body].velocity - v).norm(), allowed) << what;
}

}  // namespace

TEST(ForceSpan, GivesItsImpulseInFlight) {
    for (const Mode& mode : modes())
        for (const auto& [start, span] : spans) {
            SceneDescription scene = empty_scene();
            set(scene, mode);
            add_box(scene, {1.0, 0.6, 0.2}, {0.0, 0.0, 0.0}, mass).angular_velocity = Vec3(1.0, 2.0, 3.0);
            push(scene, 0, Vec3(0.6, 0.8, 0.0) * impulse / span, start, span);
            World world(scene);
            run(world, scene, 0.2);
            const double rounding = 1e-13 + 1e-17 / span;  // of the ends of the span
            expect_velocity(world, 0, Vec3(0.6, 0.8, 0.0), rounding, text(mode) + " " + std::to_string(start));
        }
}

TEST(ForceSpan, GivesItsImpulseOnAFloor) {
    for (const Mode& mode : modes())
        for (const auto& [start, span] : spans) {
            SceneDescription scene = ground_scene(0.0, 0.0);
            set(scene, mode);
            add_box(scene, {1.0, 1.0, 1.0}, {0.0, 0.5, 0.0}, mass);
            push(scene, 1, Vec3(impulse / span, 0.0, 0.0), start, span);
            World world(scene);
            run(world, scene, 0.2);
            EXPECT_NEAR(world.snapshot().bodies[1].velocity.x(), 1.0, 1e-12 + 1e-17 / span)
                << text(mode) << " " << start;
        }
}

// Against friction: v = J/m - mu g t, at any step. Between the force and the step's end lies less than a step.
TEST(ForceSpan, GivesItsImpulseAgainstFriction) {
    for (const Mode& mode : modes()) {
        SceneDescription scene = ground_scene(0.0, 0.1);
        set(scene, mode);
        add_box(scene, {1.0, 0.2, 1.0}, {0.0, 0.1, 0.0}, mass).friction = 0.1;
        push(scene, 1, Vec3(2.0 * impulse / 4e-4, 0.0, 0.0), 0.0123, 4e-4).point = Vec3(0.0, -0.1, 0.0);
        World world(scene);
        run(world, scene, 0.2);
        EXPECT_NEAR(world.snapshot().bodies[1].velocity.x(), 2.0 - 0.1 * 9.81 * (0.2 - 0.0123),
                    0.1 * 9.81 * scene.step() + 1e-3)
            << text(mode);
    }
}

// A brief force within one step wakes a sleeping stack.
TEST(ForceSpan, WakesASleeper) {
    for (const Mode& mode : modes()) {
        SceneDescription scene = ground_scene(0.0, 0.0);
        set(scene, mode);
        for (const double y : {0.5, 1.5}) add_box(scene, {1.0, 1.0, 1.0}, {0.0, y, 0.0}, mass);
        push(scene, 2, Vec3(impulse / 4e-4, 0.0, 0.0), 2.0011, 4e-4);
        World world(scene);
        run(world, scene, 2.0);
        EXPECT_TRUE(world.snapshot().bodies[2].velocity.isZero(0.0)) << text(mode);
        run(world, scene, 0.1);
        EXPECT_NEAR(world.snapshot().bodies[2].velocity.x(), 1.0, 1e-9) << text(mode);
    }
}

// Several that overlap, one without end, in one step and in others.
TEST(ForceSpan, SeveralAddUp) {
    for (const Mode& mode : modes()) {
        SceneDescription scene = empty_scene();
        set(scene, mode);
        add_sphere(scene, 0.3, Vec3::Zero(), mass);
        push(scene, 0, Vec3(1000.0, 0.0, 0.0), 0.0011, 3e-4);
        push(scene, 0, Vec3(0.0, 500.0, 0.0), 0.0012, 0.0321);
        push(scene, 0, Vec3(0.0, 0.0, -70.0), 0.0200, 0.0007);
        push(scene, 0, Vec3(0.0, 0.0, 3.0), 0.0301, 0.0).end = std::numeric_limits<double>::infinity();
        World world(scene);
        run(world, scene, 0.1);
        const Vec3 total(0.3, 500.0 * 0.0321, -0.049 + 3.0 * (0.1 - 0.0301));
        expect_velocity(world, 0, total / mass, 1e-12, text(mode));
    }
}

// At a point of a spinning body: the force's moment is that of the point's place at its time; so is a force that
// rotates with it. By 1/3 rad in a step of a frame: evaluated at the step's start both would be off by a quarter.
TEST(ForceSpan, ActsAtThePlaceOfItsTime) {
    for (const Mode& mode : modes()) {
        // its rotations are tangents: 1/80 rad per step too little
        if (mode.integrator == IntegratorKind::explicit_euler) continue;
        const double spin = 20.0, start = 0.0141, span = 4e-4, middle = start + 0.5 * span;
        for (const bool turns : {false, true}) {
            SceneDescription scene = empty_scene();
            set(scene, mode);
            add_sphere(scene, 0.5, Vec3::Zero(), mass).angular_velocity = Vec3(0.0, 0.0, spin);
            ForceDescription& f = push(scene, 0, Vec3(0.5 * impulse / span, 0.0, 0.0), start, span);
            f.body_frame = turns;
            f.point = turns ? Vec3(0.0, 0.0, 0.4) : Vec3(0.4, 0.0, 0.0);
            World world(scene);
            const Vec3 before = world.measure().angular_momentum;
            run(world, scene, 1.0 / 60.0);
            const double c = std::cos(spin * middle), s = std::sin(spin * middle), j = 0.5 * impulse;
            const Vec3 force = turns ? Vec3(c, s, 0.0) * j : Vec3(j, 0.0, 0.0);
            const Vec3 arm = turns ? Vec3(0.0, 0.0, 0.4) : Vec3(0.4 * c, 0.4 * s, 0.0);
            const Measurement after = world.measure();
            // About the center of mass; the rotation during the span itself, 8e-3 rad plus the force's contribution, is
            // of second order.
            const Vec3 at = world.snapshot().bodies[0].center_of_mass;
            const Vec3 spin_change = after.angular_momentum - at.cross(after.momentum) - before;
            EXPECT_LT((after.momentum - force).norm(), 3e-4) << text(mode) << turns;
            EXPECT_LT((spin_change - arm.cross(force)).norm(), 1e-3) << text(mode) << turns;
        }
    }
}

// A fast bouncing ball is clamped in the steps of its bounces. A force along the frictionless floor continues
// meanwhile.
TEST(ForceSpan, GivesItsImpulseAcrossBounces) {
    for (const Mode& mode : modes()) {
        SceneDescription scene = ground_scene(0.8, 0.0);
        set(scene, mode);
        BodyDescription& ball = add_sphere(scene, 0.1, {0.0, 0.3, 0.0}, mass);
        ball.velocity = Vec3(0.0, -12.0, 0.0);
        ball.restitution = 0.8;
        push(scene, 1, Vec3(impulse / 0.5, 0.0, 0.0), 0.0011, 0.5);
        push(scene, 1, Vec3(0.0, 0.0, impulse / 4e-3), 0.0151, 4e-3);  // in the steps of the first bounce
        World world(scene);
        run(world, scene, 3.0);
        const Vec3 v = world.snapshot().bodies[1].velocity;
        EXPECT_NEAR(v.x(), 1.0, 1e-9) << text(mode);
        EXPECT_NEAR(v.z(), 1.0, 1e-9) << text(mode);
    }
}

// Upward in the step of the bounce: the bounce does not cancel it. 1 m/s more than without.
TEST(ForceSpan, ABounceDoesNotCancelIt) {
    for (const Mode& mode : modes()) {
        double speeds[2];
        for (const bool pushed : {false, true}) {
            SceneDescription scene = ground_scene(1.0, 0.0);
            set(scene, mode);
            BodyDescription& ball = add_sphere(scene, 0.5, {0.0, 0.5, 0.0}, mass);
            ball.velocity = Vec3(0.0, -3.0, 0.0);
            ball.restitution = 1.0;
            push(scene, 1, Vec3(0.0, pushed ? impulse / 4e-4 : 0.0, 0.0), 3e-4, 4e-4);
            World world(scene);
            run(world, scene, 0.1);
            speeds[pushed] = world.snapshot().bodies[1].velocity.y();
        }
        EXPECT_NEAR(speeds[1] - speeds[0], 1.0, 1e-9) << text(mode);
    }
}

// Hit in the step of its force, before it and after it: the two together have the whole impulse.
TEST(ForceSpan, GivesItsImpulseToABodyThatIsHitInTheStep) {
    for (const Mode& mode : modes())
        for (const double start : {0.0021, 0.0061, 0.0114}) {
            SceneDescription scene = empty_scene();
            set(scene, mode);
            add_box(scene, {1.0, 1.0, 1.0}, Vec3::Zero(), mass).restitution = 0.7;
            BodyDescription& ball = add_sphere(scene, 0.2, {-0.72, 0.1, 0.0}, 1.0);
            ball.velocity = Vec3(2.0, 0.3, 0.0);  // arrives after 10 ms
            ball.restitution = 0.7;
            push(scene, 0, Vec3(0.0, impulse / 4e-4, 0.5 * impulse / 4e-4), start, 4e-4);
            push(scene, 0, Vec3(0.0, 0.0, 1.0), 0.0, 0.1);
            World world(scene);
            run(world, scene, 0.2);
            const Vec3 momentum = world.measure().momentum;
            EXPECT_LT((momentum - Vec3(2.0, 0.3 + impulse, 0.5 * impulse + 0.1)).norm(), 1e-11)
                << text(mode) << " " << start;
        }
}

// A box on a frictionless floor is hit from below and released in the step of a push: the push acts once.
TEST(ForceSpan, ActsOnceOnABodyThatIsReleasedInTheStep) {
    for (const Mode& mode : modes())
        for (const double start : {0.1021, 0.1114}) {
            SceneDescription scene = ground_scene(0.0, 0.0);
            set(scene, mode);
            BodyDescription& shelf = add_box(scene, {4.0, 0.2, 0.5}, {0.0, 1.0, 0.0});
            shelf.type = BodyType::fixed;
            shelf.friction = 0.0;
            BodyDescription& plank = add_box(scene, {0.5, 0.2, 3.0}, {0.0, 1.2, 0.0}, mass);
            plank.friction = 0.0;
            for (const double z : {-1.0, 1.0}) {  // both ends at once, after 105 ms
                BodyDescription& ball = add_sphere(scene, 0.1, {0.0, 1.0 - 0.5, z}, 1.0);
                ball.velocity = Vec3(0.0, (0.5 + 0.5 * 9.81 * 0.105 * 0.105) / 0.105, 0.0);
                ball.restitution = 1.0;
                ball.friction = 0.0;
            }
            push(scene, 2, Vec3(impulse / 4e-4, 0.0, 0.0), start, 4e-4);
            push(scene, 2, Vec3(1.0, 0.0, 0.0), 0.0, 0.25);
            World world(scene);
            run(world, scene, 0.3);
            EXPECT_GT(world.snapshot().bodies[2].velocity.y(), 0.0);
            EXPECT_NEAR(world.snapshot().bodies[2].velocity.x() * mass, impulse + 0.25, 1e-9)
                << text(mode) << " " << start;
        }
}

// The method of the notes evaluates the force at the start of each step and holds it through the step.
TEST(ForceSpan, WithTheNotesItActsThroughWholeSteps) {
    for (const auto& [start, expected] : {std::pair(0.05, 3.0), std::pair(0.055, 0.0)}) {
        SceneDescription scene = empty_scene(1);
        scene.output.fps = 100.0;
        scene.simulation.method = SimulationMethod::notes;
        add_sphere(scene, 0.3, Vec3::Zero(), mass);
        const double span = scene.step() / 3.0;
        push(scene, 0, Vec3(impulse / span, 0.0, 0.0), start, span);
        World world(scene);
        run(world, scene, 0.2);
        EXPECT_NEAR(world.snapshot().bodies[0].velocity.x(), expected * impulse / mass, 1e-12) << start;
    }
}

}  // namespace tumble::force_span_test
