// TreeFlight: the rest of a step in which a joint breaks.
#include "core/disjoint_sets.h"
#include "sim/articulation/settings.h"
#include "sim/articulation/tree_flight.h"
#include "sim/joints/gear.h"

#include <algorithm>

namespace tumble {
namespace {

struct Piece {
    std::vector<std::uint32_t> bodies;  // ascending
    std::vector<Joint*> joints;
};

// Bodies that joints still connect.
std::vector<Piece> pieces_of(const TreeStep& step) {
    const std::size_t n = step.island.size();
    DisjointSets sets(n);
    const auto place_of = [&](std::uint32_t body) {
        const auto at = std::lower_bound(step.island.begin(), step.island.end(), body);
        return at != step.island.end() && *at == body ? std::size_t(at - step.island.begin()) : n;
    };
    const auto holds = [&](const Joint& joint) {
        return !joint.broken && (!joint.gear() || gear_holds(joint, step.all));
    };
    for (const Joint* joint : step.joints) {
        const std::size_t a = place_of(joint->a), b = place_of(joint->b);
        if (!holds(*joint) || a == n || b == n) continue;
        sets.join(a, b);
    }
    std::vector<Piece> pieces(n);
    for (std::size_t i = 0; i < n; ++i) pieces[sets.root(i)].bodies.push_back(step.island[i]);
    for (Joint* joint : step.joints) {
        const std::size_t a = place_of(joint->a);
        if (holds(*joint)) pieces[sets.root(a == n ? place_of(joint->b) : a)].joints.push_back(joint);
    }
    std::erase_if(pieces, [](const Piece& piece) { return piece.bodies.empty(); });
    return pieces;
}

}  // namespace

TreeFlight::Outcome TreeFlight::advance(const TreeStep& step, TreeMethod method, int& substeps) {
    const Outcome outcome = advance_tree(step, method, substeps);
    if (outcome != Outcome::flown || event_ == none) return outcome;
    return advance_pieces(step, method, substeps, weak_[event_ - first_weak()]);
}

// After the part up to the break.
TreeFlight::Outcome TreeFlight::advance_pieces(const TreeStep& step, TreeMethod method, int& substeps, int broken) {
    const double now = time_;
    Joint& weak = *step.joints[std::size_t(broken)];
    weak.broken = true;
    weak.broken_at = step.from + now;
    if (!(step.h - now > tuning::tree_least_rest * step.h)) return Outcome::flown;
    std::vector<JointAccount::Span> spans;
    for (const Joint* joint : step.joints) spans.push_back(joint->account.step);
    int evaluations = evaluations_;
    for (const Piece& piece : pieces_of(step)) {
        const TreeStep rest{step.bodies,     piece.bodies, piece.joints, step.forces,
                            step.from + now, step.h - now, step.length,  step.whole > 0.0 ? step.whole : step.h,
                            step.most_steps, step.all,     true};
        if (advance(rest, method, substeps) != Outcome::flown) return Outcome::stopped;
        evaluations += evaluations_;
    }
    evaluations_ = evaluations;
    for (std::size_t k = 0; k < spans.size(); ++k) {
        Joint& joint = *step.joints[k];
        if (!joint.broken || joint.broken_at > weak.broken_at) joint.account.step.add(spans[k]);
        joint.force = joint.account.step.reaction.force / step.h;
        joint.torque = joint.account.step.reaction.torque / step.h;
    }
    return Outcome::flown;
}

}  // namespace tumble
