#include "sim/articulation/island_flight.h"

#include "core/disjoint_sets.h"
#include "sim/articulation/settings.h"
#include "sim/contact/model/contact_constraint.h"
#include "sim/dynamics/integrator.h"
#include "sim/joints/settings.h"

#include <algorithm>
#include <cmath>

namespace tumble {

double IslandFlight::Group::length(const FlightStep& step) const {
    double sum = 0.0;
    for (const std::uint32_t i : bodies) sum += step.bodies[i].radius / double(bodies.size());
    return sum;
}

// Groups of the island's bodies that joints connect.
void IslandFlight::find_groups(const FlightStep& step) {
    JointSet& set = step.joints;
    const auto joint = [&](std::uint32_t k) -> Joint& { return set.joints()[set.active()[k]]; };
    std::vector<std::uint32_t> held;
    for (const std::uint32_t k : step.held)
        if (!joint(k).broken) held.push_back(k);
    if (held == found_held_ && std::ranges::equal(step.island, found_for_)) return;
    found_for_.assign(step.island.begin(), step.island.end());
    found_held_ = held;
    constexpr std::size_t none = SIZE_MAX;
    const auto place = [&](std::uint32_t body) {
        const auto found = std::lower_bound(step.island.begin(), step.island.end(), body);
        return found != step.island.end() && *found == body ? std::size_t(found - step.island.begin()) : none;
    };
    DisjointSets sets(step.island.size());
    for (const std::uint32_t k : held) {
        const std::size_t a = place(joint(k).a), b = place(joint(k).b);
        if (a != none && b != none) sets.join(a, b);
    }
    groups_.assign(step.island.size(), {});
    for (const std::uint32_t k : held) {
        const std::size_t a = place(joint(k).a);
        Group& group = groups_[sets.root(a == none ? place(joint(k).b) : a)];
        group.held.push_back(k);
        group.joints.push_back(&joint(k));
    }
    for (std::size_t i = 0; i < step.island.size(); ++i) {
        Group& group = groups_[sets.root(i)];
        if (group.held.empty()) continue;
        group.bodies.push_back(step.island[i]);
        group.places.push_back(i);
    }
    std::erase_if(groups_, [](const Group& group) { return group.held.empty(); });
}

// Fine integrators find the limits; where rounding stops them, compositions of Verlet's method fly. By that method a
// step that meets a limit is flown again by the method of Runge and Kutta.
TreeFlight::Outcome IslandFlight::fly_part(const FlightStep& step, const Group& group, double from, double to,
                                           int& substeps) {
    using Outcome = TreeFlight::Outcome;
    TreeStep part{step.bodies, group.bodies, group.joints,       step.forces,
                  from,        to - from,    group.length(step), step.to - step.from};
    part.all = step.joints.joints();
    part.late = from != step.from;
    const TreeMethod method = tree_method(step.bodies, group.bodies);
    Outcome outcome = Outcome::declined;
    if (!method.verlet()) {
        outcome = tree_.advance(part, method, substeps);
        if (outcome != Outcome::declined || !tree_.is_tree()) return outcome;
        return tree_.advance(part, {IntegratorKind::splitting, method.order}, substeps);
    }
    const auto any = [&](bool (*is)(const Joint&)) {
        return std::any_of(group.joints.begin(), group.joints.end(), [&](const Joint* joint) { return is(*joint); });
    };
    const auto fly_to_limits = [&] {
        part.most_steps = tuning::tree_few_steps;
        return tree_.advance(part, {IntegratorKind::runge_kutta_4, method.order}, substeps);
    };
    const bool rests = any(at_limit), may_meet = !rests && any(limited);
    if (rests && (outcome = fly_to_limits()) != Outcome::declined) return outcome;
    std::vector<RigidState> states;
    std::vector<std::array<double, Joint::coordinates>> values;
    if (may_meet) {
        for (const std::uint32_t i : group.bodies) states.push_back(state_of(step.bodies[i]));
        for (const Joint* joint : group.joints) values.push_back(joint->value);
    }
    outcome = tree_.advance(part, method, substeps);
    if (!may_meet || outcome == Outcome::flown || !tree_.is_tree()) return outcome;
    for (std::size_t k = 0; k < states.size(); ++k) set_state(step.bodies[group.bodies[k]], states[k]);
    for (std::size_t k = 0; k < values.size(); ++k) {
        group.joints[k]->value = values[k];
        group.joints[k]->broken = false;
    }
    return fly_to_limits();
}

// Moves the bodies of one group through all parts, and adds up the accounts of its joints.
bool IslandFlight::fly(const FlightStep& step, const Group& group, int parts) {
    const double h = (step.to - step.from) / parts;
    int substeps = 1;
    for (const Joint* joint : group.joints) substeps = std::max(substeps, (joint->substeps + parts - 1) / parts);
    std::vector<JointAccount::Span> sums(parts > 1 ? group.joints.size() : 0);
    std::vector<Body> before;
    for (int part = 0; part < parts; ++part) {
        const double from = step.from + part * h, to = part + 1 == parts ? step.to : from + h;
        before.clear();
        if (!step.near.empty())
            for (const std::uint32_t i : group.bodies) before.push_back(step.bodies[i]);
        if (fly_part(step, group, from, to, substeps) != TreeFlight::Outcome::flown) return false;
        for (std::size_t k = 0; k < before.size(); ++k)
            paths_.add(group.places[k], part, before[k], step.bodies[group.bodies[k]]);
        for (std::size_t k = 0; k < sums.size(); ++k) {
            sums[k].add(group.joints[k]->account.step);
            if (group.joints[k]->broken && part + 1 < parts) return false;  // a change of groups within the step
        }
    }
    for (std::size_t k = 0; k < sums.size(); ++k) {
        Joint& joint = *group.joints[k];
        joint.account.step = sums[k];
        joint.force = sums[k].reaction.force / (step.to - step.from);
        joint.torque = sums[k].reaction.torque / (step.to - step.from);
    }
    set_substeps(group, substeps * parts);
    return true;
}

// The number of substeps of the next step. The phase of a swing is proportional to the length of a substep.
void IslandFlight::set_substeps(const Group& group, int substeps) const {
    const int wait = tree_.strains_energy() ? tuning::joint_wait : std::max(0, group.joints[0]->wait - 1);
    if (wait == 0 && tree_.phase() < tuning::joint_easy_phase && substeps > 1) {
        substeps /= 2;
        for (double phase = 4.0 * tree_.phase(); substeps > 1 && phase < tuning::joint_easy_phase; phase *= 2.0)
            substeps /= 2;
    }
    for (Joint* joint : group.joints) {
        joint->substeps = substeps;
        joint->wait = wait;
    }
}

bool IslandFlight::fly(const FlightStep& step) {
    find_groups(step);
    std::vector<Body>& bodies = step.bodies;
    const double h = step.to - step.from;
    starts_.clear();
    values_.clear();
    double fastest = 0.0;  // rad/s
    for (const std::uint32_t i : step.island) {
        starts_.push_back(state_of(bodies[i]));
        fastest = std::max(fastest, bodies[i].angular_velocity.norm());
    }
    for (const Group& group : groups_)
        for (const Joint* joint : group.joints) values_.push_back(joint->value);
    for (const std::uint32_t i : step.island) {  // others move as if alone
        if (bodies[i].jointed) continue;
        const Wrench wrench = step.forces.throughout(i, bodies[i], step.from, step.to);
        advance_momenta(bodies[i], wrench.force, wrench.torque, h);
        bodies[i].derive_velocities();
    }
    int parts = 1;
    if (!step.near.empty()) {
        parts = int(std::clamp(std::ceil(h * fastest / tuning::flight_turn), 1.0, tuning::flight_most_parts));
        paths_.start(bodies, step.island, parts, h);
    }
    bool flown = !groups_.empty();
    for (std::size_t g = 0; flown && g < groups_.size(); ++g) flown = fly(step, groups_[g], parts);
    flown = flown && (step.near.empty() || !paths_.any_meet(bodies, step.manifolds, step.near));
    ends_.clear();
    for (std::size_t k = 0; k < step.island.size(); ++k) {
        Body& body = bodies[step.island[k]];
        ends_.push_back(state_of(body));
        set_state(body, starts_[k]);
    }
    if (flown) return true;
    const auto* value = values_.data();
    for (const Group& group : groups_)
        for (Joint* joint : group.joints) {
            joint->value = *value++;
            joint->impulse = {};
            joint->force.setZero();
            joint->torque.setZero();
            joint->broken = false;
        }
    return false;
}

}  // namespace tumble
