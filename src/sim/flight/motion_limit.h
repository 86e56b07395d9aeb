// No body passes through another within a step (impacts = "stepped"). Where a body's way in a step is long against the
// thinness of what it may meet, the moment of first touch is looked for, and both bodies go no farther than that: the
// rest of their step's time is given up, the next step finds them touching and resolves the collision at full speed. What
// stops for no dynamic body, a kinematic one, carries along what it runs into.
#pragma once

#include "sim/broad_phase.h"
#include "sim/contact/contact.h"
#include "sim/flight/time_of_impact.h"

#include <vector>

namespace tumble {

/// The velocities a body is to be moved with in this step.
struct StepMotion {
    Vec3 velocity = Vec3::Zero(), angular_velocity = Vec3::Zero();
};

struct StepLimit {
    static constexpr std::uint32_t none = UINT32_MAX;
    double share = 1.0;              // of the step, that the body may move
    std::uint32_t carrier = none;    // the kinematic body that takes it along from there on
};

class MotionLimit {
public:
    /// By body; `motions` too, bodies that do not move have zero. What touches already is the contact solver's, and may come
    /// a little deeper into each other: no more.
    const std::vector<StepLimit>& limits(const std::vector<BroadPhase::Pair>& pairs, const std::vector<Contact>& contacts,
                                         const std::vector<Body>& bodies, const std::vector<StepMotion>& motions, double h);

private:
    struct FastPair {
        std::uint32_t a, b;
        double overlap;   // m, that it may come to: of those that touch already
    };
    double first_touch(const FastPair& pair, const std::vector<Body>& bodies, double h);

    ImpactSearch search_;
    std::vector<StepLimit> limits_;
    std::vector<Path> paths_, still_;   // of the bodies of fast pairs
    std::vector<FastPair> fast_;
};

}  // namespace tumble
