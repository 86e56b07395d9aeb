// Velocities that fit the joints at the end of each step by rows, and at the start of flights: energies and their
// ledger.
#include "joint_scenes.h"

#include <gtest/gtest.h>

#include <cmath>

namespace tumble::fit_test {
using namespace tumble::testing;

namespace {

constexpr ImpactMode modes[] = {ImpactMode::stepped, ImpactMode::exact};

double energy(const World& world) { return world.measure().kinetic + world.contact_records().energy.friction_loss; }
double balance(const World& world) { return energy(world) + world.contact_records().energy.impact_loss; }

/// Two rods that turn against each other; their velocities miss the hinge by 0.1 mm/s.
SceneDescription turning_rods(ImpactMode mode, int rate, double friction) {
    SceneDescription scene = empty_scene(1);
    scene.output.fps = rate;
    scene.simulation.sleep = false;
    scene.simulation.impacts = mode;
    scene.simulation.integrator = IntegratorKind::exact;
    for (int i = 0; i < 2; ++i) add_box(scene, {1.0, 0.1, 0.1}, {double(i), 2.0, 0.0});
    scene.bodies[0].angular_velocity = {0.0, 0.0, 20.0};
    scene.bodies[1].angular_velocity = {0.0, 0.0, -15.0};
    scene.bodies[1].velocity = {0.0, 2.5001, 0.0};
    add_joint(scene, JointType::hinge, 0, 1, {0.5, 2.0, 0.0}, Vec3::UnitZ()).turn[0].friction = friction;
    return scene;
}

TEST(JointFit, AMisfitIsLostOnceAndTheTreeFlies) {
    for (const ImpactMode mode : modes)
        for (const int rate : {60, 240, 960})
            for (const double friction : {0.05, 0.3, 2.0}) {
                World world(turning_rods(mode, rate, friction));
                world.record_contacts();
                const double start = balance(world);
                for (int frame = 0; frame < rate; ++frame) {
                    world.advance_frame();
                    EXPECT_NEAR(balance(world), start, 1e-9) << rate << " " << friction << " " << frame;
                }
                EXPECT_GT(world.contact_records().energy.impact_loss, 0.0);
                EXPECT_LT(world.contact_records().energy.impact_loss, 1e-8);
            }
}

/// A light plate and a small heavy box that whirls about it, at speeds and a friction in proportion to the rate of
/// steps.
SceneDescription whirling_pair(ImpactMode mode, int rate, double friction) {
    const double share = rate / 960.0;
    SceneDescription scene = empty_scene(1);
    scene.output.fps = rate;
    scene.simulation.sleep = false;
    scene.simulation.impacts = mode;
    scene.simulation.integrator = IntegratorKind::symplectic_euler;
    const auto add = [&](const Vec3& size, double mass, const Vec3& place, const Quat& turned, const Vec3& velocity,
                         const Vec3& spin) {
        BodyDescription& box = add_box(scene, size, place, mass);
        box.rotation = turned.normalized();
        box.velocity = share * velocity;
        box.angular_velocity = share * spin;
    };
    add({0.24671980476901964, 0.4992556921942108, 0.40059332480653775}, 0.305178,
        {0.4992925004657009, 1.3711818918992165, -0.4793161063347657},
        Quat(0.9159048571572285, -0.31807803883037566, -0.24215966125591615, -0.03610197099936269),
        {-12.480112183517239, -13.674013702344494, 9.859138456941219},
        {-2.371179182228804, -14.013890822102013, -37.289443369389225});
    add({0.07374182400540714, 0.08424448498017702, 0.06862540699034934}, 12.356101,
        {-0.7167535824590129, 0.06121160369315293, 0.5598944635872131},
        Quat(0.25293140593548613, -0.3548711326338827, -0.5535295582833129, -0.7097162892461496),
        {0.30824126914691297, 1.3404003629479022, -0.2432068936861292},
        {-7.003572721776372, -14.365181973864319, 52.828470585604414});
    JointDescription& joint =
        add_joint(scene, JointType::hinge, 0, 1, {-0.34121362092551333, 0.9219719055585793, 0.02763457699414429},
                  {-0.05834206457388498, -0.004522538469552223, 0.9982864068728212});
    joint.turn[0].friction = friction * share * share;
    joint.friction_coefficient = 1e-9;  // of the bearing: rows move the pair
    return scene;
}

TEST(JointFit, StepsByRowsAddNoEnergy) {
    for (const ImpactMode mode : modes)
        for (const int rate : {30, 240, 960})
            for (const double friction : {1e-6, 0.1, 0.3876309870919855}) {
                World world(whirling_pair(mode, rate, friction));
                world.record_contacts();
                const double start = energy(world);
                double most = 0.0;
                for (int frame = 0; frame < 144; ++frame) {
                    world.advance_frame();
                    most = std::max(most, energy(world));
                }
                EXPECT_LT(most, 1.002 * start) << rate << " " << friction;
            }
}

// CCD stops an island within the step, at poses that its velocities do not fit.
TEST(JointFit, AChainThatCcdStopsFitsItsJoints) {
    SceneDescription scene = empty_scene(1);
    scene.simulation.sleep = false;
    add_box(scene, {0.1, 4.0, 4.0}, {2.0, 0.0, 0.0}).type = BodyType::fixed;
    for (int i = 0; i < 4; ++i) {
        BodyDescription& box = add_box(scene, {0.2, 0.2, 0.2}, {0.5 * i - 1.5, 0.0, 0.05 * i});
        box.velocity = {60.0, 0.0, 0.0};
        box.angular_velocity = {10.0, 5.0 * i, -8.0};
        box.restitution = 0.5;
        if (i > 0) add_joint(scene, JointType::ball, std::size_t(i), std::size_t(i + 1), {0.5 * i - 1.75, 0.0, 0.0});
    }
    World world(scene);
    const auto misfit = [&] {
        const Snapshot& now = world.snapshot();
        double most = 0.0;
        for (std::size_t k = 0; k < scene.joints.size(); ++k) {
            const Vec3 point = world.joint_states()[k].point;
            const auto velocity = [&](std::size_t i) {
                const BodyState& body = now.bodies[i];
                return Vec3(body.velocity + body.angular_velocity.cross(point - body.center_of_mass));
            };
            most = std::max(most, (velocity(k + 2) - velocity(k + 1)).norm());
        }
        return most;
    };
    for (int frame = 0; frame < 12; ++frame) {
        world.advance_frame();
        EXPECT_LT(misfit(), 1e-9) << frame;
    }
}

}  // namespace
}  // namespace tumble::fit_test
