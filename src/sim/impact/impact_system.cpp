#include "sim/impact/impact_system.h"

#include "sim/impact/settings.h"

#include <algorithm>
#include <cmath>

namespace tumble {
namespace {

/// Approach speeds below this share of the largest relative speed of the impact system are rounding,
constexpr double approach_relative = 1e-13;

/// and those below this share of its largest speed. Not fitted: some ten units of rounding.
constexpr double approach_rounding = 4e-15;

/// An impulse counts, for friction and as a bounce, if it changes v_rel by more than this many times the rounding of
/// speeds: 1e-9 of the fastest approach. Not fitted: far above the rounding of positions and normals. Related test:
/// Rack.BouncesAsItsMirrorImage.
constexpr double impact_felt = 1e4;

}  // namespace
ImpactSystem::ImpactSystem(const Island& island, const std::vector<Contact>& contacts, const std::vector<Body>& bodies,
                           ImpactTrace* trace)
    : body_index_(island.bodies), contacts_(contacts), bodies_(bodies), trace_(trace) {
    std::vector<std::uint32_t> by_place = island.bodies;
    if (!island.joints.empty()) {
        groups_.emplace(island.bodies, island.joints, island.all_joints, bodies);
        by_place.assign(groups_->size(), island.bodies.front());  // of rotors: any
        for (std::size_t i = 0; i < island.bodies.size(); ++i) by_place[groups_->places()[i]] = island.bodies[i];
    }
    roots_.reserve(by_place.size());
    velocity_.resize(6 * Eigen::Index(by_place.size()));
    for (std::size_t i = 0; i < by_place.size(); ++i) {
        const Body& body = bodies[by_place[i]];
        roots_.emplace_back(body);
        velocity_.segment<6>(6 * Eigen::Index(i)) = roots_.back().weighted(body);
    }
    if (groups_) {
        groups_->linearize(bodies, roots_);
        groups_->turn_rotors(velocity_);
        groups_->project(velocity_);
        pushed_.setZero(velocity_.size());
    }
    start_ = velocity_;
    double fastest = 0.0, largest = 0.0, fastest_wall = 0.0, mass = 0.0;
    for (const std::uint32_t k : island.contacts) {
        const Contact& c = contacts[k];
        if (!c.touching()) continue;
        const VelocityRow row = relative_row(c, c.normal);
        const double length = std::sqrt(row.squared_norm());
        if (!(length > 0.0)) continue;  // the contact has no mobility
        index_.push_back(k);
        add_row(row, offset(c, c.normal));
        fastest = std::max(fastest, std::abs(speed(rows_.size() - 1)));
        fastest_wall = std::max(fastest_wall, std::abs(offset_.back()) * length);
        for (const auto& [body, arm] : {std::pair(c.a, c.arm_a), std::pair(c.b, c.arm_b)})
            largest =
                std::max(largest, bodies[body].velocity.norm() + bodies[body].angular_velocity.norm() * arm.norm());
    }
    if (groups_) add_limits();
    impulse_.assign(rows_.size(), 0.0);
    for (const std::uint32_t body : island.bodies) mass += bodies[body].mass;
    wall_velocity_ = std::sqrt(mass) * fastest_wall;
    rounding_ = approach_relative * fastest + approach_rounding * largest;
}

// A row from a form that is not of unit length, and the velocities of bodies that are not dynamic along it, m/s.
void ImpactSystem::add_row(const VelocityRow& form, double speed) {
    const double length = std::sqrt(form.squared_norm());
    VelocityRow row = form;
    row.on_a /= length;
    row.on_b /= length;
    if (row.joined) {
        VelocityRow& own = own_[row.joined->own];
        if (groups_->carried().size() > 0) speed += own.dot(groups_->carried());
        own.on_a /= length;
        own.on_b /= length;
        for (double& number : joined_rows_[row.joined->own].numbers) number /= length;
    }
    rows_.push_back(row);
    length_.push_back(length);
    offset_.push_back(speed / length);
}

// The limits that the joints are at are contacts without friction.
void ImpactSystem::add_limits() {
    for (std::size_t k = 0; k < groups_->limits().size(); ++k) {
        const JoinedGroups::Limit& limit = groups_->limits()[k];
        const VelocityRow row = join(limit.form);
        if (!(row.squared_norm() > 0.0)) continue;
        limit_.push_back(k);
        add_row(row, limit.offset);
    }
}

double ImpactSystem::work() const {
    std::uint32_t longest = 0;
    for (const VelocityRow& row : rows_) longest = std::max(longest, row.bodies_a() + row.bodies_b());
    return 6.0 * longest * double(size()) * double(size());
}

std::uint32_t ImpactSystem::place(std::uint32_t body) const {
    const auto found = std::lower_bound(body_index_.begin(), body_index_.end(), body);
    if (found == body_index_.end() || *found != body) return VelocityRow::none;
    const auto i = std::uint32_t(found - body_index_.begin());
    return groups_ ? groups_->places()[i] : i;
}

VelocityRow ImpactSystem::relative_row(const Contact& c, const Vec3& direction) {
    VelocityRow row;
    row.a = place(c.a);
    row.b = place(c.b);
    if (row.a != VelocityRow::none) row.on_a = -roots_[row.a].row(c.arm_a, direction);
    if (row.b != VelocityRow::none) row.on_b = roots_[row.b].row(c.arm_b, direction);
    if (!groups_ || !(joined(row.a) || joined(row.b))) return row;
    return join(row);
}

// The form of the groups; empty where the joints leave it no mobility but for rounding.
VelocityRow ImpactSystem::join(const VelocityRow& own) {
    VelocityRow row;
    joined_rows_.push_back(groups_->project(own, std::uint32_t(own_.size()), row));
    own_.push_back(own);
    row.joined = &joined_rows_.back();
    const double least = tuning::projection_dependent * tuning::projection_dependent * own.squared_norm();
    return row.squared_norm() > least ? row : VelocityRow{};
}

void ImpactSystem::apply_own(const VelocityRow& row, double amount) {
    if (row.joined) own_[row.joined->own].add_to(pushed_, row.joined->sign * amount);
}

double ImpactSystem::offset(const Contact& c, const Vec3& direction) const {
    const Body &a = bodies_[c.a], &b = bodies_[c.b];
    double sum = 0.0;
    if (!a.dynamic()) sum -= direction.dot(a.point_velocity(c.arm_a));
    if (!b.dynamic()) sum += direction.dot(b.point_velocity(c.arm_b));
    return sum;
}

void ImpactSystem::announce(std::size_t i, double amount, double restitution) {
    if (i >= contacts()) return;
    trace_->entries.push_back({index_[i], trace_->passes, speed(i), 0.0, restitution, amount / length_[i]});
    announced_.push_back(i);
}

bool ImpactSystem::felt(std::size_t i) const { return impulse_[i] * length_[i] * length_[i] > impact_felt * rounding_; }

void ImpactSystem::end_pass() {
    std::size_t entry = trace_->entries.size() - announced_.size();
    for (const std::size_t i : announced_) trace_->entries[entry++].speed_after = speed(i);
    announced_.clear();
    ++trace_->passes;
}

std::vector<JointImpulse> ImpactSystem::store_velocities(std::vector<Body>& bodies) {
    std::vector<JointImpulse> joint_impulses;
    if (groups_) {
        // The change that the sums of the impulses make: to rounding that of the rows.
        joint_impulses = groups_->joint_impulses(pushed_);
        for (std::uint32_t i = 0; i < roots_.size(); ++i)
            if (groups_->joined(i)) {
                const Eigen::Index first = 6 * Eigen::Index(i);
                velocity_.segment<6>(first) = start_.segment<6>(first) + pushed_.segment<6>(first);
            }
    }
    for (std::size_t k = 0; k < body_index_.size(); ++k) {
        const std::size_t i = groups_ ? groups_->places()[k] : k;
        const Vec6 change = (velocity_ - start_).segment<6>(6 * Eigen::Index(i));
        if (change.isZero(0.0)) continue;
        Body& body = bodies[body_index_[k]];
        body.velocity += roots_[i].translation * change.head<3>();
        body.angular_velocity += roots_[i].turn * change.tail<3>();
    }
    for (std::size_t k = 0; k < limit_.size(); ++k) {
        const JoinedGroups::Limit& limit = groups_->limits()[limit_[k]];
        const std::size_t row = contacts() + k;
        JointImpulse& impulse = joint_impulses[limit.joint];
        (limit.turns ? impulse.torque : impulse.force) += impulse_[row] * limit.size * limit.direction;
        impulse.lost -= 0.5 * impulse_[row] * (speed_at_start(row) + speed(row));
    }
    for (JointImpulse& impulse : joint_impulses) find_work(impulse, bodies);
    return joint_impulses;
}

std::vector<JointImpulse> ImpactSystem::store(std::vector<Contact>& contacts, std::vector<Body>& bodies) {
    std::vector<JointImpulse> joint_impulses = store_velocities(bodies);
    for (std::size_t i = 0; i < index_.size(); ++i) {
        Contact& c = contacts[index_[i]];
        c.impact = impulse_[i];
        if (felt(i)) c.bounce_velocity = std::max(0.0, speed(i));
    }
    return joint_impulses;
}

}  // namespace tumble
