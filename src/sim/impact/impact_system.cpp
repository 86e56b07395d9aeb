#include "sim/impact/impact_system.h"

#include "sim/impact/settings.h"

#include <algorithm>
#include <cmath>

namespace tumble {
namespace {

// Lower Cholesky factor; a direction without compliance (a nonpositive pivot) gets a column of zeros.
Mat3 cholesky(const Mat3& m) {
    Mat3 g = Mat3::Zero();
    for (int j = 0; j < 3; ++j) {
        double pivot = m(j, j);
        for (int k = 0; k < j; ++k) pivot -= g(j, k) * g(j, k);
        if (!(pivot > 0.0)) continue;
        g(j, j) = std::sqrt(pivot);
        for (int i = j + 1; i < 3; ++i) {
            double sum = m(i, j);
            for (int k = 0; k < j; ++k) sum -= g(i, k) * g(j, k);
            g(i, j) = sum / g(j, j);
        }
    }
    return g;
}

}  // namespace

MassRoot::MassRoot(const Body& body)
    : translation(std::sqrt(body.inverse_mass)), turn(body.rotation * cholesky(body.inverse_inertia_body)) {}

Vec6 MassRoot::row(const Vec3& arm, const Vec3& direction) const {
    Vec6 w;
    w << translation * direction, turn.transpose() * arm.cross(direction);
    return w;
}

Vec6 MassRoot::weighted(const Body& body) const {
    // omega = R G y with G lower: forward substitution.
    const Mat3 g = body.rotation.transpose() * turn;
    const Vec3 spin = body.rotation.transpose() * body.angular_velocity;
    Vec6 y;
    y.head<3>() = translation > 0.0 ? Vec3(body.velocity / translation) : Vec3::Zero();
    for (int i = 0; i < 3; ++i) {
        double sum = spin[i];
        for (int k = 0; k < i; ++k) sum -= g(i, k) * y[3 + k];
        y[3 + i] = g(i, i) > 0.0 ? sum / g(i, i) : 0.0;
    }
    return y;
}

ImpactSystem::ImpactSystem(const Island& island, const std::vector<Contact>& contacts, const std::vector<Body>& bodies,
                           ImpactTrace* trace)
    : body_index_(island.bodies), contacts_(contacts), bodies_(bodies), trace_(trace) {
    roots_.reserve(island.bodies.size());
    velocity_.resize(6 * Eigen::Index(island.bodies.size()));
    for (std::size_t i = 0; i < island.bodies.size(); ++i) {
        const Body& body = bodies[island.bodies[i]];
        roots_.emplace_back(body);
        velocity_.segment<6>(6 * Eigen::Index(i)) = roots_.back().weighted(body);
    }
    start_ = velocity_;
    double fastest = 0.0, largest = 0.0, fastest_wall = 0.0, mass = 0.0;
    for (const std::uint32_t k : island.contacts) {
        const Contact& c = contacts[k];
        if (!c.touching()) continue;
        VelocityRow row = relative_row(c, c.normal);
        const double length = std::sqrt(row.squared_norm());
        if (!(length > 0.0)) continue;  // the contact has no mobility
        row.on_a /= length;
        row.on_b /= length;
        index_.push_back(k);
        rows_.push_back(row);
        length_.push_back(length);
        offset_.push_back(offset(c, c.normal) / length);
        fastest = std::max(fastest, std::abs(speed(rows_.size() - 1)));
        fastest_wall = std::max(fastest_wall, std::abs(offset_.back()) * length);
        for (const auto& [body, arm] : {std::pair(c.a, c.arm_a), std::pair(c.b, c.arm_b)})
            largest =
                std::max(largest, bodies[body].velocity.norm() + bodies[body].angular_velocity.norm() * arm.norm());
    }
    impulse_.assign(rows_.size(), 0.0);
    for (const std::uint32_t body : island.bodies) mass += bodies[body].mass;
    wall_velocity_ = std::sqrt(mass) * fastest_wall;
    rounding_ = tuning::approach_relative * fastest + tuning::approach_rounding * largest;
}

std::uint32_t ImpactSystem::place(std::uint32_t body) const {
    const auto found = std::lower_bound(body_index_.begin(), body_index_.end(), body);
    return found != body_index_.end() && *found == body ? std::uint32_t(found - body_index_.begin())
                                                        : VelocityRow::none;
}

VelocityRow ImpactSystem::relative_row(const Contact& c, const Vec3& direction) const {
    VelocityRow row;
    row.a = place(c.a);
    row.b = place(c.b);
    if (row.a != VelocityRow::none) row.on_a = -roots_[row.a].row(c.arm_a, direction);
    if (row.b != VelocityRow::none) row.on_b = roots_[row.b].row(c.arm_b, direction);
    return row;
}

double ImpactSystem::offset(const Contact& c, const Vec3& direction) const {
    const Body &a = bodies_[c.a], &b = bodies_[c.b];
    double sum = 0.0;
    if (!a.dynamic()) sum -= direction.dot(a.point_velocity(c.arm_a));
    if (!b.dynamic()) sum += direction.dot(b.point_velocity(c.arm_b));
    return sum;
}

void ImpactSystem::announce(std::size_t i, double amount, double restitution) {
    trace_->entries.push_back({index_[i], trace_->passes, speed(i), 0.0, restitution, amount / length_[i]});
    announced_.push_back(i);
}

void ImpactSystem::end_pass() {
    std::size_t entry = trace_->entries.size() - announced_.size();
    for (const std::size_t i : announced_) trace_->entries[entry++].speed_after = speed(i);
    announced_.clear();
    ++trace_->passes;
}

void ImpactSystem::store(std::vector<Contact>& contacts, std::vector<Body>& bodies) const {
    for (std::size_t i = 0; i < roots_.size(); ++i) {
        const Vec6 change = (velocity_ - start_).segment<6>(6 * Eigen::Index(i));
        if (change.isZero(0.0)) continue;
        Body& body = bodies[body_index_[i]];
        body.velocity += roots_[i].translation * change.head<3>();
        body.angular_velocity += roots_[i].turn * change.tail<3>();
    }
    for (std::size_t i = 0; i < rows_.size(); ++i) {
        Contact& c = contacts[index_[i]];
        c.impact = impulse_[i];
        if (c.impact > 0.0) c.bounce_velocity = std::max(0.0, speed(i));
    }
}

}  // namespace tumble
