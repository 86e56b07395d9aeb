// The record of impacts and contacts: momentum and energy balance, closed forms, and that recording changes nothing.
#include "scene/load.h"
#include "sim/world.h"

#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <string>
#include <vector>

namespace tumble::contact_log_test {
namespace {

SceneDescription demo(const std::string& name, const char* mode, double seconds) {
    SceneOverrides overrides;
    overrides.duration = seconds;
    overrides.impacts = mode;
    return load_scene(std::filesystem::path(TUMBLE_SOURCE_DIR) / "assets/scenes" / (name + ".toml"), overrides);
}

SceneDescription parse(const std::string& text) { return parse_scene("format = 1\n" + text, "scene.toml"); }

std::vector<double> masses(const World& world, const SceneDescription& scene) {
    std::vector<double> all;
    for (std::size_t i = 0; i < scene.bodies.size(); ++i)
        all.push_back(scene.bodies[i].type == BodyType::dynamic ? world.report(i).mass : 0.0);
    return all;
}

/// Largest error of a body's momentum balance over a frame, as a fraction of the largest momentum.
double balance_error(const SceneDescription& scene) {
    World world(scene);
    world.record_contacts();
    const std::vector<double> mass = masses(world, scene);
    const double duration = 1.0 / scene.output.fps;
    Snapshot before = world.snapshot();
    double error = 0.0, largest = 1e-300;
    for (std::int64_t frame = 1; frame < scene.frame_count(); ++frame) {
        world.advance_frame();
        const Snapshot after = world.snapshot();
        std::vector<Vec3> sum;
        for (const double m : mass) sum.push_back(duration * m * scene.simulation.gravity);
        for (const ImpactRecord& r : world.contact_records().impacts) {
            const Vec3 j = r.impulse * r.normal + r.friction;
            sum[r.a] -= j;
            sum[r.b] += j;
        }
        for (const ContactRecord& r : world.contact_records().contacts) {
            const Vec3 j = duration * (r.normal_force * r.normal + r.tangential_force);
            if (r.a != ContactRecord::nobody) sum[r.a] -= j;
            sum[r.b] += j;
        }
        for (std::size_t i = 0; i < mass.size(); ++i) {
            if (mass[i] == 0.0) continue;
            const Vec3 change = mass[i] * (after.bodies[i].velocity - before.bodies[i].velocity);
            error = std::max(error, (change - sum[i]).norm());
            largest = std::max(largest, mass[i] * after.bodies[i].velocity.norm());
        }
        before = after;
    }
    return error / largest;
}

TEST(ContactLog, MomentumBalanceClosesInAllDemoScenes) {
    for (const char* name : {"bouncing_balls", "dominoes", "falling_boxes", "furniture", "mixed_heap", "newtons_cradle",
                             "paddle", "tennis_racket", "tower_hit", "turntable"}) {
        EXPECT_LT(balance_error(demo(name, "stepped", 1.0)), 1e-12) << name;
        EXPECT_LT(balance_error(demo(name, "exact", std::string(name) == "mixed_heap" ? 0.3 : 0.7)), 1e-12) << name;
    }
}

TEST(ContactLog, RecordingChangesNoMotionAndThreadsChangeNoRecord) {
    for (const char* mode : {"stepped", "exact"}) {
        const SceneDescription scene = demo("falling_boxes", mode, 0.8);
        World plain(scene), recording(scene), threads(scene, 3);
        recording.record_contacts();
        threads.record_contacts();
        for (std::int64_t frame = 1; frame < scene.frame_count(); ++frame) {
            for (World* world : {&plain, &recording, &threads}) world->advance_frame();
            const Snapshot a = plain.snapshot(), b = recording.snapshot();
            for (std::size_t i = 0; i < a.bodies.size(); ++i) {
                ASSERT_EQ(a.bodies[i].center_of_mass, b.bodies[i].center_of_mass) << frame;
                ASSERT_EQ(a.bodies[i].velocity, b.bodies[i].velocity) << frame;
            }
            const ContactRecords &one = recording.contact_records(), &three = threads.contact_records();
            ASSERT_EQ(one.impacts.size(), three.impacts.size()) << frame;
            ASSERT_EQ(one.contacts.size(), three.contacts.size()) << frame;
            ASSERT_EQ(one.loads.size(), three.loads.size()) << frame;
            for (std::size_t k = 0; k < one.impacts.size(); ++k) {
                ASSERT_EQ(one.impacts[k].impulse, three.impacts[k].impulse) << frame;
                ASSERT_EQ(one.impacts[k].moment, three.impacts[k].moment) << frame;
            }
            for (std::size_t k = 0; k < one.contacts.size(); ++k) {
                ASSERT_EQ(one.contacts[k].normal_force, three.contacts[k].normal_force) << frame;
                ASSERT_EQ(one.contacts[k].moment, three.contacts[k].moment) << frame;
            }
            for (std::size_t k = 0; k < one.loads.size(); ++k) {
                ASSERT_EQ(one.loads[k].force, three.loads[k].force) << frame;
                ASSERT_EQ(one.loads[k].moment, three.loads[k].moment) << frame;
            }
        }
    }
}

TEST(ContactLog, TheEnergyAloneIsTheSameWithoutLists) {
    for (const char* mode : {"stepped", "exact"}) {
        std::vector<SceneDescription> scenes;
        for (const char* name : {"falling_boxes", "engine", "double_pendulums"})
            scenes.push_back(demo(name, mode, 0.6));
        scenes.push_back(parse("[simulation]\nduration = 0.8\nimpacts = \"" + std::string(mode) + R"("
[[body]]
type = "kinematic"
shape = { type = "box", size = [2, 0.2, 2] }
friction = 0.5
keyframes = [{ time = 0 }, { time = 1, position = [0.3, 0.5, 0] }]
[[body]]
shape = { type = "box", size = [0.5, 0.5, 0.5] }
position = [0, 0.6, 0]
)"));
        EnergyLedger sum;
        for (const SceneDescription& scene : scenes) {
            World all(scene), energy(scene);
            all.record_contacts();
            energy.record_energy();
            EXPECT_FALSE(energy.records_contacts());
            for (std::int64_t frame = 1; frame < scene.frame_count(); ++frame) {
                all.advance_frame();
                energy.advance_frame();
                const EnergyLedger &one = all.contact_records().energy, &two = energy.contact_records().energy;
                ASSERT_EQ(one.work, two.work) << scene.title << frame;
                ASSERT_EQ(one.impact_loss, two.impact_loss) << scene.title << frame;
                ASSERT_EQ(one.friction_loss, two.friction_loss) << scene.title << frame;
                ASSERT_EQ(one.motor_work, two.motor_work) << scene.title << frame;
                ASSERT_EQ(one.joint_heat, two.joint_heat) << scene.title << frame;
                const ContactRecords& lists = energy.contact_records();
                ASSERT_TRUE(lists.impacts.empty() && lists.struck.empty() && lists.contacts.empty());
                ASSERT_TRUE(lists.loads.empty() && lists.joints.empty());
            }
            const EnergyLedger& end = all.contact_records().energy;
            sum.impact_loss += std::fabs(end.impact_loss);
            sum.friction_loss += std::fabs(end.friction_loss);
            sum.motor_work += std::fabs(end.motor_work);
            sum.work += std::fabs(end.work - end.motor_work);
        }
        EXPECT_TRUE(sum.impact_loss > 0.0 && sum.friction_loss > 0.0 && sum.motor_work > 0.0 && sum.work > 0.0) << mode;
    }
}

// total + losses - work, relative to its start, at its worst.
double energy_error(const SceneDescription& scene) {
    World world(scene);
    world.record_contacts();
    const auto closed = [&] {
        const Measurement m = world.measure();
        const EnergyLedger e = world.contact_records().energy;
        return m.kinetic + m.potential + e.impact_loss + e.friction_loss - e.work;
    };
    const double start = closed();
    double error = 0.0;
    for (std::int64_t frame = 1; frame < scene.frame_count(); ++frame) {
        world.advance_frame();
        error = std::max(error, std::abs(closed() - start));
    }
    return error / std::abs(start);
}

TEST(ContactLog, EnergyBalanceClosesToRoundingWithExactImpacts) {
    for (const char* name : {"bouncing_balls", "newtons_cradle", "paddle"})
        EXPECT_LT(energy_error(demo(name, "exact", 1.5)), 1e-13) << name;
}

TEST(ContactLog, EnergyBalanceClosesToTheOrderOfTheStepOtherwise) {
    for (const char* name : {"bouncing_balls", "falling_boxes"}) {
        SceneDescription coarse = demo(name, "stepped", 1.0), fine = coarse;
        fine.simulation.steps_per_frame *= 8;
        EXPECT_LT(energy_error(coarse), 5e-3) << name;
        EXPECT_LT(energy_error(fine), 5e-3 / 8.0) << name;
    }
}

// Times of the impacts of a ball dropped from a height, and their impulses: sqrt(2 h / g) (1 + 2 k) for e = 1, and
// j_k = m (1 + e) e^k sqrt(2 g h).
TEST(ContactLog, BouncingBallHasItsClosedForm) {
    for (const double e : {1.0, 0.7}) {
        const SceneDescription scene = parse(R"([simulation]
impacts = "exact"
duration = 3
gravity = [0, -9.81, 0]
[[body]]
type = "fixed"
shape = { type = "plane" }
restitution = 0
[[body]]
shape = { type = "sphere", radius = 0.25 }
mass = 2
position = [0, 1.25, 0]
restitution = )" + std::to_string(e));
        World world(scene);
        world.record_contacts();
        std::vector<ImpactRecord> impacts;
        for (std::int64_t frame = 1; frame < scene.frame_count(); ++frame) {
            world.advance_frame();
            const auto& more = world.contact_records().impacts;
            impacts.insert(impacts.end(), more.begin(), more.end());
        }
        const double fall = std::sqrt(2.0 / 9.81), speed = std::sqrt(2.0 * 9.81);
        ASSERT_GE(impacts.size(), 3u);
        double time = fall, v = speed;
        for (std::size_t k = 0; k < 3; ++k) {
            const ImpactRecord& r = impacts[k];
            EXPECT_NEAR(r.when.time, time, 1e-12) << e << ", " << k;
            EXPECT_NEAR(r.impulse, 2.0 * (1.0 + e) * v, 1e-12 * 2.0 * speed) << e << ", " << k;
            EXPECT_NEAR(r.speed_before, -v, 1e-12 * speed);
            EXPECT_NEAR(r.speed_after, e * v, 1e-12 * speed);
            EXPECT_EQ(r.restitution, e);
            EXPECT_EQ(r.a, 0u);
            EXPECT_NEAR(r.normal.y(), 1.0, 1e-15);
            EXPECT_NEAR(r.point.y(), 0.0, 1e-12);
            EXPECT_TRUE(r.when.exact);
            EXPECT_EQ(r.when.frame, std::int64_t(std::floor(r.when.time * scene.output.fps)));
            v *= e;
            time += 2.0 * v / 9.81;
        }
    }
}

// Contacts of a stack of boxes at rest: the force in level k is the weight of all boxes above it, asleep as well.
TEST(ContactLog, AStackCarriesItsWeightAwakeAndAsleep) {
    for (const int boxes : {1, 20}) {
        std::string text = "[simulation]\nduration = 4\n[[body]]\ntype = \"fixed\"\nshape = { type = \"plane\" }\n";
        for (int i = 0; i < boxes; ++i)
            text +=
                "[[body]]\nshape = { type = \"box\", size = [1, 1, 1] }\nmass = 2\nrestitution = 0\nposition = [0, " +
                std::to_string(i + 0.5) + ", 0]\n";
        const SceneDescription scene = parse(text);
        World world(scene);
        world.record_contacts();
        bool asleep = false;
        for (std::int64_t frame = 1; frame < scene.frame_count(); ++frame) {
            world.advance_frame();
            if (world.snapshot().time < 1.0) continue;
            std::vector<double> load(std::size_t(boxes), 0.0);
            for (const ContactRecord& r : world.contact_records().contacts) {
                if (r.a == ContactRecord::nobody) continue;
                load[r.b - 1] += r.normal_force * r.normal.y();
                asleep = asleep || r.state == ContactRecord::State::asleep;
            }
            for (int k = 0; k < boxes; ++k)
                ASSERT_NEAR(load[std::size_t(k)], (boxes - k) * 2.0 * 9.81,
                            (boxes == 1 ? 1e-9 : 1e-6) * boxes * 2.0 * 9.81)
                    << boxes << ", level " << k << ", frame " << frame;
        }
        EXPECT_TRUE(asleep) << boxes;
    }
}

TEST(ContactLog, FrictionHoldsABlockOnASlope) {
    const double angle = 20.0 * std::acos(-1.0) / 180.0, s = std::sin(angle), c = std::cos(angle);
    SceneDescription scene = parse(R"([simulation]
duration = 2
sleep = false
[[body]]
type = "fixed"
shape = { type = "plane" }
friction = 0.6
[[body]]
shape = { type = "box", size = [1, 1, 1] }
mass = 2
restitution = 0
friction = 0.6
position = [0, 0.5, 0]
)");
    scene.simulation.gravity = 9.81 * Vec3(s, -c, 0.0);  // the slope is the plane, gravity is turned
    World world(scene);
    world.record_contacts();
    for (std::int64_t frame = 1; frame < scene.frame_count(); ++frame) world.advance_frame();
    Vec3 friction = Vec3::Zero();
    double normal = 0.0;
    for (const ContactRecord& r : world.contact_records().contacts) {
        friction += r.tangential_force;
        normal += r.normal_force;
        EXPECT_EQ(r.state, ContactRecord::State::stick);
    }
    EXPECT_NEAR(normal, 2.0 * 9.81 * c, 1e-6);
    EXPECT_NEAR(friction.x(), -2.0 * 9.81 * s, 1e-6);
}

}  // namespace
}  // namespace tumble::contact_log_test
