#include "sim/ccd/ccd_clamp.h"

#include "sim/ccd/settings.h"
#include "sim/geometry/contact_tolerance.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <span>
#include <tuple>

namespace tumble {
namespace {

/// A pair is also checked (beside tuning::fast_share) if it moves by more than this share of the smaller inner radius:
/// an unchecked body overlaps by as much for a step. Related test: ThinWall.APlaneStopsThinBodiesAsABoxDoes.
constexpr double fast_deepest = 0.9;

/// Bodies that touch when the step begins may overlap by the first share of the radius, or by the second more than
/// they do: the contact solver leaves small approaches, which must not stop fast bodies. Related tests:
/// ThinWall.SlidingBodiesAreStopped and ThinWall.ARackIsBroken.
constexpr double fast_overlap = 0.05;
constexpr double fast_deeper = 0.01;

/// Rounds in which bodies that stop each other are checked again. Not fitted: beyond them all stop with the first.
/// Related test: ThinWall.BodiesDoNotPassThroughEachOther.
constexpr int ccd_rounds = 8;

double depth(const Body& body) { return depth(body.collider); }

bool ball(const Body& body) { return std::holds_alternative<Ball>(body.collider); }

bool mesh(const Body& body) { return contact_surface(body.collider) == ContactSurface::triangles; }

// Only the center of a ball counts; the arm of a body that cannot rotate may be infinite.
double turning(double arm, const BodyVelocity& motion) {
    return arm == 0.0 || motion.angular_velocity.isZero(0.0) ? 0.0 : motion.angular_velocity.norm() * arm;
}

// Relative motion (m) below which two bodies of these depths cannot pass each other undetected. An overlap below both
// inner radii together is pushed out of the correct side; against a mesh, whose depth is infinite, below the other
// body's own. No visible overlap may exceed it either.
double thin(double depth_a, double depth_b) {
    const double least = std::min(depth_a, depth_b), most = std::max(depth_a, depth_b);
    return std::min(tuning::fast_share * (std::isinf(most) ? least : depth_a + depth_b), fast_deepest * least);
}

std::span<const Manifold> manifolds_of(const std::vector<Manifold>& manifolds, std::uint32_t a, std::uint32_t b) {
    const auto before = [](const Manifold& m, const std::pair<std::uint32_t, std::uint32_t>& pair) {
        return std::tie(m.a, m.b) < std::tie(pair.first, pair.second);
    };
    const auto first = std::lower_bound(manifolds.begin(), manifolds.end(), std::pair(a, b), before);
    auto last = first;
    while (last != manifolds.end() && last->a == a && last->b == b) ++last;
    return std::span(manifolds).subspan(std::size_t(first - manifolds.begin()), std::size_t(last - first));
}

}  // namespace

void return_work(Body& body, const Vec3& impulse, const Vec3& turn, double share) {
    const double work = (1.0 - share) * (impulse.dot(body.velocity) + turn.dot(body.angular_velocity));
    if (!(work > 0.0)) return;
    const double energy = body.kinetic_energy();
    const double scale = std::sqrt(std::max(0.0, 1.0 - work / energy));
    body.momentum *= scale;
    body.angular_momentum *= scale;
    body.derive_velocities();
}

// Time of the first touch in the step, with each body at rest once its share is used up; h if there is none.
double CcdClamp::first_touch(const FastPair& pair, const std::vector<Body>& bodies, double h) {
    const std::uint32_t i = pair.a, j = pair.b;
    const Body &a = bodies[i], &b = bodies[j];
    const double end_a = limits_[i].share * h, end_b = limits_[j].share * h, both = std::min(end_a, end_b);
    TimeOfImpact found = search_.find({&a, &paths_[i], 0.0}, {&b, &paths_[j], 0.0}, both, pair.overlap);
    if (found.kind != TimeOfImpact::Kind::none) return found.time;
    const double rest = std::max(end_a, end_b) - both;
    if (!(rest > 0.0)) return h;
    const MovingBody going_a = end_a > both ? MovingBody{&a, &paths_[i], both} : MovingBody{&a, &still_[i], 0.0};
    const MovingBody going_b = end_b > both ? MovingBody{&b, &paths_[j], both} : MovingBody{&b, &still_[j], 0.0};
    found = search_.find(going_a, going_b, rest, pair.overlap);
    return found.kind != TimeOfImpact::Kind::none ? both + found.time : h;
}

CcdClamp::CcdClamp(const std::vector<Body>& bodies)
    : limits_(bodies.size()), least_thin_(std::numeric_limits<double>::infinity()) {
    const bool meshes = std::any_of(bodies.begin(), bodies.end(), mesh);
    for (const Body& body : bodies) {
        arm_.push_back(ball(body) ? 0.0 : body.radius);
        const double of_body = depth_.emplace_back(std::isinf(body.radius) ? body.radius : depth(body));
        least_thin_ = std::min(least_thin_, thin(of_body, meshes ? std::numeric_limits<double>::infinity() : of_body));
    }
}

// A body of several pieces is as thin as the thinnest of them, which the least has seen.
void CcdClamp::measure(std::uint32_t index, const Body& body) {
    arm_[index] = ball(body) ? 0.0 : body.radius;
    depth_[index] = std::isinf(body.radius) ? body.radius : depth(body);
}

// Decided without any pair: two slower bodies move no farther than the thinnest body is thin.
bool CcdClamp::fast(std::uint32_t body, const BodyVelocity& motion, double h) const {
    return 2.0 * h * (motion.velocity.norm() + turning(arm_[body], motion)) > least_thin_;
}

CcdFraction& CcdClamp::shorten(std::uint32_t body) {
    shortened_.push_back(body);
    return limits_[body];
}

TouchDepth touch_depth(const std::vector<Manifold>& manifolds, const std::vector<Body>& bodies) {
    return [&](std::uint32_t a, std::uint32_t b) -> std::optional<double> {
        std::optional<double> deepest;
        const double touch = touch_distance(bodies[a].radius, bodies[b].radius);
        for (const Manifold& m : manifolds_of(manifolds, a, b))
            for (int i = 0; i < m.count; ++i)
                if (const double gap = m.points[std::size_t(i)].separation; gap <= touch)
                    deepest = std::max(deepest.value_or(0.0), -gap);
        return deepest;
    };
}

KnownApart known_apart(const std::vector<Manifold>& manifolds) {
    return [&](std::uint32_t a, std::uint32_t b) {
        const auto found = manifolds_of(manifolds, a, b);
        return !found.empty() && found.front().solved_by == SolvedBy::flight;
    };
}

const std::vector<CcdFraction>& CcdClamp::limits(const CcdStep& step, const FindPairs& find_pairs,
                                                 const TouchDepth& touch_depth) {
    const std::vector<Body>& bodies = step.bodies;
    const std::vector<BodyVelocity>& motions = step.motions;
    const double h = step.h;
    for (const std::uint32_t i : shortened_) limits_[i] = {};
    shortened_.clear();
    fast_.clear();
    if (!step.any_fast) return limits_;
    for (const BroadPhase::Pair& pair : find_pairs()) {
        const Body &a = bodies[pair.a], &b = bodies[pair.b];
        const double depth_a = depth_[pair.a], depth_b = depth_[pair.b];
        const BodyVelocity &of_a = motions[pair.a], &of_b = motions[pair.b];
        // Bound of the relative motion of the bodies' points in the step.
        const double gone =
            h * ((of_b.velocity - of_a.velocity).norm() + turning(arm_[pair.a], of_a) + turning(arm_[pair.b], of_b));
        const double least = std::min(depth_a, depth_b);
        // A half-space has no other side: only visible overlap counts.
        const bool half_space = std::isinf(a.radius) || std::isinf(b.radius);
        if (gone <= (half_space ? fast_deepest * least : thin(depth_a, depth_b))) continue;
        if (step.known_apart && step.known_apart(pair.a, pair.b)) continue;
        FastPair fast{pair.a, pair.b, 0.0, h * touch_distance(a.radius, b.radius) / gone, fast_overlap * least};
        if (const auto deepest = touch_depth(pair.a, pair.b)) {
            // The impact just resolved may have rotated a corner towards the other body: it is searched for like a
            // first touch.
            if (ball(a) && ball(b)) continue;  // rotation does not matter
            fast.overlap = std::max(fast.overlap_of_touching, *deepest + fast_deeper * least);
        }
        fast_.push_back(fast);
    }
    if (fast_.empty()) return limits_;

    paths_.resize(bodies.size());
    still_.resize(bodies.size());
    for (const FastPair& pair : fast_) {
        for (const std::uint32_t k : {pair.a, pair.b}) {
            paths_[k] = step.turns_freely && step.turns_freely(k)
                            ? Trajectory::drift(bodies[k], motions[k].velocity)
                            : Trajectory::uniform(bodies[k], motions[k].velocity, motions[k].angular_velocity);
            still_[k] = paths_[k];
        }
    }
    for (int round = 0; round < ccd_rounds; ++round) {
        bool shorter = false;
        for (FastPair& pair : fast_) {
            double first = first_touch(pair, bodies, h);
            if (pair.overlap == 0.0 && first <= pair.at_once) {
                pair.overlap = pair.overlap_of_touching;
                first = first_touch(pair, bodies, h);
            }
            const double share = first / h;
            for (const std::uint32_t k : {pair.a, pair.b}) {
                if (!bodies[k].dynamic() || share >= limits_[k].share) continue;
                const std::uint32_t other = k == pair.a ? pair.b : pair.a;
                shorten(k) = {share, bodies[other].track ? other : CcdFraction::none, other};
                shorter = true;
            }
        }
        if (!shorter) return limits_;
        // A body that stops earlier is an obstacle for others, where it stops.
        for (const FastPair& pair : fast_) {
            for (const std::uint32_t k : {pair.a, pair.b}) {
                Body there = bodies[k];
                const Motion end = paths_[k].at(limits_[k].share * h);
                there.position = end.position;
                there.orientation = end.orientation;
                still_[k] = Trajectory::uniform(there, Vec3::Zero(), Vec3::Zero());
            }
        }
    }
    // Without convergence all of them stop with the first, which certainly keeps them apart.
    double least = 1.0;
    for (const FastPair& pair : fast_) least = std::min({least, limits_[pair.a].share, limits_[pair.b].share});
    for (const FastPair& pair : fast_) {
        for (const std::uint32_t k : {pair.a, pair.b}) {
            if (!bodies[k].dynamic() || limits_[k].share <= least) continue;
            CcdFraction& limit = shorten(k);
            limit.share = least;
            limit.met = CcdFraction::none;
        }
    }
    return limits_;
}

}  // namespace tumble
