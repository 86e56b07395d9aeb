#include "sim/log/contact_log.h"

#include <algorithm>
#include <utility>

namespace tumble {
namespace {

// A slip below this fraction of the speed that gravity gives the contact in a step counts as sticking: the solvers
// leave such speeds by their tolerances.
constexpr double stick_share = 1e-3;

Vec3 across(const Vec3& v, const Vec3& normal) { return v - normal.dot(v) * normal; }

ContactFeatures features_of(const PointGeometry& geometry, const CollisionShape& a, const CollisionShape& b,
                            int points) {
    if (std::holds_alternative<Ball>(a) || std::holds_alternative<Ball>(b)) return ContactFeatures::sphere;
    if (std::holds_alternative<CrossingEdges>(geometry)) return ContactFeatures::edge_edge;
    return points == 1   ? ContactFeatures::vertex_face
           : points == 2 ? ContactFeatures::edge_face
                         : ContactFeatures::face_face;
}

void add(ImpulseSum& sum, const Vec3& linear, const Vec3& angular) {
    sum.linear += linear;
    sum.angular += angular;
}

}  // namespace

ContactLog::ContactLog(std::span<const std::uint32_t> scene_index, const Vec3& origin, const Vec3& gravity)
    : scene_index_(scene_index.begin(), scene_index.end()),
      origin_(origin),
      gravity_(gravity),
      accounts_(scene_index.size()) {}

void ContactLog::begin_frame(const std::vector<Body>& bodies) {
    sums_.clear();
    records_ = {};
    for (std::size_t i = 0; i < bodies.size(); ++i)
        accounts_[i] = {{bodies[i].momentum, bodies[i].angular_momentum}, {}, {}, {}};
}

void ContactLog::add_entry(const ImpactTrace::Entry& entry, const Contact& c, const Vec3& point,
                           const std::vector<Body>& bodies, const ImpactTime& when) {
    ImpactRecord record;
    record.time = when.time;
    record.exact_time = when.exact;
    record.a = c.a;
    record.b = c.b;
    record.point = origin_ + point;
    record.normal = c.normal;
    record.features = features_of(c.geometry, bodies[c.a].collider, bodies[c.b].collider, c.points);
    record.speed_before = entry.speed_before;
    record.speed_after = entry.speed_after;
    record.restitution = entry.restitution;
    record.impulse = entry.impulse;
    record.pass = entry.pass;
    records_.impacts.push_back(record);
    const Vec3 j = entry.impulse * c.normal;
    add(accounts_[c.a].impacts, -j, -c.arm_a.cross(j));
    add(accounts_[c.b].impacts, j, c.arm_b.cross(j));
}

void ContactLog::add_impact(const ImpactTrace& trace, const std::vector<Contact>& contacts,
                            const std::vector<Body>& bodies, const ImpactTime& when) {
    for (std::size_t k = 0; k < trace.entries.size(); ++k) {
        const ImpactTrace::Entry& entry = trace.entries[k];
        const Contact& c = contacts[entry.contact];
        add_entry(entry, c, bodies[c.a].position + c.arm_a, bodies, when);
        const bool last = std::none_of(trace.entries.begin() + std::ptrdiff_t(k) + 1, trace.entries.end(),
                                       [&](const ImpactTrace::Entry& e) { return e.contact == entry.contact; });
        if (!last || c.impact_friction.isZero(0.0)) continue;
        ImpactRecord& record = records_.impacts.back();
        record.friction = c.impact_friction;
        record.friction_moment = c.rub.cross(c.impact_friction);
        const Vec3 &f = record.friction, &m = record.friction_moment;
        add(accounts_[c.a].impacts, -f, -(c.arm_a.cross(f) + m));
        add(accounts_[c.b].impacts, f, c.arm_b.cross(f) + m);
    }
}

void ContactLog::add_contacts(std::span<const std::uint32_t> manifolds, const ContactProblem& problem,
                              const std::vector<ManifoldImpulse>& totals) {
    for (const std::uint32_t k : manifolds) {
        const Manifold& m = problem.manifolds[k];
        const ManifoldImpulse& total = totals[k];
        if (total.on_b.isZero(0.0) && total.turn_a.isZero(0.0) && total.turn_b.isZero(0.0)) continue;
        const Body &a = problem.bodies[m.a], &b = problem.bodies[m.b];
        add(accounts_[m.a].contacts, -total.on_b, total.turn_a);
        add(accounts_[m.b].contacts, total.on_b, total.turn_b);
        // The solvers give a manifold one total impulse, and its points their parts of the last substep: the total is
        // divided alike.
        const double sum = normal_impulse(m);
        Vec3 moment_left = total.turn_b;
        const auto share = [&](int i) {
            return sum > 0.0 ? m.points[std::size_t(i)].impulse / sum : 1.0 / double(m.count);
        };
        const auto place = [&](int i) {
            const ContactPoint& p = m.points[std::size_t(i)];
            return acting_place(p.position, p.separation, m.normal, a.dynamic(), b.dynamic());
        };
        for (int i = 0; i < m.count; ++i) moment_left -= (place(i) - b.position).cross(share(i) * total.on_b);
        if (!b.dynamic()) {
            moment_left = -total.turn_a;
            for (int i = 0; i < m.count; ++i) moment_left -= (place(i) - a.position).cross(share(i) * total.on_b);
        }
        for (int i = 0; i < m.count; ++i) {
            if (!(share(i) > 0.0)) continue;
            const ContactPoint& p = m.points[std::size_t(i)];
            Sum& point = sums_[{m.a, m.b, m.part, p.feature}];
            const double normal = m.normal.dot(total.on_b);
            point.normal += share(i) * normal;
            point.tangential += share(i) * (total.on_b - normal * m.normal);
            point.moment += share(i) * moment_left;
            point.span += problem.patches.h;
            ContactRecord& r = point.last;
            r.a = m.a;
            r.b = m.b;
            r.point = origin_ + place(i);
            r.normal = m.normal;
            r.gap = p.separation;
            r.features = features_of(m.geometry, a.collider, b.collider, m.count);
            const Vec3 at = place(i);
            r.slip = across(b.point_velocity(at - b.position) - a.point_velocity(at - a.position), m.normal);
            const bool slides = r.slip.norm() > stick_share * gravity_.norm() * problem.patches.h;
            r.state = slides ? ContactRecord::State::slip : ContactRecord::State::stick;
        }
    }
}

void ContactLog::add_external(std::uint32_t body, const Impulse& impulse) {
    add(accounts_[body].external, impulse.linear, impulse.angular);
}

bool ContactLog::sleeping(const Key& key, const std::vector<Body>& bodies) const {
    const auto at_rest = [&](std::uint32_t i) { return bodies[i].asleep || !bodies[i].moves(); };
    return at_rest(key.a) && at_rest(key.b);
}

/// With indices of the scene, A before B.
ContactRecord ContactLog::oriented(ContactRecord r) const {
    r.a = scene_index_[r.a];
    r.b = scene_index_[r.b];
    if (r.a < r.b) return r;
    std::swap(r.a, r.b);
    for (Vec3* v : {&r.normal, &r.tangential_force, &r.moment, &r.slip}) *v = -*v;
    return r;
}

ContactRecords ContactLog::finish_frame(const std::vector<Body>& bodies, const ForceField& forces, double duration) {
    // Contacts of sleeping bodies keep the forces of their last frame.
    std::erase_if(asleep_,
                  [&](const auto& item) { return !sleeping(item.first, bodies) || sums_.contains(item.first); });
    for (const auto& [key, record] : asleep_) {
        const Vec3 j = duration * (record.normal_force * record.normal + record.tangential_force);
        const Vec3 m = duration * record.moment, at = record.point - origin_;
        add(accounts_[key.a].contacts, -j, -((at - bodies[key.a].position).cross(j) + m));
        add(accounts_[key.b].contacts, j, (at - bodies[key.b].position).cross(j) + m);
        records_.contacts.push_back(oriented(record));
    }
    for (auto& [key, sum] : sums_) {
        ContactRecord record = sum.last;
        const bool asleep = sleeping(key, bodies);
        const double span = asleep ? sum.span : duration;
        record.normal_force = sum.normal / span;
        record.tangential_force = sum.tangential / span;
        record.moment = sum.moment / span;
        if (asleep) {
            record.state = ContactRecord::State::asleep;
            record.slip.setZero();
            asleep_[key] = record;
            const double rest = std::max(0.0, duration - sum.span);
            const Vec3 j = rest * (record.normal_force * record.normal + record.tangential_force),
                       m = rest * record.moment;
            const Vec3 at = record.point - origin_;
            add(accounts_[key.a].contacts, -j, -((at - bodies[key.a].position).cross(j) + m));
            add(accounts_[key.b].contacts, j, (at - bodies[key.b].position).cross(j) + m);
        }
        records_.contacts.push_back(oriented(record));
    }
    std::stable_sort(records_.contacts.begin(), records_.contacts.end(),
                     [](const auto& l, const auto& r) { return std::tie(l.a, l.b) < std::tie(r.a, r.b); });
    for (ImpactRecord& r : records_.impacts) {
        r.a = scene_index_[r.a];
        r.b = scene_index_[r.b];
        if (r.a < r.b) continue;
        std::swap(r.a, r.b);
        for (Vec3* v : {&r.normal, &r.friction, &r.friction_moment}) *v = -*v;
    }
    for (std::uint32_t i = 0; i < bodies.size(); ++i) {
        const Body& body = bodies[i];
        if (!body.dynamic()) continue;
        Account& account = accounts_[i];
        account.external.linear += duration * body.mass * gravity_;
        const auto rest = [&](const Vec3 ImpulseSum::*part, const Vec3& now) {
            return Vec3(now - account.start.*part - account.external.*part - account.impacts.*part -
                        account.contacts.*part);
        };
        BalanceRecord record{
            scene_index_[i],
            account.external,
            account.impacts,
            account.contacts,
            {rest(&ImpulseSum::linear, body.momentum), rest(&ImpulseSum::angular, body.angular_momentum)}};
        // Forces on ballistic bodies act along their trajectories, not in steps: they are the rest.
        if (body.flying && !forces.only_gravity(i)) {
            add(record.external, record.corrections.linear, record.corrections.angular);
            record.corrections = {};
        }
        records_.balance.push_back(record);
    }
    std::sort(records_.balance.begin(), records_.balance.end(),
              [](const auto& l, const auto& r) { return l.body < r.body; });
    return std::move(records_);
}

}  // namespace tumble
