#include "sim/impact/joined_groups.h"

#include "core/disjoint_sets.h"
#include "sim/impact/settings.h"
#include "sim/joints/joint_set.h"
#include "sim/joints/settings.h"

#include <algorithm>
#include <cmath>

namespace tumble {
namespace {

constexpr std::uint32_t no_place = VelocityRow::none;

// Position in an ascending list; no_place if absent.
std::uint32_t position_in(std::span<const std::uint32_t> list, std::uint32_t value) {
    const auto found = std::lower_bound(list.begin(), list.end(), value);
    return found != list.end() && *found == value ? std::uint32_t(found - list.begin()) : no_place;
}

// n . (velocity of B's point - velocity of A's point), or of the angular velocities, as a form of y and an offset.
struct Rate {
    VelocityRow form;
    double offset = 0.0;
};

// Matrix += weight form form^T; `pair`: index of the coupling, if both bodies have places.
void add_square(BlockCholesky& matrix, std::uint32_t first, std::uint32_t pair, const VelocityRow& form,
                double weight) {
    using Eight = BlockCholesky::Row;
    const auto add = [&](BlockCholesky::Block& to, const Vec6& left, const Vec6& w) {
        const Eight right = weight * Eight{w[0], w[1], w[2], w[3], w[4], w[5], 0.0, 0.0};
        for (int k = 0; k < 6; ++k) to.row[k] += left[k] * right;
    };
    if (form.a != no_place) add(matrix.diagonal(form.a - first), form.on_a, form.on_a);
    if (form.b != no_place) add(matrix.diagonal(form.b - first), form.on_b, form.on_b);
    if (form.a == no_place || form.b == no_place) return;
    if (matrix.transposed(pair))
        add(matrix.coupling(pair), form.on_b, form.on_a);
    else
        add(matrix.coupling(pair), form.on_a, form.on_b);
}

}  // namespace

JoinedGroups::JoinedGroups(std::span<const std::uint32_t> bodies, const std::vector<Joint*>& joints,
                           const std::vector<Body>& all)
    : bodies_(bodies.begin(), bodies.end()),
      places_(bodies.size()),
      group_of_(bodies.size(), no_place),
      joints_(joints) {
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
    std::uint32_t first = 0;
    for (Group& g : groups_) {
        g.first = first;
        first += g.bodies;
    }
    std::vector<std::uint32_t> next(groups_.size(), 0);
    for (std::uint32_t i = 0; i < n; ++i) {
        places_[i] = groups_[group[i]].first + next[group[i]]++;
        group_of_[places_[i]] = has_joint[i] ? group[i] : no_place;
    }
    for (std::size_t k = 0; k < joints.size(); ++k) {
        const std::uint32_t a = index(joints[k]->a), b = index(joints[k]->b);
        if (a != no_place || b != no_place) groups_[group[a != no_place ? a : b]].joints.push_back(k);
    }
}

void JoinedGroups::load_joint(Group& group, std::size_t index, const std::vector<Body>& all,
                              const std::vector<MassRoot>& roots) {
    const Joint& joint = *joints_[index];
    const JointGeometry g = measure(joint, side_of(all, joint.a), side_of(all, joint.b));
    points_[index] = g.point;
    const auto rate_of = [&](const Vec3& direction, bool turns) {
        Rate rate;
        const auto side = [&](std::uint32_t body, double sign, std::uint32_t& place, Vec6& on) {
            if (body == Joint::world) return;
            const Body& b = all[body];
            const Vec3 arm = g.point - b.position;
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
    };
    const auto add_limit = [&](const Vec3& direction, bool turns, double restitution) {
        const double size = turns ? joint.size : 1.0;
        Rate rate = rate_of(direction, turns);
        rate.form.on_a *= size;
        rate.form.on_b *= size;
        limits_.push_back({index, direction, turns, size, rate.form, size * rate.offset, restitution});
    };
    for (std::size_t k = 0; k < joint.count(); ++k) {
        const auto& [direction, value] = g.coordinates[k];
        const bool turns = k >= 3;
        if (joint.locked(k)) {
            Rate rate = rate_of(direction, turns);
            const double length = std::sqrt(rate.form.squared_norm());
            if (!(length > 0.0)) continue;
            rate.form.on_a /= length;
            rate.form.on_b /= length;
            locks_.push_back({index, direction, turns, length, rate.offset / length, rate.form});
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
        add_limit(-g.swing.direction, true, 0.0);
}

void JoinedGroups::factor(Group& group) {
    std::vector<BlockCholesky::Pair> pairs;
    std::vector<std::uint32_t> pair_of;
    const std::span<const Lock> locks = std::span(locks_).subspan(group.first_lock, group.locks);
    for (const Lock& lock : locks) {
        const VelocityRow& form = lock.form;
        const bool both = form.a != no_place && form.b != no_place;
        pair_of.push_back(no_place);
        if (!both) continue;
        const BlockCholesky::Pair pair{form.a - group.first, form.b - group.first};
        if (pairs.empty() || !(pairs.back() == pair)) pairs.push_back(pair);
        pair_of.back() = std::uint32_t(pairs.size() - 1);
    }
    group.matrix.analyze(group.bodies, pairs);
    group.matrix.set_zero();
    for (std::uint32_t i = 0; i < group.bodies; ++i)
        for (int k = 0; k < 6; ++k) group.matrix.diagonal(i).row[k][k] = 1.0;
    for (std::size_t k = 0; k < locks.size(); ++k)
        add_square(group.matrix, group.first, pair_of[k], locks[k].form, 1.0 / tuning::impact_lock_compliance);
    group.matrix.factor();
}

void JoinedGroups::load(const std::vector<Body>& all, const std::vector<MassRoot>& roots) {
    locks_.clear();
    limits_.clear();
    points_.assign(joints_.size(), Vec3::Zero());
    bool moving = false;
    for (Group& group : groups_) {
        group.first_lock = locks_.size();
        group.locks = 0;
        for (const std::size_t k : group.joints) load_joint(group, k, all, roots);
        if (group.locks > 0) factor(group);
    }
    for (const Lock& lock : locks_) moving = moving || lock.offset != 0.0;
    given_.assign(locks_.size(), 0.0);
    asked_.assign(locks_.size(), 0.0);
    work_.setZero(6 * Eigen::Index(places_.size()));
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
    const double compliance = tuning::impact_lock_compliance;
    z_.resize(6 * group.bodies);
    Eigen::Map<Eigen::VectorXd> z(z_.data(), Eigen::Index(z_.size()));
    const auto at = [&](const VelocityRow& form) {  // within the group
        VelocityRow local = form;
        if (local.a != no_place) local.a -= group.first;
        if (local.b != no_place) local.b -= group.first;
        return local;
    };
    const auto part = y.segment(6 * Eigen::Index(group.first), 6 * Eigen::Index(group.bodies));
    double scale = part.norm(), last = infinity;
    for (int pass = 0; pass < tuning::impact_lock_passes; ++pass) {
        double worst = 0.0;
        for (std::size_t k = begin; k < end; ++k) {
            asked_[k] = -locks_[k].form.dot(y) - (carriers ? locks_[k].offset : 0.0);
            worst = std::max(worst, std::abs(asked_[k]));
        }
        if (pass == 0) scale = std::max(scale, worst);
        const double floor = tuning::impact_lock_rounding * scale;
        if (!(worst > floor) || (worst < 1e3 * floor && worst >= 0.5 * last)) return;
        last = worst;
        std::fill(z_.begin(), z_.end(), 0.0);
        for (std::size_t k = begin; k < end; ++k) {
            const VelocityRow form = at(locks_[k].form);
            if (form.a != no_place) z.segment<6>(6 * Eigen::Index(form.a)) += asked_[k] / compliance * form.on_a;
            if (form.b != no_place) z.segment<6>(6 * Eigen::Index(form.b)) += asked_[k] / compliance * form.on_b;
        }
        group.matrix.solve(z_);
        for (std::size_t k = begin; k < end; ++k) {
            const double f = (asked_[k] - at(locks_[k].form).dot(z)) / compliance;
            given_[k] += f;
            locks_[k].form.add_to(y, f);
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

std::vector<JointBlow> JoinedGroups::blows(Eigen::VectorXd& change) {
    std::vector<JointBlow> blows(joints_.size());
    for (std::size_t k = 0; k < joints_.size(); ++k) {
        blows[k].joint = joints_[k];
        blows[k].point = points_[k];
    }
    project(change);
    for (std::size_t k = 0; k < locks_.size(); ++k) {
        const Lock& lock = locks_[k];
        (lock.turns ? blows[lock.joint].torque : blows[lock.joint].force) += given_[k] / lock.length * lock.direction;
    }
    return blows;
}

}  // namespace tumble
