// method = "notes": the course notes to the letter (docs/explanation/physics.md lists what the default method does
// beyond them). In each fixed step, at the poses of t_n:
// 1. Collisions: one impulse of eq. 20 for each touching point with v_rel < 0, one contact after the other, each at
//    the velocities that the ones before it have left. No friction, no resting contact.
// 2. One step of explicit or symplectic Euler (section 3.2), with the tangent step for R or q.
// The notes leave open how R and q stay rotations after the tangent step; here they are made the nearest ones.
#pragma once

#include "sim/contact/model/contact.h"
#include "sim/detection/broad_phase.h"
#include "sim/detection/narrow_phase.h"
#include "sim/math/wrench.h"

namespace tumble {

struct StepContext;

class NotesMethod {
public:
    explicit NotesMethod(int threads) : narrow_phase_(threads, NarrowPhase::Mode::measure) {}

    void step(const StepContext& step);

    /// For checkpoints: see sim/checkpoint/archive.h.
    template <class Archive, class Self>
    static void visit(Archive& archive, Self& self) {
        auto& [broad_phase, narrow_phase, points, contacts] = self;
        archive.keep(broad_phase, narrow_phase);
        archive.scratch(points, contacts);
    }

private:
    struct Point {
        std::uint32_t manifold;
        int index;  // of the manifold's point
    };
    struct Collision {
        double before = 0.0, impulse = 0.0;  // v_rel (m/s) and j (N s); zero: no collision
    };
    void collide(const StepContext& step);
    static Collision resolve(const Vec3& point, const Vec3& n, Body& a, Body& b);
    void log_impulse(const StepContext& step, const Manifold& m, const Point& point, const Collision& found);
    static void log_forces(const StepContext& step, std::uint32_t i, const Wrench& wrench, const BodyVelocity& old);

    BroadPhase broad_phase_{BroadPhase::Pairs::all};
    NarrowPhase narrow_phase_;
    std::vector<Point> points_;
    std::vector<Contact> contacts_;  // of one manifold, for the log
};

}  // namespace tumble
