#include "scene/keys/templates.h"

#include "core/deterministic_math.h"
#include "core/safe_text.h"
#include "scene/fields/choices.h"
#include "scene/keys/joint_coordinates.h"
#include "scene/keys/template_kinematics.h"
#include "scene/toml/limits.h"

#include <fmt/format.h>
#include <Eigen/Cholesky>

#include <algorithm>
#include <cmath>
#include <map>
#include <set>

namespace tumble {
namespace {

/// Changes of the coordinates of joints: the given ones, and those that close loops.
struct PoseChanges {
    std::vector<double> of_joint;  // rad or m
    std::vector<char> given;       // by the file
};

bool is_within(const JointAxis& axis, double value) {
    return value >= axis.lower - limits::start_tolerance && value <= axis.upper + limits::start_tolerance;
}

const CoordinateUnit& unit_of(const JointDescription& joint) {
    return joint.type == JointType::hinge ? angle_unit : length_unit;
}

const JointAxis& axis_of(const JointDescription& joint) {
    return joint.type == JointType::hinge ? joint.turn[0] : joint.move[0];
}

PoseChanges read_changes(const TomlValue& pose, const SceneTemplate& content, const TemplateKinematics& kinematics) {
    std::map<std::string, std::size_t> index;
    for (std::size_t i = 0; i < content.joints.size(); ++i) index[content.joints[i].name] = i;
    PoseChanges changes{std::vector<double>(content.joints.size(), 0.0), std::vector<char>(content.joints.size(), 0)};
    for (const auto& [name, value] : pose.table().entries()) {
        const auto found = index.find(name);
        if (found == index.end()) {
            std::vector<std::string_view> known;
            for (const auto& [other, i] : index) known.push_back(other);
            value.origin().fail(fmt::format("is not the name of a joint of the template{}", suggestion(name, known)));
        }
        const std::size_t j = found->second;
        const JointDescription& joint = content.joints[j];
        if (!has_one_coordinate(joint)) {
            value.origin().fail(
                fmt::format("is for hinges and sliders (given a joint of type \"{}\")", name_of(joint.type)));
        }
        const CoordinateUnit& unit = unit_of(joint);
        const JointAxis& axis = axis_of(joint);
        const Range& range = joint.type == JointType::hinge ? limits::half_turn : limits::coordinate;
        const double target = value.number(range) * unit.in_si;
        if (!is_within(axis, target)) {
            value.fail(fmt::format("must be within the limits of the joint, {:.6g} to {:.6g} {}",
                                   axis.lower / unit.in_si, axis.upper / unit.in_si, unit.name));
        }
        changes.of_joint[j] = target - coordinate_of(joint, kinematics.start(j));
        changes.given[j] = 1;
    }
    return changes;
}

/// The errors of all closing joints, relative to those at the start, which are accepted.
class LoopErrors {
public:
    LoopErrors(const SceneTemplate& content, const TemplateKinematics& kinematics, const std::vector<char>& given)
        : content_(content), kinematics_(kinematics), given_(given) {
        accepted_ = of(std::vector<double>(content.joints.size(), 0.0));
    }

    std::vector<double> of(const std::vector<double>& changes) const {
        const std::vector<RigidMotion> motions = kinematics_.motions(changes);
        std::vector<double> errors;
        for (const std::size_t j : kinematics_.closing()) append(j, motions, changes, errors);
        for (std::size_t i = 0; i < accepted_.size(); ++i) errors[i] -= accepted_[i];
        return errors;
    }

    /// The largest error of one closing joint.
    double of_joint(std::size_t j, const std::vector<double>& changes) const {
        const std::vector<double> none(changes.size(), 0.0);
        std::vector<double> now, start;
        append(j, kinematics_.motions(changes), changes, now);
        append(j, kinematics_.motions(none), none, start);
        double largest = 0.0;
        for (std::size_t i = 0; i < now.size(); ++i) largest = std::max(largest, std::fabs(now[i] - start[i]));
        return largest;
    }

private:
    void append(std::size_t j, const std::vector<RigidMotion>& motions, const std::vector<double>& changes,
                std::vector<double>& errors) const {
        const JointDescription& joint = content_.joints[j];
        const WorldJoint world = kinematics_.moved(j, motions);
        append_errors(joint, world, errors);
        if (given_[j] == 0) return;
        const double change = coordinate_of(joint, world) - coordinate_of(joint, kinematics_.start(j));
        const double error = change - changes[j];
        errors.push_back(joint.type == JointType::hinge ? std::remainder(error, 2.0 * pi) : error);
    }

    const SceneTemplate& content_;
    const TemplateKinematics& kinematics_;
    const std::vector<char>& given_;
    std::vector<double> accepted_;
};

/// Joints of loops whose coordinates are not given.
std::vector<std::size_t> unknowns_of(const SceneTemplate& content, const TemplateKinematics& kinematics,
                                     const std::vector<char>& given) {
    std::set<std::size_t> unknown;
    for (const std::size_t closing : kinematics.closing())
        for (const std::size_t j : kinematics.loop_of(closing))
            if (given[j] == 0 && has_one_coordinate(content.joints[j])) unknown.insert(j);
    return {unknown.begin(), unknown.end()};
}

double largest_of(const std::vector<double>& errors) {
    double largest = 0.0;
    for (const double error : errors) largest = std::max(largest, std::fabs(error));
    return largest;
}

/// One step of Gauss and Newton with the least change; redundant rows have a little compliance.
void step_towards_closed(const LoopErrors& errors, const std::vector<std::size_t>& unknown,
                         std::vector<double>& changes) {
    constexpr double difference = 1e-6;   // rad or m: half of the digits of a change
    constexpr double compliance = 1e-10;  // of the largest pivot
    const std::vector<double> now = errors.of(changes);
    Eigen::MatrixXd jacobian(Eigen::Index(now.size()), Eigen::Index(unknown.size()));
    for (std::size_t k = 0; k < unknown.size(); ++k) {
        std::vector<double> moved = changes;
        moved[unknown[k]] += difference;
        const std::vector<double> above = errors.of(moved);
        moved[unknown[k]] -= 2.0 * difference;
        const std::vector<double> below = errors.of(moved);
        for (std::size_t i = 0; i < now.size(); ++i)
            jacobian(Eigen::Index(i), Eigen::Index(k)) = (above[i] - below[i]) / (2.0 * difference);
    }
    Eigen::MatrixXd matrix = jacobian * jacobian.transpose();
    const double softness = compliance * matrix.diagonal().maxCoeff();
    if (!(softness > 0.0)) return;
    matrix.diagonal().array() += softness;
    const Eigen::Map<const Eigen::VectorXd> right(now.data(), Eigen::Index(now.size()));
    const Eigen::VectorXd change = jacobian.transpose() * Eigen::VectorXd(matrix.llt().solve(right));
    for (std::size_t k = 0; k < unknown.size(); ++k) changes[unknown[k]] -= change[Eigen::Index(k)];
}

/// Finds the coordinates of the unknown joints. The given ones go to their values in small steps, so that each loop
/// stays on its branch.
void close_loops(const LoopErrors& errors, const std::vector<std::size_t>& unknown, PoseChanges& changes) {
    constexpr std::size_t most_unknown = 200;  // dense matrices
    constexpr double largest_part = 0.1;       // rad or m, of a given change
    constexpr int most_steps = 20;
    constexpr double closed = 1e-13;  // m and rad
    if (unknown.empty() || unknown.size() > most_unknown) return;
    if (largest_of(errors.of(changes.of_joint)) <= closed) return;
    const std::vector<double> target = changes.of_joint;
    const int parts = int(std::clamp(std::ceil(largest_of(target) / largest_part), 1.0, 1000.0));
    for (int part = 1; part <= parts; ++part) {
        for (std::size_t j = 0; j < target.size(); ++j)
            if (changes.given[j] != 0) changes.of_joint[j] = part == parts ? target[j] : target[j] * part / parts;
        for (int step = 0; step < most_steps && largest_of(errors.of(changes.of_joint)) > closed; ++step)
            step_towards_closed(errors, unknown, changes.of_joint);
    }
}

constexpr double most_error = 1e-9;  // m and rad: rounding of a loop of meters, not a mistake

void check_loops(const TomlValue& pose, const SceneTemplate& content, const TemplateKinematics& kinematics,
                 const LoopErrors& errors, const PoseChanges& changes) {
    for (const std::size_t j : kinematics.closing()) {
        const double error = errors.of_joint(j, changes.of_joint);
        if (error <= most_error) continue;
        pose.origin().fail(
            fmt::format("opens the joint \"{}\", which closes a loop, by {:.3g} m or rad: give coordinates with which "
                        "the loop can close, or leave out those of some of its joints",
                        safe_text(content.joints[j].name), error));
    }
}

void check_found(const TomlValue& pose, const SceneTemplate& content, const TemplateKinematics& kinematics,
                 const std::vector<std::size_t>& unknown, const PoseChanges& changes) {
    for (const std::size_t j : unknown) {
        const JointDescription& joint = content.joints[j];
        const double value = coordinate_of(joint, kinematics.start(j)) + changes.of_joint[j];
        if (changes.of_joint[j] == 0.0 || is_within(axis_of(joint), value)) continue;
        const CoordinateUnit& unit = unit_of(joint);
        pose.origin().fail(
            fmt::format("moves the joint \"{}\", so that its loop stays closed, to {:.6g} {}, outside of "
                        "its limits: give other coordinates, or other limits",
                        safe_text(joint.name), value / unit.in_si, unit.name));
    }
}

}  // namespace

void apply_pose(const TomlValue& pose, SceneTemplate& content) {
    const TemplateKinematics kinematics(content);
    PoseChanges changes = read_changes(pose, content, kinematics);
    const LoopErrors errors(content, kinematics, changes.given);
    const std::vector<std::size_t> unknown = unknowns_of(content, kinematics, changes.given);
    close_loops(errors, unknown, changes);
    check_loops(pose, content, kinematics, errors, changes);
    check_found(pose, content, kinematics, unknown, changes);
    const std::vector<RigidMotion> motions = kinematics.motions(changes.of_joint);
    for (std::size_t b = 0; b < content.bodies.size(); ++b) {
        BodyDescription& body = content.bodies[b];
        body.position = motions[b].point(body.position);
        body.rotation = (motions[b].rotation * body.rotation).normalized();
        body.velocity = motions[b].rotation * body.velocity;
        body.angular_velocity = motions[b].rotation * body.angular_velocity;
    }
}

}  // namespace tumble
