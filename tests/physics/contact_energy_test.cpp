// Contact removes energy and never adds any: heaps of boxes, balls and hulls, checked after every step.
#include "sim/random_shapes.h"
#include "support/meshes.h"
#include "support/scenes.h"

#include <gtest/gtest.h>

namespace tumble::contact_energy_test {
using namespace tumble::testing;

namespace {

double energy(const World& world) {
    const Measurement m = world.measure();
    return m.kinetic + m.potential;
}

enum class Kind { boxes, spheres, hulls, mixed };

SceneDescription heap(Kind kind, int count, double friction, double restitution, int steps, std::uint64_t seed) {
    SceneDescription scene = ground_scene(restitution, friction, steps);
    scene.simulation.sleep = false;
    for (int side = 0; side < 4; ++side) {
        const Vec3 in(side == 0 ? 1 : side == 1 ? -1 : 0, 0, side == 2 ? 1 : side == 3 ? -1 : 0);
        add_body(scene, PlaneShape{in, -2.6}, Vec3::Zero()).type = BodyType::fixed;
    }
    Random random(seed);
    const auto gem = icosahedron(0.4);
    for (int i = 0; i < count; ++i) {
        const Vec3 at((i % 3 - 1) * 1.7 + random(-0.1, 0.1), 0.8 + 1.7 * (i / 9),
                      (i / 3 % 3 - 1) * 1.7 + random(-0.1, 0.1));
        const int shape = kind == Kind::mixed ? i % 3 : int(kind);
        BodyDescription& body = shape == 0
                                    ? add_box(scene, Vec3(random(0.4, 0.9), random(0.4, 0.9), random(0.4, 0.9)), at)
                                : shape == 1 ? add_sphere(scene, random(0.2, 0.5), at)
                                             : add_body(scene, MeshShape{gem}, at);
        body.mass = random(0.5, 3.0);
        body.rotation = random.turn();
    }
    for (BodyDescription& body : scene.bodies) {
        body.friction = friction;
        body.restitution = restitution;
    }
    return scene;
}

const char* name(Kind k) {
    return k == Kind::boxes ? "boxes" : k == Kind::spheres ? "spheres" : k == Kind::hulls ? "hulls" : "mixed";
}

struct Look {
    double energy, overlap, speed;
};

Look look(const World& world) {
    const Measurement m = world.measure();
    Look l{m.kinetic + m.potential, m.max_penetration, 0.0};
    for (const BodyState& b : world.snapshot().bodies) l.speed = std::max(l.speed, b.velocity.norm());
    return l;
}

/// The largest gain of energy in a step, over the heap's weight (m): beyond the lift possible by removing overlaps and
/// by motion in the step, the deepest overlap plus h times the fastest speed (1).
struct Gain {
    double height = 0.0, share = 0.0;
};

Gain watch(const SceneDescription& scene, double seconds) {
    World world(scene);
    double weight = 0.0;
    for (const BodyDescription& b : scene.bodies)
        if (b.type == BodyType::dynamic) weight += *b.mass * 9.81;
    Gain gain;
    Look before = look(world);
    const double start = before.energy;
    const int steps = int(std::lround(seconds / scene.step()));
    for (int k = 0; k < steps; ++k) {
        world.step();
        const Look now = look(world);
        const double height = (now.energy - before.energy) / weight;
        gain.height = std::max(gain.height, height);
        gain.share = std::max(gain.share, (height - 1e-9) / (before.overlap + before.speed * scene.step() + 1e-9));
        EXPECT_LE(now.energy, start * (1.0 + 1e-9));
        before = now;
    }
    return gain;
}

}  // namespace

// Few bodies, inelastic: solved directly or nearly so, and energy falls at every step, up to a micrometer of height
// (measured: 2e-7 m at 1/60 s).
TEST(ContactEnergy, NeverGrowsInSmallInelasticHeaps) {
    for (const Kind kind : {Kind::boxes, Kind::spheres, Kind::hulls, Kind::mixed})
        for (const double friction : {0.0, 0.5})
            for (const int steps : {1, 8})
                EXPECT_LE(watch(heap(kind, 9, friction, 0.0, steps, 7), 1.5).height, 1e-6)
                    << name(kind) << " " << friction << " " << steps;
}

// Soft contact and bounces may gain in a step the lift of a remaining overlap, or the energy that gravity would have
// taken from a bounce; over some steps all of it is lost again.
TEST(ContactEnergy, GainsNoMoreThanPushOutAndTheFallOfAStep) {
    for (const Kind kind : {Kind::boxes, Kind::spheres, Kind::hulls, Kind::mixed})
        for (const double friction : {0.0, 0.5})
            for (const double restitution : {0.0, 0.3, 0.8})
                EXPECT_LE(watch(heap(kind, 36, friction, restitution, 4, 7), 1.5).share, 1.0)
                    << name(kind) << " " << friction << " " << restitution;
}

// One step per frame. Landing and bouncing bodies in heaps gain up to 0.4 % of the energy in a step without the energy
// budget (energy_budget.h). The remaining gain is the lift of resting bodies out of overlaps.
TEST(ContactEnergy, HeapsAtOneStepPerFrameGainNothing) {
    for (const Kind kind : {Kind::boxes, Kind::spheres, Kind::hulls, Kind::mixed})
        for (const double friction : {0.0, 0.5})
            for (const double restitution : {0.0, 0.3}) {
                World world(heap(kind, 40, friction, restitution, 1, 2));
                const double start = energy(world);
                double before = start;
                for (int k = 0; k < 150; ++k) {
                    world.step();
                    const double now = energy(world);
                    EXPECT_LE(now, before + 2e-4 * start)
                        << name(kind) << " " << friction << " " << restitution << " " << k;
                    before = now;
                }
            }
}

// At 8 m/s and one step per frame bodies land as deep in each other as a heap may start. Without the budget, wedged
// pairs are thrown apart with up to 1.5 % of the scene's energy. The remaining gain is lift without speed (measured:
// 1.2e-4).
TEST(ContactEnergy, DeepLandingsThrowNoBody) {
    for (const Kind kind : {Kind::boxes, Kind::mixed})
        for (const double friction : {0.0, 0.5})
            for (std::uint64_t seed = 11; seed <= 23; ++seed) {
                World world(heap(kind, 40, friction, 0.3, 1, seed));
                const double start = energy(world);
                double before = start;
                for (int k = 0; k < 80; ++k) {
                    world.step();
                    const double now = energy(world);
                    EXPECT_LE(now, before + 3e-4 * start) << name(kind) << " " << friction << " " << seed << " " << k;
                    before = now;
                }
            }
}

// The energy that a settling heap loses for removing its overlaps must not be taken from a body that slides on it.
TEST(ContactEnergy, APuckSlidesOnWhileTheHeapSettles) {
    for (const int steps : {1, 4}) {
        SceneDescription scene = ground_scene(0.0, 0.5, steps);
        scene.simulation.contact_solver = ContactSolverChoice::soft;
        scene.simulation.sleep = false;
        for (int i = 0; i < 36; ++i) add_box(scene, {0.8, 0.8, 0.8}, {i % 6 - 2.5, 0.41, i / 6 - 2.5}, 1000.0);
        add_box(scene, {12.0, 0.5, 6.0}, {0.0, 1.1, 0.0}, 5000.0);
        for (BodyDescription& body : scene.bodies) body.friction = 0.5;
        BodyDescription& puck = add_box(scene, {0.2, 0.1, 0.2}, {-3.0, 1.42, 0.0}, 0.001);
        puck.friction = 0.0;
        puck.velocity = {1.0, 0.0, 0.0};
        World world(scene);
        run(world, scene, 5.0);
        EXPECT_NEAR(world.snapshot().bodies.back().velocity.x(), 1.0, 1e-3) << steps;
        EXPECT_NEAR(world.snapshot().bodies.back().center_of_mass.x(), 2.0, 0.01) << steps;
    }
}

// From second to second the energy only falls, and in the end the heap has come to rest, with two exceptions by then: a
// box that hangs between two corners in line with its center rotates about them for seconds, because point contacts do
// not brake it; and two that lean on each other near the angle of friction slip by millimeters per second for 20 s.
TEST(ContactEnergy, HeapsComeToRest) {
    for (const double restitution : {0.0, 0.5}) {
        const SceneDescription scene = heap(Kind::boxes, 27, 0.5, restitution, 2, 3);
        World world(scene);
        double before = energy(world);
        for (int second = 0; second < 30; ++second) {
            run(world, scene, 1.0);
            const double now = energy(world);
            EXPECT_LE(now, before * (1.0 + 1e-5)) << restitution << " " << second;
            before = now;
        }
        EXPECT_LE(world.measure().kinetic, 1e-6) << restitution;
        EXPECT_LE(world.measure().max_penetration, 1e-3) << restitution;
    }
}

// Heaps at risk of rocking without end: a reduced point sinks and replaces another, which sinks next; heavy boxes whirl
// on light ones and stiffly on the floor; a heap alternates between the solvers.
TEST(ContactEnergy, NoHeapRocksWithoutEnd) {
    struct Case {
        double restitution;
        int steps;
        std::uint64_t seed;
    };
    for (const Case& c :
         {Case{0.0, 1, 1}, Case{0.0, 1, 27}, Case{0.5, 1, 10}, Case{0.0, 2, 5}, Case{0.0, 2, 8}, Case{0.0, 2, 46},
          Case{0.5, 2, 1}, Case{0.5, 2, 18}, Case{0.0, 4, 3}, Case{0.0, 4, 27}, Case{0.5, 4, 11}, Case{0.5, 4, 47}}) {
        const SceneDescription scene = heap(Kind::boxes, 27, 0.5, c.restitution, c.steps, c.seed);
        World world(scene);
        run(world, scene, 8.0);
        EXPECT_LE(world.measure().kinetic, 1e-6) << c.restitution << " " << c.steps << " " << c.seed;
    }
}

// Thin bodies at one step per frame. Bodies held at their contacts must neither stay approaching without end (a
// manifold along a face has a gap where edges meet) nor gain the speed of a fall that they do not make.
TEST(ContactEnergy, DominoesAtOneStepPerFrameGainNothing) {
    SceneDescription scene = ground_scene(0.0, 0.6, 1);
    scene.simulation.sleep = false;
    for (int i = 0; i < 12; ++i) {
        BodyDescription& domino = add_box(scene, Vec3(0.1, 1.0, 0.5), {0.5 * i, 0.5, 0.0});
        domino.friction = 0.4;
        domino.restitution = 0.5;
        if (i == 0) domino.rotation = turn(Vec3::UnitZ(), -0.21);
    }
    World world(scene);
    const double start = energy(world);
    double least = start;
    for (int frame = 0; frame < 360; ++frame) {
        world.advance_frame();
        const double now = energy(world);
        ASSERT_LE(now, least + 0.01 * start) << frame;
        least = std::min(least, now);
    }
    EXPECT_LE(least, 0.5 * start);  // all have fallen
}

// Smooth planks that tumble far in a step: rotation along one tangent would add spin, and impacts would turn it into
// speed.
TEST(ContactEnergy, FastTumblingPlanksGainNothing) {
    Random random(5);
    SceneDescription scene = heap(Kind::boxes, 6, 0.0, 0.9, 1, 5);
    for (BodyDescription& body : scene.bodies) {
        if (body.type != BodyType::dynamic) continue;
        body.shape = BoxShape{{1.2, 0.08, 0.3}};
        body.position.y() += 1.0;
        body.angular_velocity = random.vector(10.0);
    }
    World world(scene);
    const double start = energy(world);
    for (int frame = 0; frame < 240; ++frame) {
        world.advance_frame();
        ASSERT_LE(energy(world), 2.0 * start) << frame;
    }
}

// A heap whose bodies bounce among others: a bounce is restored against gravity, not against the next body that it
// meets.
TEST(ContactEnergy, BouncesInAHeapPushNoBodyAlong) {
    for (const double friction : {0.0, 0.5})
        for (const std::uint64_t seed : {1, 2, 3}) {
            SceneDescription scene = heap(Kind::boxes, 12, friction, 0.5, 16, seed);
            scene.simulation.integrator = IntegratorKind::exact;
            World world(scene);
            const double start = energy(world);
            double before = start;
            for (int step = 0; step < 2 * 960; ++step) {
                world.step();
                const double now = energy(world);
                ASSERT_LE(now, before + 2e-4 * start) << friction << " " << seed << " " << step;
                before = now;
            }
        }
}

// A spinning box that hits a rough floor obliquely converts spin into speed and back, and gains no energy: it would if
// restitution and friction acted one after the other (Kane and Levinson 1985). In flight it moves exactly.
TEST(ContactEnergy, RoughBouncesGainNothing) {
    Random random(31);
    for (int trial = 0; trial < 60; ++trial) {
        SceneDescription scene = ground_scene(random(0.3, 0.9), random(0.3, 1.0), 4);
        scene.simulation.integrator = IntegratorKind::exact;
        BodyDescription& box =
            add_box(scene, Vec3(random(0.3, 0.9), random(0.3, 0.9), random(0.3, 0.9)), {0.0, 1.2, 0.0});
        box.rotation = random.turn();
        box.velocity = Vec3(random(-5.0, 5.0), random(-6.0, -2.0), random(-5.0, 5.0));
        box.angular_velocity = random.vector(6.0);
        box.restitution = scene.bodies[0].restitution;
        box.friction = scene.bodies[0].friction;
        World world(scene);
        const double start = energy(world);
        double before = start;
        for (int step = 0; step < 240; ++step) {
            world.step();
            const double now = energy(world);
            EXPECT_LE(now, before + 1e-3 * start)
                << trial << " " << step;  // lift by removing an overlap of one millimeter
            before = now;
        }
    }
}

// A rebound slower than gravity's change of speed in a step is no bounce: the body lands at the surface, and needs no
// lift out of the floor. (Left to overlap for its bounce it would gain 2e-3 of the energy in a step, 0.01 until it lies
// on top.)
TEST(ContactEnergy, ABodyThatHardlyBouncesLandsAtTheSurface) {
    Random random(8);
    for (int trial = 0; trial < 40; ++trial) {
        SceneDescription scene = ground_scene(0.0, 0.5, 1);
        BodyDescription& body = trial % 2 ? add_box(scene, {0.4, 0.3, 0.5}, {0.0, random(0.5, 1.5), 0.0})
                                          : add_sphere(scene, 0.2, {0.0, random(0.5, 1.5), 0.0});
        body.restitution = 0.02;
        body.friction = 0.5;
        body.velocity = {random(-2.0, 2.0), 0.0, 0.0};
        World world(scene);
        const double start = energy(world);
        double before = start;
        for (int step = 0; step < 90; ++step) {
            world.step();
            const double now = energy(world);
            EXPECT_LE(now, before + 1e-9 * start) << trial << ' ' << step;
            before = now;
        }
    }
}

// A needle that falls over lies down: it is not thrown back into the air, spinning.
TEST(ContactEnergy, NeedlesFallOverAndLie) {
    for (const double rate : {30.0, 60.0}) {
        for (const double width : {0.001, 0.002, 0.005, 0.01}) {
            for (const double spin : {0.3, 1.0}) {
                SceneDescription scene = ground_scene(0.0, 0.5, 1);
                scene.output.fps = rate;
                BodyDescription& needle = add_box(scene, {width, 1.0, width}, {0.0, 0.5, 0.0});
                needle.friction = 0.5;
                needle.angular_velocity = {0.0, 0.0, spin};
                World world(scene);
                const double start = energy(world);
                for (int k = 0; k < int(8.0 * rate); ++k) {
                    world.step();
                    ASSERT_LT(energy(world), 1.001 * start) << rate << ' ' << width << ' ' << spin << ' ' << k;
                }
                EXPECT_LT(energy(world), 0.6 * start) << rate << ' ' << width << ' ' << spin;
            }
        }
    }
}

}  // namespace tumble::contact_energy_test
