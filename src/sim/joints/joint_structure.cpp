#include "sim/joints/joint_structure.h"

#include "sim/joints/gear.h"

#include <Eigen/QR>

#include <algorithm>
#include <map>
#include <numeric>

namespace tumble {
namespace {

constexpr std::size_t most_rows = 600;    // of a group whose rank is found: a second or less
constexpr double dependent_share = 1e-9;  // pivots below this share of the largest are rounding of the poses

struct Group {
    std::vector<std::uint32_t> bodies;  // ascending
    std::vector<std::uint32_t> joints;  // with gears
    std::size_t loops = 0;              // joints beyond those of trees; gears form none
    std::size_t rows = 0;
};

bool is_dynamic(const std::vector<Body>& bodies, std::uint32_t i) { return i != Joint::world && bodies[i].dynamic(); }

std::size_t locked_rows(const Joint& joint) {
    std::size_t rows = joint.gear();
    for (std::size_t k = 0; k < joint.count(); ++k) rows += joint.locked(k);
    return rows;
}

std::vector<Group> groups_of(const JointSet& joints, const std::vector<Body>& bodies) {
    // Of all joints; and of those that are no gears, with one node for all that is fixed.
    std::vector<std::uint32_t> parent(bodies.size()), tree(bodies.size() + 1);
    std::iota(parent.begin(), parent.end(), 0u);
    std::iota(tree.begin(), tree.end(), 0u);
    const auto root_in = [](std::vector<std::uint32_t>& of, std::uint32_t i) {
        while (of[i] != i) i = of[i] = of[of[i]];
        return i;
    };
    const auto root = [&](std::uint32_t i) { return root_in(parent, i); };
    for (const BodyPair& pair : joints.pairs())
        if (is_dynamic(bodies, pair.a) && is_dynamic(bodies, pair.b)) parent[root(pair.a)] = root(pair.b);
    const auto closes_loop = [&](const Joint& joint) {
        const auto node = [&](std::uint32_t i) {
            return root_in(tree, is_dynamic(bodies, i) ? i : std::uint32_t(bodies.size()));
        };
        const std::uint32_t a = node(joint.a), b = node(joint.b);
        tree[a] = b;
        return a == b;
    };
    std::map<std::uint32_t, Group> groups;
    for (const std::uint32_t k : joints.active()) {
        const Joint& joint = joints.joints()[k];
        const bool a = is_dynamic(bodies, joint.a), b = is_dynamic(bodies, joint.b);
        if (!a && !b) continue;
        Group& group = groups[root(a ? joint.a : joint.b)];
        group.joints.push_back(k);
        group.rows += locked_rows(joint);
        if (!joint.gear()) group.loops += closes_loop(joint);
        if (a) group.bodies.push_back(joint.a);
        if (b) group.bodies.push_back(joint.b);
    }
    std::vector<Group> list;
    for (auto& [first, group] : groups) {
        std::sort(group.bodies.begin(), group.bodies.end());
        group.bodies.erase(std::unique(group.bodies.begin(), group.bodies.end()), group.bodies.end());
        list.push_back(std::move(group));
    }
    return list;
}

// Rank of the rows of the locked coordinates over the velocities of the group's bodies.
std::size_t rank_of(const Group& group, const JointSet& joints, const std::vector<Body>& bodies) {
    if (group.rows == 0) return 0;
    double length = 0.0;  // m, that scales angular velocities
    for (const std::uint32_t i : group.bodies) length += bodies[i].radius / double(group.bodies.size());
    Eigen::MatrixXd matrix = Eigen::MatrixXd::Zero(Eigen::Index(group.rows), Eigen::Index(6 * group.bodies.size()));
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

JointReport describe_joints(const JointSet& joints, const std::vector<Body>& bodies) {
    JointReport report;
    for (const Group& group : groups_of(joints, bodies)) {
        const std::size_t columns = 6 * group.bodies.size();
        const bool small = group.rows <= most_rows;
        const std::size_t rank = small ? rank_of(group, joints, bodies) : std::min(group.rows, columns);
        report.bodies += group.bodies.size();
        report.degrees_of_freedom += columns - rank;
        ++report.groups;
        report.trees += group.loops == 0;
        report.loops += group.loops;
        report.rows += group.rows;
        report.redundant += group.rows - rank;
        report.counted = report.counted && small;
    }
    find_extremes(joints, bodies, report);
    return report;
}

}  // namespace tumble
