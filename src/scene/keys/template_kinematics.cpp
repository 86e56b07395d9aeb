#include "scene/keys/template_kinematics.h"

#include "core/deterministic_math.h"
#include "scene/keys/joint_places.h"

#include <algorithm>
#include <set>

namespace tumble {
namespace {

/// Motion of the second body of the joint relative to its first one.
RigidMotion motion_by_joint(const JointDescription& joint, const WorldJoint& world, double change) {
    if (joint.type == JointType::slider) return {Quat::Identity(), change * world.axis()};
    const SinCos half = sincos(0.5 * change);
    const Vec3 v = half.sin * world.axis();
    const Quat turn = Quat(half.cos, v.x(), v.y(), v.z()).normalized();
    return {turn, world.first - turn * world.first};
}

RigidMotion inverse(const RigidMotion& motion) {
    const Quat back = motion.rotation.conjugate();
    return {back, -(back * motion.shift)};
}

}  // namespace

WorldJoint::WorldJoint(const JointDescription& joint, const std::vector<BodyDescription>& bodies) {
    const SidePose a = start_pose(bodies, joint.first), b = start_pose(bodies, joint.second);
    first = a.point(joint.anchor_first);
    second = b.point(joint.anchor_second);
    frame_first = a.rotation * joint.frame_first;
    frame_second = b.rotation * joint.frame_second;
}

WorldJoint::WorldJoint(const WorldJoint& start, const RigidMotion& of_first, const RigidMotion& of_second)
    : first(of_first.point(start.first)),
      second(of_second.point(start.second)),
      frame_first(of_first.rotation * start.frame_first),
      frame_second(of_second.rotation * start.frame_second) {}

Quat WorldJoint::turn() const {
    Quat q = frame_first.conjugate() * frame_second;
    if (q.w() < 0.0) q.coeffs() = -q.coeffs();
    return q;
}

bool has_one_coordinate(const JointDescription& joint) {
    return joint.type == JointType::hinge || joint.type == JointType::slider;
}

double coordinate_of(const JointDescription& joint, const WorldJoint& world) {
    if (joint.type == JointType::slider) return world.apart().x();
    const Quat turn = world.turn();
    return 2.0 * atan2_stable(turn.x(), turn.w());
}

void append_errors(const JointDescription& joint, const WorldJoint& world, std::vector<double>& errors) {
    using Motion = JointAxis::Motion;
    const Vec3 apart = world.apart();
    if (joint.type == JointType::distance) {
        const double length = apart.norm();
        const JointAxis& axis = joint.move[0];
        if (axis.motion == Motion::locked) errors.push_back(length - joint.length);
        if (axis.motion == Motion::limited)
            errors.push_back(std::max(0.0, length - axis.upper) - std::max(0.0, axis.lower - length));
        return;
    }
    const Quat turn = world.turn();
    for (int k = 0; k < 3; ++k)
        if (joint.move[std::size_t(k)].motion == Motion::locked) errors.push_back(apart[k]);
    if (joint.type == JointType::universal) {
        errors.push_back((turn * Vec3::UnitY()).x());  // the second axis stays square to the first one
        return;
    }
    for (int k = 0; k < 3; ++k)
        if (joint.turn[std::size_t(k)].motion == Motion::locked) errors.push_back(2.0 * turn.vec()[k]);
}

TemplateKinematics::TemplateKinematics(const SceneTemplate& content)
    : content_(content), joints_at_(content.bodies.size() + 1), branch_of_(content.bodies.size() + 1) {
    for (std::size_t j = 0; j < content.joints.size(); ++j) {
        const JointDescription& joint = content.joints[j];
        start_.emplace_back(joint, content.bodies);
        if (joint.type == JointType::gear) continue;  // holds at any pose of its joints
        joints_at_[side(joint.first)].push_back(j);
        joints_at_[side(joint.second)].push_back(j);
    }
    std::vector<std::size_t> roots{world()};
    for (std::size_t b = 0; b < world(); ++b)
        if (content.bodies[b].type != BodyType::dynamic) roots.push_back(b);
    std::vector<char> reached(content.bodies.size() + 1, 0);
    for (const std::size_t root : roots) reached[root] = 1;
    grow_from(roots, reached);
    for (std::size_t b = 0; b < world(); ++b) {
        if (reached[b] != 0) continue;
        reached[b] = 1;
        grow_from({b}, reached);
    }
    std::vector<char> is_branch(content.joints.size(), 0);
    for (const Branch& branch : branches_) is_branch[branch.joint] = 1;
    for (std::size_t j = 0; j < content.joints.size(); ++j)
        if (is_branch[j] == 0 && content.joints[j].type != JointType::gear) closing_.push_back(j);
}

// Ropes, rods and springs carry a body along only where no joint of another type does.
void TemplateKinematics::grow_from(const std::vector<std::size_t>& roots, std::vector<char>& reached) {
    std::vector<std::size_t> order = roots;
    const auto grow = [&](std::size_t from, bool by_ropes) {
        for (const std::size_t j : joints_at_[from]) {
            const JointDescription& joint = content_.joints[j];
            if ((joint.type == JointType::distance) != by_ropes) continue;
            const bool outward = side(joint.first) == from;
            const std::size_t next = outward ? side(joint.second) : side(joint.first);
            if (reached[next] != 0) continue;
            reached[next] = 1;
            branch_of_[next] = branches_.size();
            branches_.push_back({next, from, j, outward});
            order.push_back(next);
        }
    };
    std::size_t solid = 0, loose = 0;  // bodies of the order that are done
    while (solid < order.size() || loose < order.size())
        if (solid < order.size())
            grow(order[solid++], false);
        else
            grow(order[loose++], true);
}

std::vector<RigidMotion> TemplateKinematics::motions(const std::vector<double>& changes) const {
    std::vector<RigidMotion> motions(content_.bodies.size() + 1);
    for (const Branch& branch : branches_) {
        const RigidMotion& parent = motions[branch.parent];
        const double change = changes[branch.joint];
        if (change == 0.0) {
            motions[branch.body] = parent;
            continue;
        }
        const RigidMotion own = motion_by_joint(content_.joints[branch.joint], start_[branch.joint], change);
        motions[branch.body] = parent.after(branch.outward ? own : inverse(own));
    }
    return motions;
}

WorldJoint TemplateKinematics::moved(std::size_t joint, const std::vector<RigidMotion>& motions) const {
    const JointDescription& one = content_.joints[joint];
    return {start_[joint], motions[side(one.first)], motions[side(one.second)]};
}

std::vector<std::size_t> TemplateKinematics::loop_of(std::size_t closing) const {
    const auto path = [&](std::size_t body) {
        std::set<std::size_t> joints;
        for (auto branch = branch_of_[body]; branch; branch = branch_of_[branches_[*branch].parent])
            joints.insert(branches_[*branch].joint);
        return joints;
    };
    const JointDescription& joint = content_.joints[closing];
    const std::set<std::size_t> a = path(side(joint.first)), b = path(side(joint.second));
    std::vector<std::size_t> loop;
    std::set_symmetric_difference(a.begin(), a.end(), b.begin(), b.end(), std::back_inserter(loop));
    return loop;
}

}  // namespace tumble
