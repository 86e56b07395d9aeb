#include "sim/contact/soft/soft_turns.h"

#include "core/deterministic_math.h"

#include <algorithm>
#include <cmath>

namespace tumble {
namespace {

using Turns = soft::TurnRows<float>;

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
Vec3 drive_about(const Joint& joint, const JointGeometry& g, const TurnAxes& axes, Joint::Law law) {
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

TurnAxes turn_axes(const Joint& joint, const JointGeometry& g) {
    TurnAxes t;
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

void pack_turns(const Joint& joint, const JointGeometry& g, const TurnAxes& axes, const TurnUnits& units,
                const soft::TurnLane& lane, bool driven) {
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

void unpack_turns(const TurnAxes& axes, const Mat3& frame, const TurnUnits& units, const soft::TurnLane& lane,
                  Joint& joint, bool driven) {
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

}  // namespace tumble
