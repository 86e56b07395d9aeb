// DirectSolver: the flight of joined bodies past others that are within reach but not in contact. It stands where no pair
// meets on its way; else the bodies are set back and the step is solved with the contacts.
#include "core/disjoint_sets.h"
#include "sim/contact/direct/direct_solver.h"
#include "sim/contact/direct/settings.h"
#include "sim/dynamics/integrators/gyroscopic_correction.h"
#include "sim/geometry/contact_tolerance.h"

#include <algorithm>
#include <cmath>

namespace tumble {
namespace {

struct Group {
    std::vector<std::uint32_t> bodies, joints;  // as of a JointIsland
    std::vector<std::size_t> places;            // of the bodies, in the island
};

// Groups of the island's bodies that joints connect.
std::vector<Group> groups_of(const JointIsland& island) {
    const JointSet& set = *island.problem.joints;
    DisjointSets sets(island.bodies.size());
    const auto place = [&](std::uint32_t body) { return contact_rows::place_of(island.bodies, body); };
    const auto each_pair = [&](auto&& visit) {
        for (const std::uint32_t k : island.joints) {
            const Joint& joint = set.joints()[set.active()[k]];
            const int a = place(joint.a), b = place(joint.b);
            if (!joint.broken) visit(k, a == contact_rows::none ? b : a, b == contact_rows::none ? a : b);
        }
    };
    each_pair([&](std::uint32_t, int a, int b) { sets.join(std::size_t(a), std::size_t(b)); });
    std::vector<Group> groups(island.bodies.size());
    each_pair([&](std::uint32_t k, int a, int) { groups[sets.root(std::size_t(a))].joints.push_back(k); });
    for (std::size_t i = 0; i < island.bodies.size(); ++i) {
        Group& group = groups[sets.root(i)];
        if (group.joints.empty()) continue;
        group.bodies.push_back(island.bodies[i]);
        group.places.push_back(i);
    }
    std::erase_if(groups, [](const Group& group) { return group.joints.empty(); });
    return groups;
}

}  // namespace

bool DirectSolver::fly_part(const JointIsland& group, int& substeps) {
    if (find_flying(group)) {
        const TreeFlight::Outcome outcome = advance_tree(group, substeps);
        swing_ = tree_flight_.swing();
        if (outcome == TreeFlight::Outcome::flown) return true;
        if (tree_flight_.is_tree()) return false;
    }
    return JointFlight::flies(group) && fly(group, substeps);
}

// Moves the bodies of one group through all parts, and adds up the accounts of its joints.
bool DirectSolver::fly_parts(const JointIsland& group, std::span<const std::size_t> places, int parts, int& substeps) {
    std::vector<Body>& bodies = group.problem.bodies;
    ConstraintSettings settings = group.problem.settings;
    settings.h /= parts;
    const ContactProblem problem{bodies,  group.problem.manifolds, group.problem.before, settings,
                                 nullptr, group.problem.joints,    group.problem.forces};
    std::vector<Joint*> joints;
    for (const std::uint32_t k : group.joints) joints.push_back(&problem.joints->joints()[problem.joints->active()[k]]);
    std::vector<JointAccount::Span> sums(joints.size());
    const std::vector<Start> starts = starts_;  // of the step
    std::vector<Body> before;
    for (int part = 0; part < parts; ++part) {
        const double from = group.from + part * settings.h;
        const JointIsland now{problem,      group.bodies, group.joints,
                              group.length, from,         part + 1 == parts ? group.to : from + settings.h};
        before.clear();
        for (std::size_t k = 0; k < places.size(); ++k) {
            Body& body = bodies[group.bodies[k]];
            const Start& whole = starts[k];
            const Vec3 push = whole.push / parts, turn = whole.turn / parts;
            if (part == 0)
                set_state(body, {whole.position, whole.orientation, whole.momentum - whole.push,
                                 whole.angular_momentum - whole.turn});
            before.push_back(body);
            starts_[k] = {body.position,
                          body.momentum + push,
                          body.angular_momentum + turn,
                          body.orientation,
                          body.rotation,
                          push,
                          turn};
        }
        if (!fly_part(now, substeps)) return false;
        for (std::size_t k = 0; k < places.size(); ++k) paths_.add(places[k], part, before[k], bodies[group.bodies[k]]);
        for (std::size_t k = 0; k < joints.size(); ++k) {
            sums[k].add(joints[k]->account.step);
            if (joints[k]->broken && part + 1 < parts) return false;  // a change of groups within the step
        }
    }
    for (std::size_t k = 0; k < joints.size(); ++k) {
        joints[k]->account.step = sums[k];
        joints[k]->force = sums[k].load.force / group.problem.settings.h;
        joints[k]->torque = sums[k].load.torque / group.problem.settings.h;
    }
    return true;
}

bool DirectSolver::none_touch(const ContactProblem& problem, std::span<const std::uint32_t> manifolds) {
    return std::none_of(manifolds.begin(), manifolds.end(), [&](std::uint32_t k) {
        const Manifold& m = problem.manifolds[k];
        const double touch = touch_distance(problem.bodies[m.a].radius, problem.bodies[m.b].radius);
        return std::any_of(m.points.begin(), m.points.begin() + m.count,
                           [&](const ContactPoint& p) { return p.separation <= touch; });
    });
}

bool DirectSolver::flies_past(const JointIsland& island, std::span<const std::uint32_t> manifolds) {
    std::vector<Body>& bodies = island.problem.bodies;
    const double h = island.problem.settings.h;
    double fastest = 0.0;  // rad/s
    for (const std::uint32_t i : island.bodies) fastest = std::max(fastest, bodies[i].angular_velocity.norm());
    const int parts = int(std::clamp(std::ceil(h * fastest / tuning::flight_turn), 1.0, tuning::flight_most_parts));
    paths_.start(bodies, island.bodies, parts, h);
    const std::vector<Start> starts = starts_;
    bool flown = true;
    for (const Group& group : groups_of(island)) {
        double length = 0.0;
        for (const std::uint32_t i : group.bodies) length += bodies[i].radius / double(group.bodies.size());
        const JointIsland part{island.problem, group.bodies, group.joints, length, island.from, island.to};
        starts_.clear();
        for (const std::size_t place : group.places) starts_.push_back(starts[place]);
        std::vector<Joint*> joints;
        for (const std::uint32_t k : group.joints)
            joints.push_back(&island.problem.joints->joints()[island.problem.joints->active()[k]]);
        int substeps = 1;
        for (const Joint* joint : joints) substeps = std::max(substeps, (joint->substeps + parts - 1) / parts);
        flown = fly_parts(part, group.places, parts, substeps);
        if (!flown) break;
        for (Joint* joint : joints) joint->substeps = next_substeps(true, substeps * parts);
    }
    starts_ = starts;
    if (!flown || paths_.any_meet(bodies, island.problem.manifolds, manifolds)) return false;
    for (const std::uint32_t k : manifolds) {
        release(island.problem.manifolds[k]);
        island.problem.manifolds[k].solved_by = SolvedBy::flight;
    }
    return true;
}

}  // namespace tumble
