// CCD clamp (impacts = "stepped"): no body passes through another within a step. Where a body's displacement in a step
// is long compared with the thickness of possible obstacles, the time of first touch is searched, and both bodies move
// only until then. The rest of their step is lost; the next step finds them touching and resolves the impact at full
// speed. A kinematic body does not stop for dynamic bodies: it carries along the bodies that it runs into.
#pragma once

#include "sim/ccd/time_of_impact.h"
#include "sim/detection/broad_phase.h"
#include "sim/geometry/manifold.h"

#include <functional>
#include <optional>
#include <vector>

namespace tumble {

struct CcdFraction {
    static constexpr std::uint32_t none = UINT32_MAX;
    double share = 1.0;            // fraction of the step for which the body may move
    std::uint32_t carrier = none;  // index of the kinematic body that carries it along from there on
    std::uint32_t met = none;      // index of the body that it meets there, if known
};

/// Depth (m) of the overlap of a pair that touches already; nothing for other pairs.
using TouchDepth = std::function<std::optional<double>(std::uint32_t a, std::uint32_t b)>;

/// Preconditions: the manifolds are ascending by body and outlive the result.
TouchDepth touch_depth(const std::vector<Manifold>& manifolds, const std::vector<Body>& bodies);

/// The pairs that may meet in the step: called only where a body is fast.
using FindPairs = std::function<const std::vector<BroadPhase::Pair>&()>;

/// True if a body rotates in free rotation, not by its motion's angular velocity; none: no body does.
using TurnsFreely = std::function<bool(std::uint32_t body)>;

/// True if a pair has been found to stay apart in the step, on the paths of its flight; none: no pair has.
using KnownApart = std::function<bool(std::uint32_t a, std::uint32_t b)>;

/// Preconditions: as for touch_depth().
KnownApart known_apart(const std::vector<Manifold>& manifolds);

/// Bodies and their motions in a step.
struct CcdStep {
    const std::vector<Body>& bodies;
    const std::vector<BodyVelocity>& motions;  // by body; zero for bodies that do not move
    double h;                                  // s
    bool any_fast;                             // true if any motion is fast
    TurnsFreely turns_freely = nullptr;
    KnownApart known_apart = nullptr;
};

/// The forces have done work on a body in contact as if it had moved for the whole step, by an impulse (N s) and an
/// angular impulse (N m s). Removes the part for the displacement lost to the clamp, `share` being the fraction done: a
/// body clamped again and again would otherwise gain all of its fall's speed on the spot.
void return_work(Body& body, const Vec3& impulse, const Vec3& turn, double share);

class CcdClamp {
public:
    explicit CcdClamp(const std::vector<Body>& bodies);

    /// To be called when a body has another shape.
    void measure(std::uint32_t index, const Body& body);
    void measure(const std::vector<Body>& bodies) {
        for (std::uint32_t i = 0; i < bodies.size(); ++i) measure(i, bodies[i]);
    }

    /// True if the body moves so far in h seconds that it might pass another undetected. If no body does, there are no
    /// limits.
    bool fast(std::uint32_t body, const BodyVelocity& motion, double h) const;

    /// Limits by body. Touching pairs belong to the contact solver and may only overlap a little more.
    const std::vector<CcdFraction>& limits(const CcdStep& step, const FindPairs& find_pairs,
                                           const TouchDepth& touch_depth);

    /// For checkpoints: see sim/checkpoint/archive.h.
    template <class Archive, class Self>
    static void visit(Archive& archive, Self& self) {
        auto& [search, limits, shortened, depth, arm, least_thin, paths, still, fast] = self;
        archive.rebuilt(limits, shortened, depth, arm, least_thin);
        archive.keep(search);
        archive.scratch(paths, still, fast);
    }

private:
    struct FastPair {
        std::uint32_t a, b;
        double overlap;  // m, limit of the overlap of touching pairs
        // s, time in which the gap stays within the contact tolerance. A pair that meets so soon counts as touching,
        // though its manifold, along a face, may still have a gap: clamped there, the impact would never be resolved.
        double at_once;
        double overlap_of_touching;  // m, lower bound
    };
    double first_touch(const FastPair& pair, const std::vector<Body>& bodies, double h);

    CcdFraction& shorten(std::uint32_t body);

    ImpactSearch search_;
    std::vector<CcdFraction> limits_;
    std::vector<std::uint32_t> shortened_;   // bodies whose limits are below the whole step
    std::vector<double> depth_, arm_;        // m, by body; arm: farthest distance of its points from the center
    double least_thin_ = 0.0;                // m, relative motion that no pair needs to be checked below
    std::vector<Trajectory> paths_, still_;  // of the bodies of fast pairs
    std::vector<FastPair> fast_;
};

}  // namespace tumble
