#include "sim/impact/joined_groups.h"

#include "core/disjoint_sets.h"
#include "sim/joints/gear.h"
#include "sim/joints/joint_set.h"
#include "sim/joints/settings.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace tumble {
namespace {

/// Compliance of a joint's locked coordinates at an impact, of unit forms: square root of the rounding of double
/// precision, where a pass removes all but a share of 1e-8 of an error for the least of the two causes, rounding and
/// the compliance over the squared singular value (1e-2 for ragdolls, 1e-5 for a chain of a thousand links, 1e-8 for
/// masses of 1 : 1e8). Not fitted: rounding.
constexpr double impact_lock_compliance = 1e-8;

/// Share of the first error at which the passes end, and the most passes. Not fitted: rounding, and a bound of the
/// cost.
constexpr double impact_lock_rounding = 1e-16;
constexpr int impact_lock_passes = 60;

constexpr std::uint32_t no_place = VelocityRow::none;

// Position in an ascending list; no_place if absent.
std::uint32_t position_in(std::span<const std::uint32_t> list, std::uint32_t value) {
    const auto found = std::lower_bound(list.begin(), list.end(), value);
    return found != list.end() && *found == value ? std::uint32_t(found - list.begin()) : no_place;
}

/// The indices of a lock's bodies in a group, each once, with the lock's numbers there.
struct LockSides {
    struct Side {
        std::uint32_t body;  // from the group's first on
        Vec6 six;
    };
    std::array<Side, 4> sides;
    std::size_t count = 0;

    void add(const VelocityRow& form, std::uint32_t first) {
        for (const auto& [place, six] : {std::pair(form.a, &form.on_a), std::pair(form.b, &form.on_b)}) {
            if (place == no_place) continue;
            std::size_t s = 0;
            while (s < count && sides[s].body != place - first) ++s;
            if (s == count) sides[count++] = {place - first, Vec6::Zero()};
            sides[s].six += *six;
        }
    }
    template <class Visit>
    void each_pair(const Visit& visit) const {
        for (std::size_t s = 0; s < count; ++s)
            for (std::size_t t = s + 1; t < count; ++t) visit(sides[s], sides[t]);
    }
};

// Matrix += weight form form^T; `pair`: index of the first coupling, the others follow.
void add_square(BlockCholesky& matrix, std::uint32_t pair, const LockSides& lock, double weight) {
    using Eight = BlockCholesky::Row;
    const auto add = [&](BlockCholesky::Block& to, const Vec6& left, const Vec6& w) {
        const Eight right = weight * Eight{w[0], w[1], w[2], w[3], w[4], w[5], 0.0, 0.0};
        for (int k = 0; k < 6; ++k) to.row[k] += left[k] * right;
    };
    for (std::size_t s = 0; s < lock.count; ++s)
        add(matrix.diagonal(lock.sides[s].body), lock.sides[s].six, lock.sides[s].six);
    lock.each_pair([&](const LockSides::Side& s, const LockSides::Side& t) {
        const bool turned = matrix.transposed(pair);
        add(matrix.coupling(pair++), turned ? t.six : s.six, turned ? s.six : t.six);
    });
}

}  // namespace

JoinedGroups::JoinedGroups(std::span<const std::uint32_t> bodies, const std::vector<Joint*>& joints,
                           std::span<const Joint> all_joints, const std::vector<Body>& all)
    : bodies_(bodies.begin(), bodies.end()), places_(bodies.size()), joints_(joints), all_joints_(all_joints) {
    const std::size_t n = bodies.size();
    DisjointSets sets(n);
    const auto index = [&](std::uint32_t body) {
        return body == Joint::world || !all[body].dynamic() ? no_place : position_in(bodies_, body);
    };
    std::vector<char> has_joint(n, 0);
    for (const Joint* joint : joints) {
        const std::uint32_t a = index(joint->a), b = index(joint->b);
        for (const std::uint32_t i : {a, b})
            if (i != no_place) has_joint[i] = 1;
        if (a != no_place && b != no_place) sets.join(a, b);
    }
    // The root of a group is its lowest body. Groups in the order of their roots, the bodies of each ascending.
    std::vector<std::uint32_t> group(n, no_place);
    for (std::uint32_t i = 0; i < n; ++i) {
        const std::size_t r = sets.root(i);
        if (group[r] == no_place) {
            group[r] = std::uint32_t(groups_.size());
            groups_.emplace_back();
        }
        group[i] = group[r];
        ++groups_[group[i]].bodies;
    }
    std::vector<std::uint32_t> own(groups_.size());  // bodies
    for (std::size_t g = 0; g < groups_.size(); ++g) own[g] = groups_[g].bodies;
    rotors_.assign(joints.size(), no_place);
    for (std::size_t k = 0; k < joints.size(); ++k) {
        const std::uint32_t a = index(joints[k]->a), b = index(joints[k]->b);
        if (a == no_place && b == no_place) continue;
        Group& g = groups_[group[a != no_place ? a : b]];
        g.joints.push_back(k);
        if (joints[k]->description.armature) rotors_[k] = g.bodies++;  // within the group
    }
    std::uint32_t first = 0;
    for (Group& g : groups_) {
        g.first = first;
        first += g.bodies;
        for (const std::size_t k : g.joints)
            if (rotors_[k] != no_place) rotors_[k] += g.first;
    }
    group_of_.assign(first, no_place);
    std::vector<std::uint32_t> next(groups_.size(), 0);
    for (std::uint32_t i = 0; i < n; ++i) {
        places_[i] = groups_[group[i]].first + next[group[i]]++;
        group_of_[places_[i]] = has_joint[i] ? group[i] : no_place;
    }
    for (std::uint32_t g = 0; g < groups_.size(); ++g)
        for (std::uint32_t rotor = own[g]; rotor < groups_[g].bodies; ++rotor) group_of_[groups_[g].first + rotor] = g;
}

JoinedGroups::Rate JoinedGroups::rate_of(const Joint& joint, const Vec3& point, const Vec3& direction, bool turns,
                                         const std::vector<Body>& all, const std::vector<MassRoot>& roots) const {
    Rate rate;
    const auto side = [&](std::uint32_t body, double sign, std::uint32_t& place, Vec6& on) {
        if (body == Joint::world) return;
        const Body& b = all[body];
        const Vec3 arm = point - b.position;
        if (!b.dynamic()) {
            rate.offset += sign * direction.dot(turns ? b.angular_velocity : b.point_velocity(arm));
            return;
        }
        place = places_[position_in(bodies_, body)];
        on = sign * (turns ? roots[place].turning_row(direction) : roots[place].row(arm, direction));
    };
    side(joint.a, -1.0, rate.form.a, rate.form.on_a);
    side(joint.b, 1.0, rate.form.b, rate.form.on_b);
    return rate;
}

// q1' + ratio q2' = 0.
void JoinedGroups::load_gear(Group& group, std::size_t index, const std::vector<Body>& all,
                             const std::vector<MassRoot>& roots) {
    const Joint& gear = *joints_[index];
    const GearGeometry g = measure_gear(gear, all_joints_, [&](std::uint32_t body) { return side_of(all, body); });
    const auto rate = [&](std::size_t s, Vec3& direction, bool& turns) {
        const Joint& joint = all_joints_[gear.description.geared[s]];
        direction = (s == 0 ? 1.0 : gear.description.ratio) * g.coordinate(joint, s).direction;
        turns = geared_coordinate(joint) >= 3;
        return rate_of(joint, g.joints[s].point, direction, turns, all, roots);
    };
    points_[index] = g.joints[0].point;
    other_points_[index] = g.joints[1].point;
    Lock lock{index, Vec3::Zero(), false, 0.0, 0.0, {}};
    const Rate first = rate(0, lock.direction, lock.turns), second = rate(1, lock.other_direction, lock.other_turns);
    lock.form = first.form;
    lock.other = second.form;
    const double square = lock.form.squared_norm() + lock.other.squared_norm() + 2.0 * lock.form.dot(lock.other);
    if (!(square > 0.0)) return;
    lock.length = std::sqrt(square);
    lock.offset = (first.offset + second.offset) / lock.length;
    for (Vec6* six : {&lock.form.on_a, &lock.form.on_b, &lock.other.on_a, &lock.other.on_b}) *six /= lock.length;
    locks_.push_back(lock);
    ++group.locks;
}

// q' + offset = y / sqrt(a) of the rotor.
void JoinedGroups::add_rotor(Group& group, std::size_t index, Lock lock) {
    const double rate = 1.0 / std::sqrt(*joints_[index]->description.armature);
    lock.rotor = true;
    lock.other.a = rotors_[index];
    lock.length = std::sqrt(lock.form.squared_norm() + rate * rate);
    lock.offset /= lock.length;
    lock.form.on_a /= lock.length;
    lock.form.on_b /= lock.length;
    lock.other.on_a[0] = -rate / lock.length;
    locks_.push_back(lock);
    ++group.locks;
}

void JoinedGroups::turn_rotors(Eigen::VectorXd& y) const {
    for (const Lock& lock : locks_)
        if (lock.rotor) y[6 * Eigen::Index(lock.other.a)] = -(lock.form.dot(y) + lock.offset) / lock.other.on_a[0];
}

void JoinedGroups::linearize_joint(Group& group, std::size_t index, const std::vector<Body>& all,
                                   const std::vector<MassRoot>& roots) {
    const Joint& joint = *joints_[index];
    if (joint.gear()) return load_gear(group, index, all, roots);
    const JointGeometry g = measure(joint, side_of(all, joint.a), side_of(all, joint.b));
    points_[index] = g.point;
    const auto rate = [&](const Vec3& direction, bool turns) {
        return rate_of(joint, g.point, direction, turns, all, roots);
    };
    const auto add_limit = [&](const Vec3& direction, bool turns, double restitution) {
        const double size = turns ? joint.size : 1.0;
        Rate along = rate(direction, turns);
        along.form.on_a *= size;
        along.form.on_b *= size;
        limits_.push_back({index, direction, turns, size, along.form, size * along.offset, restitution});
    };
    for (std::size_t k = 0; k < joint.count(); ++k) {
        const auto& [direction, value] = g.coordinates[k];
        const bool turns = k >= 3;
        if (joint.locked(k)) {
            Rate along = rate(direction, turns);
            const double length = std::sqrt(along.form.squared_norm());
            if (!(length > 0.0)) continue;
            along.form.on_a /= length;
            along.form.on_b /= length;
            locks_.push_back({index, direction, turns, length, along.offset / length, along.form});
            ++group.locks;
            continue;
        }
        const JointAxis& axis = joint.axis(k);
        if (axis.motion != JointAxis::Motion::limited) continue;
        const double near = tuning::joint_rounding * (turns ? 1.0 : joint.size);
        if (value <= axis.lower + near) add_limit(direction, turns, axis.restitution);
        if (value >= axis.upper - near) add_limit(-direction, turns, axis.restitution);
    }
    if (joint.description.swing && g.swing.value >= g.swing_limit - tuning::joint_rounding)
        add_limit(-g.swing.direction, true, joint.axis(4).restitution);
    if (rotors_[index] == no_place) return;
    const std::size_t k = joint.armature(0) > 0.0 ? 0 : 3;
    const Rate along = rate(g.coordinates[k].direction, k == 3);
    add_rotor(group, index, {index, g.coordinates[k].direction, k == 3, 0.0, along.offset, along.form});
}

void JoinedGroups::factor(Group& group) {
    std::vector<BlockCholesky::Pair> pairs;
    std::vector<std::uint32_t> pair_of;
    const std::span<const Lock> locks = std::span(locks_).subspan(group.first_lock, group.locks);
    std::vector<LockSides> sides(locks.size());
    for (std::size_t k = 0; k < locks.size(); ++k) {
        sides[k].add(locks[k].form, group.first);
        sides[k].add(locks[k].other, group.first);
        // The locks of one joint share their coupling.
        const bool same = k > 0 && locks[k].joint == locks[k - 1].joint && sides[k].count == sides[k - 1].count;
        pair_of.push_back(same ? pair_of.back() : std::uint32_t(pairs.size()));
        if (same) continue;
        sides[k].each_pair([&](const LockSides::Side& s, const LockSides::Side& t) {
            pairs.push_back({s.body, t.body});
        });
    }
    group.matrix.analyze(group.bodies, pairs);
    group.matrix.set_zero();
    for (std::uint32_t i = 0; i < group.bodies; ++i)
        for (int k = 0; k < 6; ++k) group.matrix.diagonal(i).row[k][k] = 1.0;
    for (std::size_t k = 0; k < locks.size(); ++k)
        add_square(group.matrix, pair_of[k], sides[k], 1.0 / impact_lock_compliance);
    group.matrix.factor();
}

void JoinedGroups::linearize(const std::vector<Body>& all, const std::vector<MassRoot>& roots) {
    locks_.clear();
    limits_.clear();
    points_.assign(joints_.size(), Vec3::Zero());
    other_points_.assign(joints_.size(), Vec3::Zero());
    bool moving = false;
    for (Group& group : groups_) {
        group.first_lock = locks_.size();
        group.locks = 0;
        for (const std::size_t k : group.joints) linearize_joint(group, k, all, roots);
        if (group.locks > 0) factor(group);
    }
    for (const Lock& lock : locks_) moving = moving || lock.offset != 0.0;
    given_.assign(locks_.size(), 0.0);
    asked_.assign(locks_.size(), 0.0);
    work_.setZero(6 * Eigen::Index(size()));
    carried_.resize(0);
    if (!moving) return;
    carried_.setZero(work_.size());
    for (Group& group : groups_) fit(group, carried_, true);
}

// Adds G^T f to y until G y = 0, or -offset with `carriers`; f in given_.
void JoinedGroups::fit(Group& group, Eigen::VectorXd& y, bool carriers) {
    const std::size_t begin = group.first_lock, end = begin + group.locks;
    std::fill(given_.begin() + std::ptrdiff_t(begin), given_.begin() + std::ptrdiff_t(end), 0.0);
    if (group.locks == 0) return;
    const double compliance = impact_lock_compliance;
    z_.resize(6 * group.bodies);
    Eigen::Map<Eigen::VectorXd> z(z_.data(), Eigen::Index(z_.size()));
    const auto at = [&](VelocityRow form) {  // within the group
        if (form.a != no_place) form.a -= group.first;
        if (form.b != no_place) form.b -= group.first;
        return form;
    };
    const auto part = y.segment(6 * Eigen::Index(group.first), 6 * Eigen::Index(group.bodies));
    double scale = part.norm(), last = infinity;
    for (int pass = 0; pass < impact_lock_passes; ++pass) {
        double worst = 0.0;
        for (std::size_t k = begin; k < end; ++k) {
            asked_[k] = -locks_[k].dot(y) - (carriers ? locks_[k].offset : 0.0);
            worst = std::max(worst, std::abs(asked_[k]));
        }
        if (pass == 0) scale = std::max(scale, worst);
        const double floor = impact_lock_rounding * scale;
        if (!(worst > floor) || (worst < 1e3 * floor && worst >= 0.5 * last)) return;
        last = worst;
        std::fill(z_.begin(), z_.end(), 0.0);
        for (std::size_t k = begin; k < end; ++k) {
            const auto add = [&](const VelocityRow& form) {
                if (form.a != no_place) z.segment<6>(6 * Eigen::Index(form.a)) += asked_[k] / compliance * form.on_a;
                if (form.b != no_place) z.segment<6>(6 * Eigen::Index(form.b)) += asked_[k] / compliance * form.on_b;
            };
            add(at(locks_[k].form));
            if (locks_[k].gear()) add(at(locks_[k].other));
        }
        group.matrix.solve(z_);
        for (std::size_t k = begin; k < end; ++k) {
            const double rest = at(locks_[k].form).dot(z) + (locks_[k].gear() ? at(locks_[k].other).dot(z) : 0.0);
            const double f = (asked_[k] - rest) / compliance;
            given_[k] += f;
            locks_[k].add_to(y, f);
        }
    }
}

void JoinedGroups::project(Eigen::VectorXd& y) {
    for (Group& group : groups_) fit(group, y, false);
}

JoinedRow JoinedGroups::project(const VelocityRow& form, std::uint32_t own, VelocityRow& row) {
    JoinedRow result;
    result.own = own;
    const auto place_of = [&](std::uint32_t place) {
        return place == no_place || !joined(place) ? place : groups_[group_of_[place]].first;
    };
    const auto bodies_of = [&](std::uint32_t place) {
        return place == no_place ? 0u : joined(place) ? groups_[group_of_[place]].bodies : 1u;
    };
    form.add_to(work_, 1.0);
    row = {};
    row.a = place_of(form.a);
    row.b = place_of(form.b);
    result.bodies_a = bodies_of(form.a);
    result.bodies_b = bodies_of(form.b);
    if (row.a == row.b) {
        row.b = no_place;
        result.bodies_b = 0;
    }
    for (const auto& [place, bodies] : {std::pair(row.a, result.bodies_a), std::pair(row.b, result.bodies_b)}) {
        if (place == no_place) continue;
        if (joined(place)) fit(groups_[group_of_[place]], work_, false);
        auto part = work_.segment(6 * Eigen::Index(place), 6 * Eigen::Index(bodies));
        result.numbers.insert(result.numbers.end(), part.data(), part.data() + part.size());
        part.setZero();
    }
    return result;
}

std::vector<JointImpulse> JoinedGroups::joint_impulses(Eigen::VectorXd& change) {
    std::vector<JointImpulse> joint_impulses(joints_.size());
    for (std::size_t k = 0; k < joints_.size(); ++k) {
        const bool gear = joints_[k]->gear();
        joint_impulses[k].joint = joints_[k];
        joint_impulses[k].at = gear ? &all_joints_[joints_[k]->description.geared[0]] : joints_[k];
        joint_impulses[k].point = points_[k];
    }
    project(change);
    for (std::size_t k = 0; k < locks_.size(); ++k) {
        const Lock& lock = locks_[k];
        const double impulse = given_[k] / lock.length;
        (lock.turns ? joint_impulses[lock.joint].torque : joint_impulses[lock.joint].force) += impulse * lock.direction;
        if (!lock.gear() || lock.rotor) continue;
        JointImpulse second;
        second.joint = joints_[lock.joint];
        second.at = &all_joints_[second.joint->description.geared[1]];
        second.second = true;
        second.point = other_points_[lock.joint];
        (lock.other_turns ? second.torque : second.force) = impulse * lock.other_direction;
        joint_impulses.push_back(second);
    }
    return joint_impulses;
}

}  // namespace tumble
