#include "sim/step/load_watch.h"

#include "sim/fracture/breakable_bodies.h"
#include "sim/joints/joint_set.h"
#include "sim/step/step_context.h"

#include <algorithm>
#include <cmath>

namespace tumble {
namespace {

/// The rest of a margin falls by this times a change of the loads: see Margin.
constexpr double with_sum = 1.01;

/// Bound of the rounding of a sum of loads, over the sum. Not fitted: thousands of times one rounding.
constexpr double rounding = 1e-12;

/// N: a rotation of less may round to no load.
constexpr double smallest_own = 1e-250;

// At least the Euclidean and the Frobenius norm, without a root.
template <class Values>
double bound(const Values& values) {
    return values.cwiseAbs().sum();
}

double own_load(const Body& body, double spin, const Vec3& gravity) {
    return body.dynamic() ? body.mass * body.radius * spin : gravity.norm();
}

}  // namespace

void LoadWatch::note(std::span<const Manifold> manifolds, const StepContext& step, const BreakableBodies& breakables,
                     std::span<const Margin> margins) {
    const std::vector<Body>& bodies = step.set.bodies;
    const auto breakable = [&](std::uint32_t i) { return i != Joint::world && bodies[i].breakable; };
    noted_ = false;
    for (const std::uint32_t i : step.forces.field().pushed())
        if (breakable(i)) return;
    for (const Joint& joint : step.joints.joints())
        if (breakable(joint.a) || breakable(joint.b)) return;

    margins_.assign(margins.begin(), margins.end());
    pieces_.clear();
    places_.assign(bodies.size(), none);
    for (std::uint32_t entry = 0; entry < breakables.size(); ++entry) {
        Margin& margin = margins_[entry];
        double far = 0.0;
        for (const std::uint32_t i : breakables[entry].pieces()) {
            const Body& body = bodies[i];
            if (!body.breakable || !breakables[entry].may_break(i)) continue;
            const double spin = body.angular_velocity.squaredNorm();
            places_[i] = std::uint32_t(pieces_.size());
            pieces_.push_back({i, entry, body.asleep, body.position, body.rotation, spin,
                               own_load(body, spin, step.settings.gravity), bound(body.center_of_mass)});
            far = std::max(far, body.position.norm());
        }
        margin.rest -= rounding * margin.sum * (1.0 + far / margin.size);
    }
    touches_.clear();
    for (const Manifold& m : manifolds) {
        if (!bodies[m.a].breakable && !bodies[m.b].breakable) continue;
        Touch t{m.a,
                m.b,
                {places_[m.a], places_[m.b]},
                {0.0, 0.0},
                m.count,
                m.normal,
                m.tangent,
                {},
                {},
                0.0,
                m.friction[0],
                m.friction[1],
                m.torsion};
        for (std::size_t i = 0; i < std::size_t(m.count); ++i) {
            t.points[i] = m.points[i].position;
            t.impulses[i] = m.points[i].impulse;
            t.sum += m.points[i].impulse;
            for (const std::size_t side : {0, 1})
                if (t.on[side] != none)
                    t.reach[side] = std::max(t.reach[side], (t.points[i] - bodies[side ? m.b : m.a].origin()).norm());
        }
        touches_.push_back(t);
    }
    h_ = step.h;
    noted_ = true;
}

bool LoadWatch::quiet(std::span<const Manifold> manifolds, const StepContext& step) {
    if (!noted_ || step.h != h_) return false;
    const std::vector<Body>& bodies = step.set.bodies;
    drift_.assign(margins_.size(), 0.0);
    for (Piece& p : pieces_) {
        const Body& body = bodies[p.body];
        if (body.asleep != p.asleep) return false;
        if (p.asleep) continue;
        p.turned = bound(body.rotation - p.rotation);
        p.shifted = bound(body.position - p.position) + p.turned * p.center;
        const double spin = body.angular_velocity.squaredNorm();
        double change = p.turned * p.own;
        if (body.dynamic()) {
            const double own = own_load(body, spin, step.settings.gravity);
            if ((spin > 0.0) != (p.spin > 0.0) || (spin > 0.0 && std::min(own, p.own) < smallest_own)) return false;
            change = own + p.own;
        }
        drift_[p.entry] += with_sum * change;
    }
    std::size_t next = 0;
    const double rate = 1.0 / step.h;
    for (const Manifold& m : manifolds) {
        if (!bodies[m.a].breakable && !bodies[m.b].breakable) continue;
        if (next == touches_.size() || !add(m, touches_[next++], rate)) return false;
    }
    if (next != touches_.size()) return false;
    for (std::size_t entry = 0; entry < drift_.size(); ++entry)
        if (!(drift_[entry] <= margins_[entry].rest)) return false;
    return true;
}

// Adds the bound of the change to the drift; false if the loads are others.
bool LoadWatch::add(const Manifold& now, const Touch& then, double rate) {
    if (now.a != then.a || now.b != then.b || now.count != then.count) return false;
    double pressed = 0.0, moved = 0.0, sum = 0.0;
    for (std::size_t i = 0; i < std::size_t(now.count); ++i) {
        const ContactPoint& p = now.points[i];
        if (p.impulse < 0.0) return false;
        pressed += std::abs(p.impulse - then.impulses[i]);
        moved = std::max(moved, bound(p.position - then.points[i]));
        sum += p.impulse;
    }
    if ((sum > 0.0) != (then.sum > 0.0)) return false;
    if (!(sum > 0.0)) return true;
    const double tilted = bound(now.normal - then.normal), turned = bound(now.tangent - then.tangent);
    const double slip = std::abs(then.friction0) + std::abs(then.friction1), torsion = std::abs(then.torsion);
    const double force = pressed + then.sum * tilted + std::abs(now.friction[0] - then.friction0) +
                         std::abs(now.friction[1] - then.friction1) + slip * (tilted + turned);
    const double torque = std::abs(now.torsion - then.torsion) + torsion * tilted;
    const double all = sum + std::abs(now.friction[0]) + std::abs(now.friction[1]);
    for (const std::size_t side : {0, 1}) {
        if (then.on[side] == none) continue;
        const Piece& piece = pieces_[then.on[side]];
        if (piece.asleep) continue;
        const Margin& margin = margins_[piece.entry];
        // Friction acts at the mean of the points by their impulses, which moves by their changes too.
        const double way =
            moved + 2.0 * then.reach[side] * pressed / sum + piece.shifted + piece.turned * then.reach[side];
        drift_[piece.entry] += rate * ((with_sum + margin.moved) * (force + piece.turned * (then.sum + slip)) +
                                       (with_sum * (torque + piece.turned * torsion) + all * way) / margin.size);
    }
    return true;
}

}  // namespace tumble
