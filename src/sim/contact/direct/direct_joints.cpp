// DirectSolver: islands with joints.
#include "sim/contact/direct/direct_solver.h"
#include "sim/contact/direct/settings.h"
#include "sim/dynamics/integrators/gyroscopic_correction.h"
#include "sim/joints/settings.h"
#include "sim/math/keyframe_track.h"

#include <algorithm>
#include <cmath>

namespace tumble {

using namespace contact_rows;

double DirectSolver::joint_push_stiffness() const { return 1e5 * total_mass_; }

// Factors the matrix, unless it is that of the last factorization: with joints alone, the passes of a step share one.
bool DirectSolver::factored() {
    if (joints_.empty()) return factor(false);
    joints_.evaluate_with_weights();
    if (constraints_.empty() && !joints_.weights_changed()) return true;
    return factor(false);
}

// Poses at the end of the step, moved by the velocities of the solve as the bodies will be.
void DirectSolver::predict_ends(const JointIsland& island) {
    const double h = island.problem.settings.h;
    ends_.resize(island.bodies.size());
    for (std::size_t k = 0; k < island.bodies.size(); ++k) {
        Body& body = island.problem.bodies[island.bodies[k]];
        const Vec3 omega = three(velocity_, 6 * k + 3) / length_ - body.gyration;
        // The gyroscopic correction is that of the new angular velocity.
        const Vec3 omega_before = body.angular_velocity, momentum_before = body.angular_momentum;
        body.angular_velocity = omega;
        body.angular_momentum = length_ * length_ * (masses_[k].inertia * omega);
        const Vec3 turn = omega + gyration(body, h);
        body.angular_velocity = omega_before;
        body.angular_momentum = momentum_before;
        ends_[k].position = body.position + h * three(velocity_, 6 * k);
        ends_[k].orientation = (from_rotation_vector(h * turn) * body.orientation).normalized();
    }
}

// Newton's method, the rounds of the multipliers, and the passes that close the joints, all in one loop: each pass uses
// the last solution.
void DirectSolver::close_joints(const JointIsland& island) {
    friction_compliance_ = tuning::direct_friction_soft * compliance_;
    start();
    double last = infinity;
    bool found = false;
    for (int round = 0; round < tuning::joint_rounds; ++round) {
        if (found) kept_ = velocity_;
        if (!minimize(found ? tuning::direct_newton_steps : tuning::direct_first_newton_steps)) {
            if (found) {
                velocity_ = kept_;
                joints_.keep_estimates();
                for (ConstraintRows& constraint : constraints_)
                    each_row(constraint, [](Row& row) { row.impulse = row.estimate; });
            }
            return;
        }
        found = true;
        const auto [change, largest] = next_round();
        predict_ends(island);
        const double error = joints_.close(island, ends_);
        const bool settled =
            change <= tuning::direct_round_tolerance * std::max(largest, 1e-6 * total_mass_ * speed_scale_);
        if (settled && (error <= tuning::joint_closed || (error < tuning::joint_rounding && error >= 0.5 * last)))
            return;
        last = error;
        friction_compliance_ = std::max(friction_compliance_ * tuning::direct_friction_stiffening,
                                        tuning::direct_friction_stiff * compliance_);
    }
}

bool DirectSolver::solve_with_joints(const JointIsland& island) {
    do close_joints(island);
    while (joints_.give_way());
    return std::all_of(velocity_.begin(), velocity_.end(), [](double v) { return std::isfinite(v); });
}

}  // namespace tumble
