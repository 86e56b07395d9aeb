// Resting contact and friction of whole heaps: many small substeps, one sweep each, with soft constraints.
//
// The step h is cut into n substeps. In each, velocities take their share of the step's forces, contacts are swept once
// from the impulses of the last substep, bodies move by the new velocities, and a second sweep removes from the
// velocities the part that only pushed overlaps apart ("Small Steps", Macklin and others 2019; soft constraints and
// relaxation: Catto 2011, "Soft Constraints", and 2024, "Solver2D"). An overlap s < 0 asks for the velocity
//   b = w / (2 z + w d) s,   mass factor  m = c / (1 + c),   impulse factor  k = 1 / (1 + c),   c = d w (2 z + w d)
// of a damped spring of angular frequency w and damping ratio z over a substep d; except between unlike masses,
// of b (1 + min(1, |s| / s2)), with s2 the overlap that is twice as stiff. Points that do not touch yet (s > 0) may
// approach by s/d and no more.
//
// Friction: a force f at one point of the manifold, the centroid of its contact area, |f| <= mu sum N_i, and a
// torsional moment T about its normal, |T| <= mu N d, with d the area's mean distance from there. Where T does not stop
// the spin, and the spin is not negligible (spin_share), the two share one limit, that of Coulomb's law over the area
// (spin_friction.h): a contact that slides and spins has less friction against either.
//
// Contacts are colored so that none of one color share a moving body; those of a color are solved side by side, a lane
// each, in single precision, relative to the poses of the step's start (soft_batch.h). The sums of the impulses then
// change the momenta in double precision, equal and opposite to the last bit.
#pragma once

#include "sim/contact/model/contact_constraint.h"
#include "sim/contact/soft/soft_kernel.h"
#include "sim/contact/soft/soft_layout.h"
#include "sim/threads/thread_pool.h"

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

namespace tumble {

class SoftBatch;

class SoftSolver {
public:
    explicit SoftSolver(std::size_t bodies, const soft::Kernel& kernel = soft::best_kernel());
    ~SoftSolver();

    /// `batches`: batches of manifolds (ascending) and dynamic bodies of one island or several; batches share no
    /// dynamic body.
    /// `same`: as in the last call, down to the manifolds' pairs. The result depends neither on the batching nor on the
    /// number of threads.
    using Batch = IslandBatch;
    void solve(const ContactProblem& problem, std::span<Batch> batches, bool same, ThreadPool& pool);
    /// Moment C of a joint in the last solve: see soft_joints.h, N m s.
    const Vec3& carried(std::uint32_t joint) const { return carried_[joint]; }

private:
    const soft::Kernel& kernel_;
    std::vector<std::uint32_t> slot_;                  // by body
    std::vector<std::unique_ptr<SoftBatch>> workers_;  // one per thread
    std::vector<SoftLayout> layouts_;                  // one per batch
    std::vector<std::size_t> small_;                   // batches that one thread solves
    std::vector<soft::JointKind> kinds_;               // by joint; of the scene's joints, which do not change
    std::vector<Vec3> carried_;                        // by joint
    bool resists_ = false;                             // some bodies have rolling or spinning friction
    double mass_unit_ = 0.0;                           // kg; of the scene's bodies, which do not change
};

/// Number of substeps of a step of h seconds.
int substeps_of(double h);

}  // namespace tumble
