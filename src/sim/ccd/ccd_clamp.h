// No body passes through another within a step (impacts = "stepped"). Where a body's way in a step is long against the
// thinness of what it may meet, the moment of first touch is looked for, and both bodies go no farther than that: the
// rest of their step's time is given up, the next step finds them touching and resolves the collision at full speed. What
// stops for no dynamic body, a kinematic one, carries along what it runs into.
#pragma once

#include "sim/detection/broad_phase.h"
#include "sim/geometry/manifold.h"
#include "sim/ccd/time_of_impact.h"

#include <functional>
#include <optional>
#include <vector>

namespace tumble {

struct CcdFraction {
    static constexpr std::uint32_t none = UINT32_MAX;
    double share = 1.0;              // of the step, that the body may move
    std::uint32_t carrier = none;    // the kinematic body that takes it along from there on
    std::uint32_t met = none;        // whom it meets there, if that is known
};

/// How deep (m) a pair that touches already is in each other; nothing for others.
using TouchDepth = std::function<std::optional<double>(std::uint32_t a, std::uint32_t b)>;

/// From manifolds ascending by body, which must outlive it.
TouchDepth touch_depth(const std::vector<Manifold>& manifolds, const std::vector<Body>& bodies);

/// The pairs that may meet in the step: looked for only where something is fast.
using FindPairs = std::function<const std::vector<BroadPhase::Pair>&()>;

/// Whether a body turns in free rotation, not by its motion's angular velocity; none: no body does.
using TurnsFreely = std::function<bool(std::uint32_t body)>;

/// The forces have done work on a body in contact as if it had moved for the whole step, by an impulse (N s) and a turn (N m s).
/// What they did on the way that it did not go, but a share of, is taken back: held up again and again it would gather all of
/// its fall's speed on the spot.
void return_work(Body& body, const Vec3& impulse, const Vec3& turn, double share);

class CcdClamp {
public:
    explicit CcdClamp(const std::vector<Body>& bodies);

    /// Whether the body goes so far in h seconds that it might pass something unseen. Where none does, there are no limits.
    bool fast(std::uint32_t body, const BodyVelocity& motion, double h) const;

    /// By body; `motions` too, bodies that do not move have zero. `any_fast`: whether any of those is. What touches already is
    /// the contact solver's, and may come a little deeper into each other: no more.
    const std::vector<CcdFraction>& limits(const FindPairs& find_pairs, const TouchDepth& touch_depth,
                                         const std::vector<Body>& bodies, const std::vector<BodyVelocity>& motions, double h,
                                         bool any_fast, const TurnsFreely& turns_freely = nullptr);

private:
    struct FastPair {
        std::uint32_t a, b;
        double overlap;   // m, that it may come to: of those that touch already
        // s, in which it goes no farther than counts as touching. What meets so soon touches, too, though its manifold, along
        // a face, may still see a gap: were it stopped there, nothing would ever resolve the collision.
        double at_once;
        double overlap_of_touching;   // m, at least
    };
    double first_touch(const FastPair& pair, const std::vector<Body>& bodies, double h);

    CcdFraction& shorten(std::uint32_t body);

    ImpactSearch search_;
    std::vector<CcdFraction> limits_;
    std::vector<std::uint32_t> shortened_;   // whose limits are not the whole step
    std::vector<double> depth_, arm_;        // m, by body; how far from the centre its points swing
    double least_thin_ = 0.0;                // m, that no pair goes past unseen
    std::vector<Trajectory> paths_, still_;   // of the bodies of fast pairs
    std::vector<FastPair> fast_;
};

}  // namespace tumble
