// The parts of a world that a tree of joined bodies needs, without collisions.
#pragma once

#include "joint_scenes.h"
#include "sim/articulation/tree_flight.h"
#include "sim/joints/joint_set.h"
#include "sim/step/body_set.h"

#include <cstdint>
#include <vector>

namespace tumble::testing {

struct TreeScene {
    BodySet set;
    JointSet joints;
    ForceField forces;
    std::vector<std::uint32_t> island;
    std::vector<Joint*> list;
    TreeFlight flight;
    double time = 0.0;  // s

    explicit TreeScene(const SceneDescription& scene)
        : set(scene), joints(scene, set.bodies, set.scene_index, set.origin), forces(scene, set.scene_index) {
        for (std::uint32_t i = 0; i < set.bodies.size(); ++i) {
            set.bodies[i].derive();
            island.push_back(i);
        }
        for (Joint& joint : joints.joints()) list.push_back(&joint);
    }

    TreeFlight::Outcome step(double h, IntegratorKind method = IntegratorKind::exact) {
        const TreeFlight::Outcome outcome = flight.advance({set.bodies, island, list, forces, time, h, 0.2}, method);
        time += h;
        return outcome;
    }

    Vec3 center() const {
        Vec3 sum = Vec3::Zero();
        double mass = 0.0;
        for (const Body& body : set.bodies) {
            mass += body.mass;
            sum += body.mass * body.position;
        }
        return sum / mass;
    }
    Vec3 momentum() const {
        Vec3 sum = Vec3::Zero();
        for (const Body& body : set.bodies) sum += body.momentum;
        return sum;
    }
    Vec3 angular_momentum() const {  // about the center of mass
        Vec3 sum = Vec3::Zero();
        const Vec3 c = center(), p = momentum();
        double mass = 0.0;
        for (const Body& body : set.bodies) mass += body.mass;
        for (const Body& body : set.bodies)
            sum += body.angular_momentum + (body.position - c).cross(body.momentum - body.mass / mass * p);
        return sum;
    }
    double energy() const {
        double sum = 0.0;
        for (const Body& body : set.bodies)
            sum += body.kinetic_energy() - body.mass * forces.gravity().dot(body.position);
        return sum;
    }
};

}  // namespace tumble::testing
