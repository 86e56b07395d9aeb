// Prints the bytes of trajectories that pass through every part of the simulation: boxes, spheres, hulls, a triangle
// mesh, a kinematic paddle, wind, a point force, friction, restitution, sleep, joints, every integrator. Argument: the
// number of threads.
#include "../joints/swept_scenes.h"
#include "sim/dynamics/body_builder.h"
#include "sim/dynamics/integrators/advance.h"
#include "support/compounds.h"
#include "support/meshes.h"
#include "support/scenes.h"

#include <cstdio>
#include <cstdlib>

using namespace tumble;
using namespace tumble::testing;

namespace {

// Free rotation in closed form, drag, and the extrapolation for the body under the point force.
void print_exact_motion(const SceneDescription& scene) {
    const ForceField forces(scene);
    BodyBuilder builder;
    SceneDescription calm = scene;
    calm.wind.reset();
    const ForceField no_wind(calm);
    for (std::size_t i = 1; i < 20; ++i) {
        const Body body = builder.build(scene.bodies[i], IntegratorKind::exact);
        for (const ForceField* field : {&forces, &no_wind}) {
            const RigidState s = advance_exactly(body, *field, i, 0.0, 0.7);
            std::fwrite(s.position.data(), sizeof(double), 3, stdout);
            std::fwrite(s.orientation.coeffs().data(), sizeof(double), 4, stdout);
            std::fwrite(s.momentum.data(), sizeof(double), 3, stdout);
            std::fwrite(s.angular_momentum.data(), sizeof(double), 3, stdout);
        }
    }
}

void print_trajectory(const SceneDescription& scene, int frames, int threads) {
    World world(scene, threads);
    for (int frame = 0; frame < frames; ++frame) {
        world.advance_frame();
        for (const BodyState& b : world.snapshot().bodies) {
            std::fwrite(b.center_of_mass.data(), sizeof(double), 3, stdout);
            std::fwrite(b.orientation.coeffs().data(), sizeof(double), 4, stdout);
            std::fwrite(b.velocity.data(), sizeof(double), 3, stdout);
            std::fwrite(b.angular_velocity.data(), sizeof(double), 3, stdout);
        }
    }
}

// One island with enough bodies and manifolds for threads to share its work.
SceneDescription block() {
    SceneDescription scene = ground_scene(0.0, 0.5, 1);
    for (int i = 0; i < 576; ++i) {
        const Vec3 at(1.001 * (i % 8) + 0.3 * (i / 64 % 2), 0.5 + 0.999 * (i / 64), 0.999 * (i / 8 % 8));
        BodyDescription& box = add_box(scene, {1.0, 1.0, 1.0}, at);
        box.mass = 1.0 + 0.01 * (i % 7);
        box.friction = 0.5;
        box.velocity = {i % 8 < 4 ? 0.5 : -0.5, 0.0, 0.1 * (i % 3)};
    }
    return scene;
}

// Figures that fall on a floor: by the direct solver, in sweeps, and from impact to impact.
SceneDescription figures(ContactSolverChoice solver, ImpactMode impacts) {
    SceneDescription scene = figure_scene(4);
    const std::size_t bodies = scene.bodies.size(), joints = scene.joints.size();
    for (std::size_t copy = 1; copy < 3; ++copy) {
        for (std::size_t i = 0; i < bodies; ++i) {
            BodyDescription body = scene.bodies[i];
            body.position += Vec3(0.3 * double(copy), 1.3 * double(copy), 0.1);
            scene.bodies.push_back(body);
        }
        for (std::size_t i = 0; i < joints; ++i) {
            JointDescription joint = scene.joints[i];
            *joint.first += copy * bodies;
            *joint.second += copy * bodies;
            joint.turn[0].friction = 0.05;
            scene.joints.push_back(joint);
        }
    }
    for (BodyDescription& body : scene.bodies) body.position.y() += 0.9;
    add_floor(scene);
    scene.simulation.contact_solver = solver;
    scene.simulation.impacts = impacts;
    return scene;
}

// A chain of hinges and balls in flight, with springs and friction.
SceneDescription flying_chain(IntegratorKind integrator, bool loop) {
    SceneDescription scene = empty_scene();
    scene.simulation.integrator = integrator;
    for (int i = 0; i < 6; ++i) {
        BodyDescription& box = add_box(scene, {1.0, 0.1, 0.2}, {double(i), 0.0, 0.0});
        box.integrator = integrator;
        box.velocity = {0.1 * (i % 3), 0.25 * (i % 2), -0.125 * (i % 4)};
        if (i == 0) continue;
        const JointType type = i % 2 == 0 ? JointType::ball : JointType::hinge;
        const auto before = std::size_t(i - 1);
        JointDescription& joint = add_joint(scene, type, before, before + 1, {i - 0.5, 0.0, 0.0}, Vec3::UnitZ());
        if (i == 3) joint.turn[0].spring = JointSpring{.stiffness = 2.0, .damping = loop ? 0.0 : 0.1};
        if (i == 5 && !loop) joint.turn[0].friction = 0.02;
    }
    if (loop) {
        JointDescription& rod = add_joint(scene, JointType::distance, 0, 5, {2.5, 0.0, 0.0});
        rod.anchor_first = rod.anchor_second = Vec3::Zero();
        rod.length = 5.0;
    }
    return scene;
}

}  // namespace

int main(int argc, char** argv) {
    SceneDescription scene = ground_scene(0.3, 0.6, 8);
    scene.wind = WindDescription{Vec3(2.0, 0.0, 0.5), 1.2, 1.0};
    for (int i = 0; i < 32; ++i) {
        const Vec3 at((i % 4) * 0.9, 0.6 + 0.8 * (i / 16), ((i / 4) % 4) * 0.9);
        BodyDescription& body = i % 3 == 0   ? add_sphere(scene, 0.3, at)
                                : i % 3 == 1 ? add_box(scene, {0.5, 0.6, 0.4}, at)
                                             : add_body(scene, MeshShape{icosahedron(0.35)}, at);
        body.friction = 0.5;
        body.restitution = 0.1 * (i % 5);
        body.rotation = Quat(1.0, 0.1 * (i % 7), 0.2, -0.05 * (i % 3)).normalized();
        body.angular_velocity = Vec3(0.3 * i, 1.0, -0.2 * i);
        if (i % 5 == 0) body.integrator = IntegratorKind::splitting;
        if (i % 5 == 1) body.integrator = IntegratorKind::runge_kutta_4;
    }
    BodyDescription& ramp = add_body(scene, MeshShape{open_ramp()}, Vec3(-3.0, 0.0, 0.0));
    ramp.type = BodyType::fixed;
    ramp.friction = 0.4;
    for (const Vec3& at : {Vec3(1.0, 2.6, 1.0), Vec3(1.2, 3.8, 1.2)}) {
        BodyDescription& compound = add_body(scene, at.y() < 3.0 ? table() : square_link(1.0, 0.2), at);
        compound.friction = 0.5;
        compound.angular_velocity = Vec3(1.0, 0.5, 2.0);
    }
    BodyDescription& paddle = add_body(scene, BoxShape{Vec3(0.2, 1.0, 3.0)}, Vec3(5.0, 0.5, 1.5));
    paddle.type = BodyType::kinematic;
    paddle.keyframes = {{0.2, Vec3(5.0, 0.5, 1.5), Quat::Identity()},
                        {0.7, Vec3(2.0, 0.6, 1.5), turn(Vec3::UnitY(), 0.4)},
                        {1.0, Vec3(5.0, 0.5, 1.5), Quat::Identity()}};
    scene.forces.push_back({2, Vec3(0.2, 0.0, 0.0), Vec3(0.0, 30.0, 5.0), false, 0.3, 0.6});
    print_exact_motion(scene);
    const int threads = argc > 1 ? std::atoi(argv[1]) : 1;
    print_trajectory(scene, 70, threads);
    print_trajectory(block(), 12, threads);
    print_trajectory(figures(ContactSolverChoice::direct, ImpactMode::stepped), 18, threads);
    print_trajectory(figures(ContactSolverChoice::soft, ImpactMode::stepped), 30, threads);
    print_trajectory(figures(ContactSolverChoice::by_island, ImpactMode::exact), 18, threads);
    for (const IntegratorKind integrator : {IntegratorKind::symplectic_euler, IntegratorKind::splitting,
                                            IntegratorKind::runge_kutta_4, IntegratorKind::exact})
        for (const bool loop : {false, true}) print_trajectory(flying_chain(integrator, loop), 4, threads);
}
