#include "sim/joints/joint_structure.h"

#include "core/disjoint_sets.h"
#include "sim/joints/gear.h"
#include "sim/joints/joint_groups.h"
#include "sim/joints/settings.h"
#include "sim/joints/spanning_joints.h"

#include <Eigen/QR>

#include <algorithm>

namespace tumble {
namespace {

constexpr std::size_t most_rows = 600;    // of a group whose rank is found: a second or less
constexpr double dependent_share = 1e-9;  // pivots below this share of the largest are rounding of the poses

bool is_dynamic(const std::vector<Body>& bodies, std::uint32_t i) { return i != Joint::world && bodies[i].dynamic(); }

std::size_t locked_rows(const Joint& joint) {
    std::size_t rows = joint.gear();
    for (std::size_t k = 0; k < joint.count(); ++k) rows += joint.locked(k);
    return rows;
}

std::size_t locked_rows(const JointGroup& group, const JointSet& joints) {
    std::size_t rows = 0;
    for (const std::uint32_t k : group.joints) rows += locked_rows(joints.joints()[k]);
    return rows;
}

// Joints beyond the spanning trees, with one node for all that is fixed; gears form none.
std::size_t loops_of(const JointGroup& group, const JointSet& joints, const std::vector<Body>& bodies) {
    const std::size_t fixed = group.bodies.size();
    DisjointSets sets(fixed + 1);
    const auto node = [&](std::uint32_t body) {
        if (!is_dynamic(bodies, body)) return fixed;
        return std::size_t(std::lower_bound(group.bodies.begin(), group.bodies.end(), body) - group.bodies.begin());
    };
    std::size_t loops = 0;
    for (const std::uint32_t k : group.joints) {
        const Joint& joint = joints.joints()[k];
        if (!joint.gear()) loops += !sets.join(node(joint.a), node(joint.b));
    }
    return loops;
}

// Rank of the rows of the locked coordinates over the velocities of the group's bodies.
std::size_t rank_of(const JointGroup& group, const JointSet& joints, const std::vector<Body>& bodies) {
    const std::size_t rows = locked_rows(group, joints);
    if (rows == 0) return 0;
    double length = 0.0;  // m, that scales angular velocities
    for (const std::uint32_t i : group.bodies) length += bodies[i].radius / double(group.bodies.size());
    Eigen::MatrixXd matrix = Eigen::MatrixXd::Zero(Eigen::Index(rows), Eigen::Index(6 * group.bodies.size()));
    Eigen::Index row = 0;
    const auto add_coordinate = [&](const Joint& joint, const JointGeometry& g, std::size_t k, double factor) {
        const Vec3 n = factor * g.coordinates[k].direction;
        for (const auto& [body, sign] : {std::pair(joint.a, -1.0), std::pair(joint.b, 1.0)}) {
            if (!is_dynamic(bodies, body)) continue;
            const auto place = std::lower_bound(group.bodies.begin(), group.bodies.end(), body);
            const Eigen::Index at = 6 * (place - group.bodies.begin());
            const Vec3 arm = g.point - bodies[body].position;
            if (k < 3) matrix.block<1, 3>(row, at) += sign * n.transpose();
            matrix.block<1, 3>(row, at + 3) += sign * (k < 3 ? Vec3(arm.cross(n) / length) : n).transpose();
        }
    };
    for (const std::uint32_t index : group.joints) {
        const Joint& joint = joints.joints()[index];
        if (joint.gear()) {
            for (std::size_t s = 0; s < 2; ++s) {
                const Joint& of = joints.joints()[joint.description.geared[s]];
                const std::size_t k = geared_coordinate(of);
                const double factor = (s == 0 ? 1.0 : joint.description.ratio) / (k < 3 ? 1.0 : length);
                add_coordinate(of, measure(of, side_of(bodies, of.a), side_of(bodies, of.b)), k, factor);
            }
            ++row;
            continue;
        }
        const JointGeometry g = measure(joint, side_of(bodies, joint.a), side_of(bodies, joint.b));
        for (std::size_t k = 0; k < joint.count(); ++k) {
            if (!joint.locked(k)) continue;
            add_coordinate(joint, g, k, 1.0);
            ++row;
        }
    }
    Eigen::ColPivHouseholderQR<Eigen::MatrixXd> qr(matrix.transpose());
    qr.setThreshold(dependent_share);
    return std::size_t(qr.rank());
}

void find_extremes(const JointSet& joints, const std::vector<Body>& bodies, JointReport& report) {
    const std::vector<JointState> states = joints.states(bodies);
    for (const std::uint32_t k : joints.active()) {
        const Joint& joint = joints.joints()[k];
        if (states[k].gap > report.gap) {
            report.gap = states[k].gap;
            report.widest = k;
        }
        if (joint.gear() || !is_dynamic(bodies, joint.a) || !is_dynamic(bodies, joint.b)) continue;
        const double a = bodies[joint.a].mass, b = bodies[joint.b].mass, ratio = std::max(a / b, b / a);
        if (!report.heaviest || ratio > report.mass_ratio) {
            report.mass_ratio = ratio;
            report.heaviest = k;
        }
    }
}

}  // namespace

JointReport describe_joints(const JointSet& joints, const std::vector<Body>& bodies, SweepRule rule) {
    JointReport report;
    for (const JointGroup& group : find_joint_groups(joints, bodies)) {
        const std::size_t rows = locked_rows(group, joints), loops = loops_of(group, joints, bodies);
        const std::size_t columns = 6 * group.bodies.size();
        const bool small = rows <= most_rows;
        const std::size_t rank = small ? rank_of(group, joints, bodies) : std::min(rows, columns);
        report.bodies += group.bodies.size();
        report.degrees_of_freedom += columns - rank;
        ++report.groups;
        report.trees += loops == 0;
        report.loops += loops;
        report.rows += rows;
        report.redundant += rows - rank;
        const MechanismFacts facts = facts_of(group, joints, bodies, rule);
        ++report.in_flight[std::size_t(choose_way(facts, {}))];
        ++report.in_contact[std::size_t(choose_way(facts, {.within_reach = true, .touching = true}))];
        report.figures += facts.figures;
        report.counted = report.counted && small;
    }
    if (report.figures >= tuning::figures_swept) report.crowd = tuning::figures_swept;
    find_extremes(joints, bodies, report);
    return report;
}

}  // namespace tumble
