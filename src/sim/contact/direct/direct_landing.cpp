// Landings of a body that already stands on something, as of a rocking block on its other edge: solved in parts of the
// step.
//
// A contact row closes a gap at constant speed from the start of the step, as if the corner had landed then and the
// other corner no longer carried the body. At 60 steps per second a rocking block so loses a tenth of its energy in
// each landing, beyond the loss of the landing itself. In n parts, each as long as the soft solver's substep, it is an
// n-th of that.
#include "sim/contact/direct/direct_solver.h"
#include "sim/contact/direct/settings.h"
#include "sim/contact/model/settings.h"

#include <algorithm>
#include <cmath>

namespace tumble {

using namespace contact_rows;

int DirectSolver::landing_parts(const ContactProblem& problem, std::span<const std::uint32_t> bodies) const {
    if (bodies.size() != 1) return 1;
    bool lands = false, stands = false;
    for (const Patch& patch : patches_)
        for (int i = 0; i < patch.count; ++i) {
            const Row& row = patch.normal[i];
            const double closing = -(row.offset + dot(patch, row, free_)), even = -row.target;
            lands = lands || (even > tuning::direct_landing * closing && closing > even);
            stands = stands || -patch.overlap[i] < tuning::friction_near * patch.size;
        }
    return lands && stands ? int(std::lround(problem.patches.h / tuning::soft_substep)) : 1;
}

bool DirectSolver::solve_in_parts(const ContactProblem& problem, std::uint32_t index, int parts) {
    const BodyVelocity& before = problem.before[index];
    const Body& body = problem.bodies[index];
    const double d = problem.patches.h / parts;
    std::vector<double> faster(6), velocity(6), sums;
    put(velocity.data(), before.velocity, length_ * (before.angular_velocity + body.gyration));
    for (std::size_t k = 0; k < 6; ++k) faster[k] = (free_[k] - velocity[k]) / parts;
    way_.assign(6, 0.0);
    for (Patch& patch : patches_) each_row(patch, [&](Row& row) { row.estimate /= parts; });
    for (int part = 0; part < parts; ++part) {
        for (std::size_t k = 0; k < 6; ++k) free_[k] = velocity[k] + faster[k];
        for (Patch& patch : patches_)
            for (int i = 0; i < patch.count; ++i) {
                Row& row = patch.normal[i];
                const double gap = -patch.overlap[i] + dot(patch, row, way_) + part * d * row.offset;
                row.target = std::min(0.0, -gap / d);
            }
        friction_compliance_ = tuning::direct_friction_soft * compliance_;
        if (!solve_rounds() || !admissible()) return false;
        velocity = velocity_;
        for (std::size_t k = 0; k < 6; ++k) way_[k] += d * velocity[k];
        std::size_t next = 0;
        for (Patch& patch : patches_)
            each_row(patch, [&](Row& row) {
                if (part == 0) sums.push_back(0.0);
                sums[next++] += row.impulse;
            });
    }
    std::size_t next = 0;
    for (Patch& patch : patches_) each_row(patch, [&](Row& row) { row.impulse = sums[next++]; });
    std::fill(push_.begin(), push_.end(), 0.0);
    return true;
}

}  // namespace tumble
