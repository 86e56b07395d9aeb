#include "scenes.h"

#include <gtest/gtest.h>

#include <xmmintrin.h>

#include <cfenv>
#include <utility>

namespace tumble {
namespace {

TEST(World, AFrameIsItsSteps) {
    const Scene scene(crate_and_ball());
    World by_frames(scene), by_steps(scene);
    for (int frame = 0; frame < 10; ++frame) {
        by_frames.advance_frame();
        for (int step = 0; step < scene.steps_per_frame(); ++step) by_steps.advance_step();
        ASSERT_TRUE(same(by_frames.snapshot(), by_steps.snapshot())) << frame;
    }
    EXPECT_EQ(by_steps.snapshot().frame, 10);
    by_steps.advance_step();
    EXPECT_EQ(by_steps.snapshot().frame, 10);
    EXPECT_NEAR(by_steps.snapshot().time, 1.0 + scene.step(), 1e-15);
}

TEST(World, RecordsImpactsAndContactsWithoutChangingTheMotion) {
    const Scene scene(crate_and_ball());
    World plain(scene), recording(scene);
    EXPECT_THROW(recording.contacts(), Error);
    recording.record_contacts();
    std::size_t impacts = 0;
    double vertical = 0.0;  // N s on all dynamic bodies
    double mass = 0.0;
    for (std::size_t i = 0; i < scene.body_count(); ++i)
        if (scene.body_type(i) == BodyType::dynamic) mass += recording.properties(i).mass;
    const int frames = 60;
    const double duration = 1.0 / scene.output().fps;
    for (int frame = 1; frame <= frames; ++frame) {
        plain.advance_frame();
        recording.advance_frame();
        ASSERT_TRUE(same(plain.snapshot(), recording.snapshot())) << frame;
        const FrameContacts found = recording.contacts();
        impacts += found.impacts.size();
        for (const Impact& i : found.impacts)
            if (scene.body_type(i.a) == BodyType::fixed) vertical += i.impulse * i.normal.y + i.friction.y;
        double load = 0.0;
        for (const ExternalLoad& l : found.loads) load += l.force.y;
        ASSERT_NEAR(load, -9.81 * mass, 1e-9 * mass) << frame;
        for (const Contact& c : found.contacts)
            if (c.a == Contact::nobody || scene.body_type(c.a) == BodyType::fixed)
                vertical += duration * (c.normal_force * c.normal.y + c.tangential_force.y);
    }
    EXPECT_GT(impacts, 0u);
    const Energies energies = recording.energies();
    EXPECT_GT(energies.impact_loss, 0.0);
    EXPECT_NEAR(energies.kinetic_linear + energies.kinetic_angular, energies.kinetic, 1e-9);
    const double gravity = 9.81 * mass * frames * duration;
    EXPECT_NEAR(vertical, gravity + energies.momentum.y - World(scene).energies().momentum.y, 1e-9 * gravity);
}

TEST(World, SeveralAreIndependentAndAnyNumberOfThreadsGivesTheSameBytes) {
    const Scene scene(crate_and_ball());
    World first(scene), second(scene, 3);
    for (int i = 0; i < 5; ++i) first.advance_frame();
    World moved = std::move(first);
    for (int i = 0; i < 8; ++i) second.advance_frame();
    for (int i = 0; i < 3; ++i) moved.advance_frame();
    EXPECT_TRUE(same(moved.snapshot(), second.snapshot()));
}

TEST(World, EnergyOfFreeFallIsConserved) {
    SceneSpec spec;
    spec.simulation.integrator = Integrator::exact;
    Body& ball = spec.add(Sphere{0.5});
    ball.mass = 2.0;
    ball.position = {0.0, 10.0, 0.0};
    World world{Scene(spec)};
    const Energies start = world.energies();
    EXPECT_DOUBLE_EQ(start.kinetic, 0.0);
    EXPECT_DOUBLE_EQ(start.potential, 2.0 * 9.81 * 10.0);
    for (int i = 0; i < 60; ++i) world.advance_frame();
    const Energies end = world.energies();
    EXPECT_NEAR(end.kinetic + end.potential, start.potential, 1e-9);
    EXPECT_NEAR(end.momentum.y, -2.0 * 9.81, 1e-9);
    EXPECT_EQ(end.contacts, 0);
}

TEST(World, KnowsMassAndInertia) {
    SceneSpec spec = crate_and_ball();
    spec.bodies[1].mass = 6.0;
    const World world{Scene(spec)};
    EXPECT_DOUBLE_EQ(world.properties(1).mass, 6.0);
    EXPECT_NEAR(world.properties(1).inertia.x, 1.0, 1e-12);  // m (b^2 + c^2) / 12
    EXPECT_EQ(world.properties(0).mass, std::numeric_limits<double>::infinity());
}

// A program that is built with -ffast-math starts with denormal numbers switched off.
TEST(World, FloatingPointModeOfTheCallerDoesNotMatterAndStays) {
    const Scene scene(crate_and_ball());
    const Snapshot usual = after(scene, 15, 2);
    const unsigned mode = _mm_getcsr();
    constexpr unsigned flush_to_zero = 0x8000, denormals_are_zero = 0x40;
    std::fesetround(FE_UPWARD);
    _mm_setcsr(_mm_getcsr() | flush_to_zero | denormals_are_zero);
    const unsigned other = _mm_getcsr() & 0xffc0;
    const Snapshot unusual = after(Scene(crate_and_ball()), 15, 2);
    const unsigned left = _mm_getcsr() & 0xffc0;
    _mm_setcsr(mode);
    std::fesetround(FE_TONEAREST);
    EXPECT_TRUE(same(usual, unusual));
    EXPECT_EQ(left, other);
}

}  // namespace
}  // namespace tumble
