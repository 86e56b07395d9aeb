#include "sim/contact/soft/soft_joints.h"

#include "core/deterministic_math.h"
#include "core/fetch_ahead.h"
#include "sim/joints/joint_set.h"

#include <algorithm>
#include <cmath>

namespace tumble {
namespace {

using Turns = soft::AngularRows<float>;

constexpr double no_limit = 1e6;      // rad: far from any turn, and finite in products
constexpr double least_scale = 1e-6;  // of a coordinate that has no direction, as of a cross whose arms are in line
constexpr double narrowest = 0.2;     // rad, swing below which the border of a cone counts as one of that radius

bool damped(const JointAxis& axis) { return axis.spring && axis.spring->damping > 0.0; }

bool has_drives(const Joint& joint) {
    const bool bearing = joint.description.friction_coefficient * joint.description.bearing_radius > 0.0;
    for (std::size_t k = 3; k < Joint::coordinates; ++k)
        if (damped(joint.axis(k)) || joint.axis(k).friction > 0.0 || (bearing && !joint.locked(k))) return true;
    return false;
}

bool turns_freely(const Joint& joint) {
    for (std::size_t k = 3; k < Joint::coordinates; ++k)
        if (joint.axis(k).motion != JointAxis::Motion::free) return false;
    return !joint.description.swing;
}

Vec3 vector_of(const soft::Vector3<float>& v) { return {v.x, v.y, v.z}; }

// Impulses of a law about the axes. The impulses of a ball's dampers and friction are along the axes of A's frame; the
// impulses of others are along the coordinates.
Vec3 drive_about(const Joint& joint, const JointGeometry& g, const AngularAxes& axes, Joint::Law law) {
    Vec3 impulse;
    for (std::size_t k = 0; k < 3; ++k) impulse[Eigen::Index(k)] = joint.impulse[3 + k][law];
    if (!joint.turns_alike()) return impulse;
    const Vec3 world = g.axes * impulse;
    return {axes.axis[0].dot(world), axes.axis[1].dot(world), axes.axis[2].dot(world)};
}

}  // namespace

soft::JointKind kind_in_sweeps(const Joint& joint) {
    if (joint.distance()) return soft::JointKind::distance;
    if (has_drives(joint)) return soft::JointKind::driven;
    return turns_freely(joint) ? soft::JointKind::point : soft::JointKind::turning;
}

AngularAxes angular_axes(const Joint& joint, const JointGeometry& g) {
    AngularAxes t;
    int free = 0, locked = 0;
    for (std::size_t k = 0; k < 3; ++k) {
        const JointCoordinate& c = g.coordinates[3 + k];
        const JointAxis& axis = joint.axis(3 + k);
        const double scale = c.direction.norm();
        t.locked[k] = joint.locked(3 + k);
        (t.locked[k] ? locked : free) += 1;
        t.axis[k] = scale > least_scale ? Vec3(c.direction / scale) : Vec3(Vec3::Unit(Eigen::Index(k)));
        t.scale[k] = std::max(scale, least_scale);
        const bool limited = axis.motion == JointAxis::Motion::limited;
        const auto room = [&](double limit) { return std::clamp((limit - c.value) / t.scale[k], -no_limit, no_limit); };
        t.least[k] = t.locked[k] ? -c.value / t.scale[k] : limited ? room(axis.lower) : -no_limit;
        t.most[k] = t.locked[k] ? t.least[k] : limited ? room(axis.upper) : no_limit;
    }
    if (free == 2)  // turns x and y in sequence are a rotation vector with the component x y / 2 across both
        for (int k = 0; k < 3; ++k)
            if (t.locked[std::size_t(k)]) t.bend[k] = -0.5;
    const auto free_turn = [&](std::size_t k) { return joint.axis(3 + k).motion == JointAxis::Motion::free; };
    if (joint.turns_alike() && free_turn(1) && free_turn(2)) {
        // Axes across each other, about which dampers and friction act alike.
        if (free_turn(0) && !joint.description.swing) t.axis[0] = g.axes.col(0);
        const Vec3 side = g.axes.col(1) - g.axes.col(1).dot(t.axis[0]) * t.axis[0];
        t.axis[1] = side.squaredNorm() > 0.25 ? Vec3(side.normalized()) : Vec3(t.axis[0].unitOrthogonal());
        t.axis[2] = t.axis[0].cross(t.axis[1]);
        t.scale[1] = t.scale[2] = 1.0;
    }
    if (joint.description.swing) {
        // Axes across each other: halfway between both twist axes; of the swing; and across both. Turns about the first
        // and third move the twist axis of B along the border, at a distance of the swing.
        const double angle = g.swing.value;
        t.axis[1] = g.swing.direction;
        t.axis[2] = t.axis[0].cross(t.axis[1]);
        const auto& [about_y, about_z] = *joint.description.swing;
        if (about_y == about_z) {
            t.round = true;
            t.limit = about_y;
            t.most[1] = 0.0;
            t.twist_a = g.axes.col(0);
            const SinCos swung = sincos(angle);
            t.twist_b = swung.cos * t.twist_a + swung.sin * t.axis[1].cross(t.twist_a);
            return t;
        }
        t.most[1] = g.swing_limit - angle;
        const SinCos bent = sincos(std::max(angle, narrowest)), half = sincos(0.5 * angle);
        const double curved = std::sqrt(std::max(0.0, 0.5 * bent.cos / bent.sin));
        t.circle = curved * half.cos;
        t.twist = curved * half.sin;
    }
    return t;
}

void pack_angular(const Joint& joint, const JointGeometry& g, const AngularAxes& axes, const AngularUnits& units,
                  const soft::AngularLane& lane, bool driven) {
    Vec3 least, most, locked, impulse;
    for (std::size_t k = 0; k < 3; ++k) {
        const auto i = Eigen::Index(k);
        const auto& last = joint.impulse[3 + k];
        const double cone = k == 1 && joint.description.swing ? last[Joint::cone] : 0.0;
        least[i] = axes.least[k];
        most[i] = axes.most[k];
        locked[i] = axes.locked[k] ? 1.0 : 0.0;
        impulse[i] = units.share * axes.scale[k] * (last[Joint::lock] + last[Joint::lower] + last[Joint::upper] + cone);
    }
    lane.set(&Turns::axis_x, axes.axis[0]);
    lane.set(&Turns::axis_y, axes.axis[1]);
    lane.set(&Turns::axis_z, axes.axis[2]);
    lane.set(&Turns::least, least);
    lane.set(&Turns::most, most);
    lane.set(&Turns::locked, locked);
    lane.set(&Turns::bend, axes.bend);
    lane[&Turns::circle] = float(axes.circle);
    lane[&Turns::twist] = float(axes.twist);
    if (axes.round) {
        lane[&Turns::round] = 1.0f;
        const SinCos limit = sincos(axes.limit);
        lane[&Turns::limit_sine] = float(limit.sin);
        lane[&Turns::limit_cosine] = float(limit.cos);
        lane.set(&Turns::twist_a, axes.twist_a);
        lane.set(&Turns::twist_b, axes.twist_b);
    }
    lane.set(&Turns::impulse, impulse);
    if (!driven) return;
    const bool alike = joint.turns_alike();
    const JointDescription& description = joint.description;
    const double bearing = description.friction_coefficient * description.bearing_radius;
    Vec3 softness, rubs;
    double rough = 0.0;
    for (std::size_t k = 0; k < 3; ++k) {
        const JointAxis& axis = joint.axis(alike ? 3 : 3 + k);
        softness[Eigen::Index(k)] = damped(axis) ? units.mass / (units.substep * axis.spring->damping) : 0.0;
        const bool rubbing = !joint.locked(3 + k) && (axis.friction > 0.0 || bearing > 0.0);
        rubs[Eigen::Index(k)] = rubbing ? 1.0 : 0.0;
        if (rubbing) rough = std::max(rough, units.substep / units.mass * axis.friction);
    }
    lane.set(&Turns::softness, softness);
    lane.set(&Turns::rubs, rubs);
    lane[&Turns::rough] = float(rough);
    lane[&Turns::bearing] = float(bearing);
    lane.set(&Turns::damping, Vec3(units.share * drive_about(joint, g, axes, Joint::spring)));
    lane.set(&Turns::friction, Vec3(units.share * drive_about(joint, g, axes, Joint::friction)));
}

void unpack_angular(const AngularAxes& axes, const Mat3& frame, const AngularUnits& units,
                    const soft::AngularLane& lane, Joint& joint, bool driven) {
    const Vec3 held = vector_of(lane.vector(&Turns::impulse)) / units.share;
    for (std::size_t k = 0; k < 3; ++k) {
        const double impulse = held[Eigen::Index(k)] / axes.scale[k];
        const bool cone = k == 1 && joint.description.swing;
        joint.impulse[3 + k][axes.locked[k]   ? Joint::lock
                             : cone           ? Joint::cone
                             : impulse >= 0.0 ? Joint::lower
                                              : Joint::upper] = impulse;
    }
    if (!driven) return;
    const auto hand_over = [&](const soft::Vector3<float>& rows, Joint::Law law) {
        Vec3 impulse = vector_of(rows) / units.share;
        if (joint.turns_alike())
            impulse =
                frame.transpose() * (impulse[0] * axes.axis[0] + impulse[1] * axes.axis[1] + impulse[2] * axes.axis[2]);
        for (std::size_t k = 0; k < 3; ++k) joint.impulse[3 + k][law] = impulse[Eigen::Index(k)];
    };
    hand_over(lane.vector(&Turns::damping), Joint::spring);
    hand_over(lane.vector(&Turns::friction), Joint::friction);
}

namespace {

using Hold = soft::JointRows<float>;
using Turned = soft::AngularRows<float>;

Vec3 wide(const soft::Vector3<float>& v) { return {v.x, v.y, v.z}; }

// A side of a joint: the point that moments are about, and the anchor. Bodies that impulses do not move have no arm,
// except kinematic ones, which turn.
struct End {
    Vec3 center, anchor;
};
End end_of(const std::vector<Body>& bodies, std::uint32_t body, const Vec3& anchor) {
    if (body == Joint::world) return {anchor, anchor};
    const Body& b = bodies[body];
    const Vec3 place = b.position + b.rotation * anchor;
    return {b.moves() ? b.position : place, place};
}

// Axes of A's joint frame, world.
Mat3 axes_of(const Joint& joint, const std::vector<Body>& bodies) {
    const Mat3 frame = joint.frame_a.toRotationMatrix();
    return joint.a == Joint::world ? frame : Mat3(bodies[joint.a].rotation * frame);
}

Vec3 direction_of(const Vec3& apart) {
    const double length = apart.norm();
    return length > 0.0 ? Vec3(apart / length) : Vec3(Vec3::UnitY());
}

// Velocity of the body at a point: the mean of before and after the solve.
BodyVelocity mean_at(const ContactProblem& problem, std::uint32_t body, const Vec3& point) {
    if (body == Joint::world) return {};
    const Body& b = problem.bodies[body];
    BodyVelocity of{b.velocity, b.angular_velocity};
    if (b.dynamic()) {
        of.velocity = 0.5 * (of.velocity + problem.before[body].velocity);
        of.angular_velocity = 0.5 * (of.angular_velocity + problem.before[body].angular_velocity);
    }
    of.velocity += of.angular_velocity.cross(point - b.position);
    return of;
}

}  // namespace

Joint& SoftJoints::joint(const ContactProblem& problem, std::uint32_t place) const {
    return problem.joints->joints()[joints_[place]];
}

void SoftJoints::open(const SoftLayout& layout, std::span<const std::uint32_t> joints, const Units& units, bool again) {
    units_ = units;
    again_ = again;
    bodies_ = &layout;
    layout_ = &layout.joints();
    joints_ = joints;
    const std::size_t groups = layout_->groups();
    places_.resize(joints.size());
    rows_.resize(groups * soft::joint_rows * units.lanes);
    angular_axes_.resize(joints.size());
    angular_rows_.resize(layout_->turning_groups() * soft::angular_rows * units.lanes);
    lane_bodies_.resize(2 * groups * units.lanes);
    lane_moved_.resize(2 * groups);
}

// The parts of the next group of joints that are packed and unpacked.
void SoftJoints::fetch_next(const ContactProblem& problem, std::size_t group) const {
    if (group + 1 == layout_->groups()) return;
    for (std::size_t l = 0; l < units_.lanes; ++l) {
        const std::uint32_t place = layout_->joint((group + 1) * units_.lanes + l);
        if (place == JointLayout::none) continue;
        const Joint& next = joint(problem, place);
        fetch_ahead(&next.anchor_a, &next.springs);
        fetch_ahead(&next.value, &next.curving);
        fetch_ahead(&next.force, &next.account.frame);
    }
}

template <class Visit>
void SoftJoints::each_lane(std::size_t group, Visit&& visit) const {
    for (std::size_t l = 0; l < units_.lanes; ++l)
        if (const std::uint32_t place = layout_->joint(group * units_.lanes + l); place != JointLayout::none)
            visit(l, place);
}

void SoftJoints::pack(const ContactProblem& problem, std::size_t group) {
    const std::size_t lanes = units_.lanes;
    std::fill_n(rows_.data() + group * soft::joint_rows * lanes, soft::joint_rows * lanes, 0.0f);
    const soft::JointKind kind = layout_->kind(group);
    if (soft::turns(kind)) {
        float* turns = angular_rows_.data() + layout_->angular_indices()[group] * soft::angular_rows * lanes;
        std::fill_n(turns, soft::angular_rows * lanes, 0.0f);
    }
    std::fill_n(lane_bodies_.begin() + std::ptrdiff_t(2 * lanes * group), 2 * lanes, 0u);
    lane_moved_[2 * group] = lane_moved_[2 * group + 1] = 0;
    const double share = 1.0 / (units_.substeps * units_.mass);
    fetch_next(problem, group);
    each_lane(group, [&](std::size_t l, std::uint32_t place) {
        Joint& j = joint(problem, place);
        const SoftLayout::JointEnds& ends = bodies_->joint_ends(place);
        lane_bodies_[2 * lanes * group + l] = std::uint32_t(soft::body_floats) * ends.slot_a;
        lane_bodies_[2 * lanes * group + lanes + l] = std::uint32_t(soft::body_floats) * ends.slot_b;
        lane_moved_[2 * group] |= std::uint16_t(ends.moved_a << l);
        lane_moved_[2 * group + 1] |= std::uint16_t(ends.moved_b << l);
        const End a = end_of(problem.bodies, j.a, j.anchor_a), b = end_of(problem.bodies, j.b, j.anchor_b);
        const Vec3 apart = b.anchor - a.anchor;
        Place& kept = places_[place];
        kept.center_a = a.center;
        kept.center_b = b.center;
        kept.point = b.anchor;
        const soft::JointLane row = lane(group, l);
        row[&Hold::present] = 1.0f;
        row.set(&Hold::arm_a, a.anchor - a.center);
        row.set(&Hold::arm_b, b.anchor - b.center);
        row.set(&Hold::apart, apart);
        kept.torque = kept.damping = kept.friction = Vec3::Zero();
        if (kind != soft::JointKind::distance) {
            Vec3 impulse;
            for (std::size_t c = 0; c < 3; ++c) impulse[Eigen::Index(c)] = j.impulse[c][Joint::lock];
            kept.axes = axes_of(j, problem.bodies);
            row.set(&Hold::impulse, Vec3(share * (kept.axes * impulse)));
            if (!soft::turns(kind)) return;
            const JointGeometry g = measure(j, side_of(problem.bodies, j.a), side_of(problem.bodies, j.b));
            for (std::size_t c = 3; c < Joint::coordinates; ++c)
                if (!j.locked(c)) j.value[c] = g.coordinates[c].value;
            angular_axes_[place] = angular_axes(j, g);
            pack_angular(j, g, angular_axes_[place], angular_units(), angular_lane(group, l),
                         kind == soft::JointKind::driven);
            return;
        }
        const JointAxis& axis = j.axis(0);
        const bool rod = j.locked(0), limited = axis.motion == JointAxis::Motion::limited;
        row[&Hold::shortest] = float(rod ? j.description.length : limited ? axis.lower : -infinity);
        row[&Hold::longest] = float(rod ? j.description.length : limited ? axis.upper : infinity);
        row.set(&Hold::direction, direction_of(apart));
        const auto& last = j.impulse[0];
        row.set(&Hold::impulse, Vec3(share * (last[Joint::lock] + last[Joint::lower] + last[Joint::upper]), 0.0, 0.0));
    });
}

void SoftJoints::unpack_torque(std::size_t group, std::size_t l, std::uint32_t place, Joint& joint) {
    const soft::JointKind kind = layout_->kind(group);
    if (!soft::turns(kind)) return;
    Place& kept = places_[place];
    const soft::AngularLane lane = angular_lane(group, l);
    kept.torque = units_.mass * wide(lane.vector(&Turned::torque_sum));
    if (kind == soft::JointKind::driven) {
        kept.damping = units_.mass * wide(lane.vector(&Turned::damping_sum));
        kept.friction = units_.mass * wide(lane.vector(&Turned::friction_sum));
    }
    unpack_angular(angular_axes_[place], kept.axes, angular_units(), lane, joint, kind == soft::JointKind::driven);
}

void SoftJoints::unpack(const ContactProblem& problem, std::size_t group, std::vector<std::uint8_t>& reached,
                        std::vector<Vec3>& carried) {
    const double h = problem.settings.h, whole = units_.substeps * units_.mass;
    fetch_next(problem, group);
    each_lane(group, [&](std::size_t l, std::uint32_t place) {
        Joint& j = joint(problem, place);
        const soft::JointLane row = lane(group, l);
        const Vec3 force = units_.mass * wide(row.vector(&Hold::impulse_sum)),
                   moment = units_.mass * wide(row.vector(&Hold::moment_sum)),
                   extra = units_.mass * wide(row.vector(&Hold::carried_sum));
        const SoftLayout::JointEnds& ends = bodies_->joint_ends(place);
        j.impulse = {};
        if (!again_) {
            j.curving = {};
        }
        unpack_torque(group, l, place, j);
        const Place& kept = places_[place];
        const Vec3 last = whole * wide(row.vector(&Hold::impulse));
        if (layout_->kind(group) != soft::JointKind::distance) {
            const Vec3 local = kept.axes.transpose() * last;
            for (std::size_t c = 0; c < 3; ++c) j.impulse[c][Joint::lock] = local[Eigen::Index(c)];
        } else {
            j.impulse[0][j.locked(0) ? Joint::lock : last.x() > 0.0 ? Joint::lower : Joint::upper] = last.x();
        }
        j.point = kept.point;
        j.force = force / h;
        j.torque = kept.torque / h;
        JointAccount::Span& step = j.account.step;
        step = {};
        step.reaction.force = force;
        step.reaction.torque = kept.torque;
        step.reaction.moment = kept.center_a.cross(force) + moment + extra + kept.torque;
        carried[joints_[place]] = extra;
        if (ends.moved_a) {
            reached[ends.slot_a] = 1;
            Body& body = problem.bodies[j.a];
            body.momentum -= force;
            body.angular_momentum -= moment + kept.torque;
        }
        if (ends.moved_b) {
            reached[ends.slot_b] = 1;
            Body& body = problem.bodies[j.b];
            body.momentum += force;
            body.angular_momentum += moment + (kept.center_a - kept.center_b).cross(force) + extra + kept.torque;
        }
    });
}

void SoftJoints::account(const ContactProblem& problem, std::size_t group) const {
    each_lane(group, [&](std::size_t, std::uint32_t place) {
        Joint& j = joint(problem, place);
        const SoftLayout::JointEnds& ends = bodies_->joint_ends(place);
        JointAccount::Span& step = j.account.step;
        const Place& kept = places_[place];
        const Vec3& force = step.reaction.force;
        const BodyVelocity a = mean_at(problem, j.a, j.point), b = mean_at(problem, j.b, j.point);
        step.work_a = -force.dot(a.velocity) - kept.torque.dot(a.angular_velocity);
        step.work_b = force.dot(b.velocity) + kept.torque.dot(b.angular_velocity);
        // All that a joint takes from its bodies is lost: by friction and dampers, otherwise at limits, where it
        // catches its bodies, and by sweeps that damp.
        const Vec3 turning = b.angular_velocity - a.angular_velocity;
        const double rubbed = kept.friction.dot(turning), damped = kept.damping.dot(turning);
        step.work.heat -= rubbed;
        step.work.springs += damped;
        step.work.impacts -= step.work_a + step.work_b - rubbed - damped;
        if (!ends.moved_a) step.work.carriers -= step.work_a;
        if (!ends.moved_b) step.work.carriers -= step.work_b;
        step.solves = 1;
    });
}

}  // namespace tumble
