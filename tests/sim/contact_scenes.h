// Handmade bodies and manifolds, and a scene moved by one contact solver alone: for tests of contact below World, where
// the impulses are accessible.
#pragma once

#include "sim/contact/contact_solver.h"
#include "sim/detection/broad_phase.h"
#include "sim/detection/narrow_phase.h"
#include "sim/dynamics/body_builder.h"
#include "sim/dynamics/integrator.h"
#include "sim/impact/settings.h"
#include "support/scenes.h"

#include <numeric>
#include <vector>

namespace tumble::testing {

/// A manifold of one point between two bodies; only the touching pair matters.
inline Manifold touch(std::uint32_t a, std::uint32_t b) {
    Manifold m;
    m.a = a;
    m.b = b;
    m.normal = Vec3::UnitY();
    m.count = 1;
    return m;
}

/// Gravity and resting contact alone: no restitution, no sleep, symplectic Euler.
class SolverScene {
public:
    /// kept: keeps islands, and the solvers' data for them, while the same pairs touch.
    enum class Islands { kept, found_anew };

    explicit SolverScene(const SceneDescription& scene, ContactSolver::Choice choice = ContactSolver::Choice::by_island,
                         int threads = 1, Islands find = Islands::kept)
        : find_(find),
          gravity_(scene.simulation.gravity),
          h_(scene.step()),
          pool_(threads),
          narrow_phase_(threads),
          islands_(scene.bodies.size()),
          solver_(scene.bodies.size(), choice),
          awake_() {
        bodies = build_bodies(scene);
        for (std::uint32_t i = 0; i < bodies.size(); ++i)
            if (bodies[i].dynamic()) awake_.push_back(i);
    }

    void step() {
        manifolds = &narrow_phase_.find(broad_phase_.update(bodies, h_), bodies, h_, pool_);
        if (find_ == Islands::found_anew || narrow_phase_.changes() != seen_)
            islands_.find(narrow_phase_.touching(), bodies, awake_);
        seen_ = narrow_phase_.changes();
        std::vector<BodyVelocity> before(bodies.size());
        for (const std::uint32_t i : awake_) {
            Body& body = bodies[i];
            body.derive();
            before[i] = {body.velocity, body.angular_velocity};
            body.momentum += h_ * body.mass * gravity_;
            body.derive();
        }
        const double threshold = tuning::restitution_threshold * gravity_.norm() * h_;
        solver_.solve({bodies, *manifolds, before, {h_, threshold}}, islands_, pool_);
        for (const std::uint32_t i : awake_) {
            Body& body = bodies[i];
            advance_pose(body, body.velocity + body.correction_velocity,
                         body.angular_velocity + body.correction_angular_velocity, h_, RotationForm::quaternion);
            body.correction_velocity.setZero();
            body.correction_angular_velocity.setZero();
            body.derive();
        }
    }
    void run(double seconds) {
        for (int k = 0; k < int(std::lround(seconds / h_)); ++k) step();
    }

    /// N s along the normals between two bodies (a < b), in the last step.
    double load(std::uint32_t a, std::uint32_t b) const {
        double sum = 0.0;
        for (const Manifold& m : *manifolds)
            if (m.a == a && m.b == b)
                for (int i = 0; i < m.count; ++i) sum += m.points[std::size_t(i)].impulse;
        return sum;
    }
    /// N, friction between them.
    double friction(std::uint32_t a, std::uint32_t b) const {
        double one = 0.0, two = 0.0;
        for (const Manifold& m : *manifolds)
            if (m.a == a && m.b == b) {
                one += m.friction[0];
                two += m.friction[1];
            }
        return std::hypot(one, two) / h_;
    }
    double h() const { return h_; }
    /// Number of times that the islands were found.
    std::uint64_t island_changes() const { return islands_.changes(); }

    std::vector<Body> bodies;
    std::vector<Manifold>* manifolds = nullptr;  // of the last step

private:
    Islands find_;
    std::uint64_t seen_ = UINT64_MAX;
    Vec3 gravity_;
    double h_;
    ThreadPool pool_;
    BroadPhase broad_phase_;
    NarrowPhase narrow_phase_;
    ContactIslands islands_;
    ContactSolver solver_;
    std::vector<std::uint32_t> awake_;
};

}  // namespace tumble::testing
