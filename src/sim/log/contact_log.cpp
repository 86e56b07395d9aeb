#include "sim/log/contact_log.h"

#include "sim/contact/model/rotational_friction.h"
#include "sim/contact/rolling/rolling_contact.h"

#include <algorithm>
#include <tuple>
#include <utility>

namespace tumble {
namespace {

// A slip below this fraction of the speed that gravity gives in a step counts as sticking: the solvers leave such
// speeds by their tolerances.
constexpr double stick_share = 1e-3;
// Corrections below this fraction of a body's impulses, or moments, in the frame are rounding.
constexpr double correction_rounding = 1e-13;
constexpr std::size_t none = SIZE_MAX;

Vec3 across(const Vec3& v, const Vec3& normal) { return v - normal.dot(v) * normal; }

ContactFeatures features_of(Corners corners, GeometryKind kind, int points, const Body& a, const Body& b) {
    const auto has = [of_a = contact_surface(a.collider), of_b = contact_surface(b.collider)](ContactSurface surface) {
        return of_a == surface || of_b == surface;
    };
    if (has(ContactSurface::triangles)) return ContactFeatures::mesh;
    const bool edges = kind == GeometryKind::crossing_edges;
    if (has(ContactSurface::curved) || (kind != GeometryKind::none && !edges)) return ContactFeatures::sphere;
    if (edges && points == 1) return ContactFeatures::edge_edge;
    if (points > 2 && !has(ContactSurface::plane)) return ContactFeatures::face_face;
    return corners == Corners::of_a ? ContactFeatures::vertex_face : ContactFeatures::face_vertex;
}

ContactFeatures swapped(ContactFeatures features) {
    if (features == ContactFeatures::vertex_face) return ContactFeatures::face_vertex;
    if (features == ContactFeatures::face_vertex) return ContactFeatures::vertex_face;
    return features;
}

/// Subtracts an impulse (about the body's center) from the velocities before an impact.
void add_before(StruckBody& struck, const Body& body, const Impulse& impulse) {
    if (!body.dynamic()) return;
    struck.velocity_before -= body.inverse_mass * impulse.linear;
    struck.angular_velocity_before -= body.inverse_inertia * impulse.angular;
}

/// A body after an impact, with the velocities after it as those before.
StruckBody struck_body(const Body& body) {
    return {body.position, body.orientation,      body.velocity,
            body.velocity, body.angular_velocity, body.angular_velocity};
}

Vec3 acting_point_of(const Manifold& m, int i, const Body& a, const Body& b) {
    const ContactPoint& p = m.points[std::size_t(i)];
    return acting_point(p.position, p.separation, m.normal, a.dynamic(), b.dynamic());
}

Vec3 slip_at(const Vec3& point, const Vec3& normal, const Body& a, const Body& b) {
    return across(b.point_velocity(point - b.position) - a.point_velocity(point - a.position), normal);
}

}  // namespace

ContactLog::ContactLog(std::span<const std::uint32_t> scene_index, const Vec3& origin, const Vec3& gravity,
                       Detail detail)
    : detail_(detail),
      scene_index_(scene_index.begin(), scene_index.end()),
      origin_(origin),
      gravity_(gravity),
      accounts_(scene_index.size()),
      struck_(detail == Detail::records ? scene_index.size() : 0, none) {}

Impulse ContactLog::momenta(const Body& body, const Vec3& place, const Vec3& momentum) const {
    return {momentum, (origin_ + place).cross(momentum) + body.angular_momentum};
}

void ContactLog::add_contact(std::uint32_t a, std::uint32_t b, const Impulse& on_b) {
    const double moment = on_b.angular.norm();
    accounts_[a].contact = accounts_[a].contact - on_b;
    accounts_[b].contact = accounts_[b].contact + on_b;
    accounts_[a].moments += moment;
    accounts_[b].moments += moment;
}

double ContactLog::energy(const Body& body) const {
    return body.kinetic_energy() - body.mass * body.fall(gravity_).dot(body.position);
}

void ContactLog::begin_frame(const std::vector<Body>& bodies) {
    sums_.clear();
    records_.impacts.clear();
    records_.struck.clear();
    records_.contacts.clear();
    records_.loads.clear();
    friction_ = handed_over_ = surface_ = 0.0;
    for (std::size_t i = 0; i < bodies.size(); ++i) {
        accounts_[i] = {};
        if (!bodies[i].dynamic()) continue;
        accounts_[i].start = momenta(bodies[i]);
        accounts_[i].energy = energy(bodies[i]);
        start_flight(std::uint32_t(i), bodies[i]);
    }
}

void ContactLog::add_entry(const ImpactTrace::Entry& entry, const Contact& c, const Vec3& point,
                           const std::vector<Body>& bodies, const ImpactTime& when) {
    if (!has_records()) return add_struck_work(c, entry.impulse * c.normal, bodies);
    StruckBody a = struck_body(bodies[c.a]), b = struck_body(bodies[c.b]);
    const Vec3 j = entry.impulse * c.normal;
    add_before(a, bodies[c.a], {-j, -c.arm_a.cross(j)});
    add_before(b, bodies[c.b], {j, c.arm_b.cross(j)});
    add_entry(entry, c, point, bodies, when, a, b);
}

void ContactLog::add_entry(const ImpactTrace::Entry& entry, const Contact& c, const Vec3& point,
                           const std::vector<Body>& bodies, const ImpactTime& when, const StruckBody& a,
                           const StruckBody& b) {
    if (!has_records()) return add_struck_work(c, entry.impulse * c.normal, bodies);
    struck_[c.a] = records_.struck.size();
    struck_[c.b] = records_.struck.size() + 1;
    for (StruckBody struck : {a, b}) {
        struck.position += origin_;
        records_.struck.push_back(struck);
    }
    add_record(entry, c, point, bodies, when);
    struck_[c.a] = struck_[c.b] = none;
}

/// The bodies of an impact: each impulse is subtracted once.
void ContactLog::add_struck(const ImpactTrace& trace, const std::vector<Contact>& contacts,
                            const std::vector<Body>& bodies, std::span<const JointImpulse> joint_impulses) {
    const auto at = [&](std::uint32_t body) -> StruckBody& {
        if (struck_[body] == none) {
            struck_[body] = records_.struck.size();
            records_.struck.push_back(struck_body(bodies[body]));
            records_.struck.back().position += origin_;
        }
        return records_.struck[struck_[body]];
    };
    for (const ImpactTrace::Entry& entry : trace.entries) {
        const Contact& c = contacts[entry.contact];
        const Vec3 j = entry.impulse * c.normal;
        add_before(at(c.a), bodies[c.a], {-j, -c.arm_a.cross(j)});
        add_before(at(c.b), bodies[c.b], {j, c.arm_b.cross(j)});
    }
    for (const JointImpulse& impulse : joint_impulses)
        for (const auto& [body, sign] : {std::pair(impulse.at->a, -1.0), std::pair(impulse.at->b, 1.0)}) {
            if (body == Joint::world || struck_[body] == none) continue;
            const Vec3 turn = (impulse.point - bodies[body].position).cross(impulse.force) + impulse.torque;
            add_before(records_.struck[struck_[body]], bodies[body], {sign * impulse.force, sign * turn});
        }
}

void ContactLog::add_record(const ImpactTrace::Entry& entry, const Contact& c, const Vec3& point,
                            const std::vector<Body>& bodies, const ImpactTime& when) {
    const Body &a = bodies[c.a], &b = bodies[c.b];
    ImpactRecord record;
    record.when = when;
    record.a = c.a;
    record.b = c.b;
    record.point = origin_ + point;
    record.normal = c.normal;
    record.features = features_of(c.corners, c.kind, c.points, a, b);
    record.speed_before = entry.speed_before;
    record.speed_after = entry.speed_after;
    record.restitution = entry.restitution;
    record.impulse = entry.impulse;
    record.pass = entry.pass;
    const Vec3 j = entry.impulse * c.normal;
    record.moment = record.point.cross(j);
    record.struck_a = struck_[c.a];
    record.struck_b = struck_[c.b];
    records_.impacts.push_back(record);
    add_contact(c.a, c.b, {j, record.moment});
    add_struck_work(c, j, bodies);
}

void ContactLog::add_struck_work(const Contact& c, const Vec3& j, const std::vector<Body>& bodies) {
    const Body &a = bodies[c.a], &b = bodies[c.b];
    accounts_[c.a].touched = accounts_[c.b].touched = true;
    if (!a.dynamic()) accounts_[c.b].work += j.dot(a.point_velocity(c.arm_a));
    if (!b.dynamic()) accounts_[c.a].work -= j.dot(b.point_velocity(c.arm_b));
}

void ContactLog::add_impact(const ImpactTrace& trace, const std::vector<Contact>& contacts,
                            const std::vector<Body>& bodies, const ImpactTime& when,
                            std::span<const JointImpulse> joint_impulses) {
    if (!has_records()) {
        for (const ImpactTrace::Entry& entry : trace.entries) {
            const Contact& c = contacts[entry.contact];
            add_struck_work(c, entry.impulse * c.normal, bodies);
        }
        return;
    }
    add_struck(trace, contacts, bodies, joint_impulses);
    for (std::size_t k = 0; k < trace.entries.size(); ++k) {
        const ImpactTrace::Entry& entry = trace.entries[k];
        const Contact& c = contacts[entry.contact];
        add_record(entry, c, bodies[c.a].position + c.arm_a, bodies, when);
        const bool last = std::none_of(trace.entries.begin() + std::ptrdiff_t(k) + 1, trace.entries.end(),
                                       [&](const ImpactTrace::Entry& e) { return e.contact == entry.contact; });
        if (!last) continue;
        if (c.impact_friction.isZero(0.0)) continue;
        ImpactRecord& record = records_.impacts.back();
        const Vec3 moment = (record.point + c.rub).cross(c.impact_friction);
        const Vec3 &f = c.impact_friction, arm_a = c.arm_a + c.rub, arm_b = c.arm_b + c.rub;
        add_before(records_.struck[record.struck_a], bodies[c.a], {-f, -arm_a.cross(f)});
        add_before(records_.struck[record.struck_b], bodies[c.b], {f, arm_b.cross(f)});
        record.friction = c.impact_friction;
        record.moment += moment;
        add_contact(c.a, c.b, {c.impact_friction, moment});
    }
    for (const ImpactTrace::Entry& entry : trace.entries)
        struck_[contacts[entry.contact].a] = struck_[contacts[entry.contact].b] = none;
}

void ContactLog::set_place(ContactRecord& record, const Manifold& m, int i, const std::vector<Body>& bodies) const {
    const Body &a = bodies[m.a], &b = bodies[m.b];
    const Vec3 at = acting_point_of(m, i, a, b);
    record.a = m.a;
    record.b = m.b;
    record.point = origin_ + at;
    record.normal = m.normal;
    record.gap = m.points[std::size_t(i)].separation;
    record.features = features_of(m.corners, m.kind, m.count, a, b);
    record.slip = slip_at(at, m.normal, a, b);
}

void ContactLog::add_contacts(std::span<const std::uint32_t> manifolds, const ContactProblem& problem,
                              const std::vector<ManifoldImpulse>& totals) {
    for (const std::uint32_t k : manifolds) {
        const Manifold& m = problem.manifolds[k];
        const ManifoldImpulse& total = totals[k];
        if (total.on_b.isZero(0.0) && total.turn_a.isZero(0.0) && total.turn_b.isZero(0.0)) continue;
        const Body &a = problem.bodies[m.a], &b = problem.bodies[m.b];
        accounts_[m.a].touched = accounts_[m.b].touched = true;
        if (!a.dynamic()) accounts_[m.b].work += total.on_b.dot(a.velocity) - total.turn_a.dot(a.angular_velocity);
        if (!b.dynamic()) accounts_[m.a].work -= total.on_b.dot(b.velocity) + total.turn_b.dot(b.angular_velocity);
        // The solvers give a manifold one total impulse, and its points their parts of the last substep: the total is
        // divided alike.
        const double sum = normal_impulse(m);
        const auto share = [&](int i) {
            return sum > 0.0 ? m.points[std::size_t(i)].impulse / sum : 1.0 / double(m.count);
        };
        const auto place = [&](int i) { return acting_point_of(m, i, a, b); };
        // The moment that forces at the points leave over, about the center of a body that moves.
        const bool about_b = b.dynamic();
        Vec3 left = about_b ? total.turn_b : Vec3(-total.turn_a);
        for (int i = 0; i < m.count; ++i)
            left -= (place(i) - (about_b ? b.position : a.position)).cross(share(i) * total.on_b);
        const double torsion = m.normal.dot(left);
        const double turn = m.normal.dot(b.angular_velocity - a.angular_velocity);
        if (has_rotational_friction(a) || has_rotational_friction(b))
            friction_ -= across(left, m.normal).dot(b.angular_velocity - a.angular_velocity);
        for (int i = 0; i < m.count; ++i) {
            if (!(share(i) > 0.0)) continue;
            const Vec3 slip = slip_at(place(i), m.normal, a, b);
            friction_ -= share(i) * (across(total.on_b, m.normal).dot(slip) + torsion * turn);
            if (!has_records()) continue;
            Sum& point = sums_[key_of(m, i)];
            const Vec3 force = share(i) * total.on_b;
            const Impulse impulse{force, (origin_ + place(i)).cross(force) + share(i) * left};
            point.impulse = point.impulse + impulse;
            add_contact(m.a, m.b, impulse);
            point.torsion += share(i) * torsion;
            point.span += problem.settings.h;
            point.stick_speed = stick_share * gravity_.norm() * problem.settings.h;
            set_place(point.last, m, i, problem.bodies);
        }
    }
}

void ContactLog::add_rolled(const RolledContact& rolled, const std::vector<Manifold>& manifolds,
                            const std::vector<Body>& bodies, double span) {
    const Manifold& m = manifolds[rolled.manifold];
    accounts_[rolled.body].touched = true;
    friction_ += rolled.slipped;
    if (!has_records()) return;
    const Impulse on_body{rolled.impulse.linear, origin_.cross(rolled.impulse.linear) + rolled.impulse.angular};
    const Impulse on_b = m.b == rolled.body ? on_body : Impulse{} - on_body;
    for (int i = 0; i < m.count; ++i) {
        if (!(m.points[std::size_t(i)].impulse > 0.0)) continue;
        Sum& point = sums_[key_of(m, i)];
        point.impulse = point.impulse + on_b;
        add_contact(m.a, m.b, on_b);
        point.span += span;
        point.stick_speed = stick_share * gravity_.norm() * span;
        set_place(point.last, m, i, bodies);
    }
}

void ContactLog::add_joint(std::uint32_t a, std::uint32_t b, const Impulse& on_b, double work_a, double work_b) {
    const Impulse impulse{on_b.linear, origin_.cross(on_b.linear) + on_b.angular};
    const auto add = [&](std::uint32_t body, const Impulse& on_body, double work) {
        if (body == nobody) return;
        Account& account = accounts_[body];
        account.contact = account.contact + on_body;
        account.moments += on_body.angular.norm();
        account.joints += work;
    };
    add(a, Impulse{} - impulse, work_a);
    add(b, impulse, work_b);
}

void ContactLog::add_load(Account& account, const Impulse& impulse) {
    account.external = account.external + impulse;
    account.moments += impulse.angular.norm();
}

void ContactLog::add_gravity(std::uint32_t index, const Body& body, double span, const Vec3& place) {
    const Vec3 impulse = span * body.mass * body.fall(gravity_);
    add_load(accounts_[index], {impulse, (origin_ + place).cross(impulse)});
}

void ContactLog::add_external(std::uint32_t index, const Impulse& impulse, const Vec3& place,
                              const BodyVelocity& mean) {
    Account& account = accounts_[index];
    add_load(account, {impulse.linear, (origin_ + place).cross(impulse.linear) + impulse.angular});
    account.work += impulse.linear.dot(mean.velocity) + impulse.angular.dot(mean.angular_velocity);
}

void ContactLog::start_flight(std::uint32_t index, const Body& body) {
    start_flight(index, body, body.position, body.momentum);
    accounts_[index].flight_energy = energy(body);
}

void ContactLog::start_flight(std::uint32_t index, const Body& body, const Vec3& place, const Vec3& momentum) {
    accounts_[index].flight = momenta(body, place, momentum);
}

void ContactLog::end_flight(std::uint32_t index, const Body& body, bool driven) {
    end_flight(index, body, body.position, body.momentum);
    const double now = energy(body);
    Account& account = accounts_[index];
    if (driven) account.work += now - account.flight_energy;
    account.flight_energy = now;
}

void ContactLog::end_flight(std::uint32_t index, const Body& body, const Vec3& place, const Vec3& momentum) {
    const Impulse end = momenta(body, place, momentum);
    add_load(accounts_[index], end - accounts_[index].flight);
    accounts_[index].flight = end;
}

bool ContactLog::at_rest(const Key& key, const std::vector<Body>& bodies) const {
    const auto rests = [&](std::uint32_t i) { return bodies[i].asleep || !bodies[i].moves(); };
    return rests(key.a) && rests(key.b);
}

// Gives known points their present positions, and adds those without load.
void ContactLog::add_touching(const std::vector<Manifold>& touching, const std::vector<Body>& bodies) {
    for (const Manifold& m : touching)
        for (int i = 0; i < m.count; ++i) {
            const Key key = key_of(m, i);
            if (asleep_.contains(key) && at_rest(key, bodies)) continue;
            set_place(sums_[key].last, m, i, bodies);
        }
}

// The forces of a point: means over the frame, or over its time with contact if it sleeps from now on.
ContactRecord ContactLog::mean(const Key& key, Sum& sum, const std::vector<Body>& bodies, double duration) {
    ContactRecord r = sum.last;
    if (!(sum.span > 0.0)) return r;
    const bool sleeps = at_rest(key, bodies);
    const double span = sleeps ? sum.span : duration;
    // The normal may have turned during the frame: the whole force stays the same.
    const Vec3 force = sum.impulse.linear / span;
    r.moment = sum.impulse.angular / span;
    r.normal_force = r.normal.dot(force);
    r.tangential_force = force - r.normal_force * r.normal;
    r.torsion = sum.torsion / span;
    r.state = r.slip.norm() > sum.stick_speed ? ContactRecord::State::slip : ContactRecord::State::stick;
    if (!sleeps) return r;
    r.state = ContactRecord::State::asleep;
    r.slip.setZero();
    asleep_[key] = r;
    const double rest = std::max(0.0, duration - sum.span);
    add_contact(key.a, key.b, {rest * force, rest * r.moment});
    return r;
}

void ContactLog::add_loads(const std::vector<Body>& bodies, double duration) {
    for (std::uint32_t i = 0; i < bodies.size(); ++i) {
        if (!bodies[i].dynamic()) continue;
        const Impulse& sum = accounts_[i].external;
        const double rate = duration > 0.0 ? 1.0 / duration : 0.0;
        records_.loads.push_back({i, rate * sum.linear, rate * sum.angular});
    }
}

void ContactLog::add_corrections(const std::vector<Body>& bodies, double duration) {
    if (!(duration > 0.0)) return;
    for (std::uint32_t i = 0; i < bodies.size(); ++i) {
        const Body& body = bodies[i];
        if (!body.dynamic()) continue;
        const Account& account = accounts_[i];
        const Impulse end = momenta(body);
        const Impulse left = end - account.start - account.external - account.contact;
        const auto linear = [](const Impulse& impulse) { return impulse.linear.norm(); };
        const double impulses =
            linear(end) + linear(account.start) + linear(account.external) + linear(account.contact);
        const double moments = end.angular.norm() + account.start.angular.norm() + account.moments;
        const bool pushed = linear(left) > correction_rounding * impulses;
        if (!pushed && left.angular.norm() <= correction_rounding * moments) continue;
        ContactRecord r;
        r.a = ContactRecord::nobody;
        r.b = i;
        r.point = origin_ + body.position;
        r.normal = (pushed ? left.linear : left.angular).normalized();
        r.normal_force = pushed ? linear(left) / duration : 0.0;
        r.moment = left.angular / duration;
        r.state = body.asleep ? ContactRecord::State::asleep : ContactRecord::State::stick;
        records_.contacts.push_back(r);
    }
}

void ContactLog::hand_over(std::uint32_t whole, bool was_dynamic, std::span<const std::uint32_t> pieces,
                           const std::vector<Body>& bodies) {
    Account& account = accounts_[whole];
    double now = 0.0;
    for (const std::uint32_t i : pieces)
        if (bodies[i].dynamic()) {
            now += energy(bodies[i]);
            if (!was_dynamic) now -= bodies[i].mass * bodies[i].fall(gravity_).dot(origin_);
        }
    if (!was_dynamic)
        records_.energy.work += now;
    else if (account.touched)
        handed_over_ -= now - account.energy - account.work - account.joints;
    records_.energy.work += account.work;
    account = {};
    for (const std::uint32_t i : pieces) {
        accounts_[i] = {};
        if (!bodies[i].dynamic()) continue;
        accounts_[i].start = momenta(bodies[i]);
        accounts_[i].energy = energy(bodies[i]);
        start_flight(i, bodies[i]);
    }
}

void ContactLog::add_surface(double energy, std::span<const std::uint32_t> struck) {
    surface_ += energy;
    for (const std::uint32_t i : struck) accounts_[i].touched = true;
}

// Bodies in free flight lose nothing: a change of their energy is an error of the integrator.
void ContactLog::add_losses(const std::vector<Body>& bodies) {
    double lost = handed_over_ - surface_;
    for (std::size_t i = 0; i < bodies.size(); ++i) {
        if (!bodies[i].dynamic()) continue;
        records_.energy.work += accounts_[i].work - accounts_[i].water;
        records_.energy.water_loss -= accounts_[i].water;
        if (accounts_[i].touched)
            lost -= energy(bodies[i]) - accounts_[i].energy - accounts_[i].work - accounts_[i].joints;
    }
    records_.energy.friction_loss += friction_;
    records_.energy.impact_loss += lost - friction_;
    records_.energy.surface += surface_;
}

// With indices of the scene, A before B.
void ContactLog::name_by_scene() {
    for (ContactRecord& r : records_.contacts) {
        r.b = scene_index_[r.b];
        if (r.a == ContactRecord::nobody) continue;
        r.a = scene_index_[r.a];
        if (r.a < r.b) continue;
        std::swap(r.a, r.b);
        r.features = swapped(r.features);
        for (Vec3* v : {&r.normal, &r.tangential_force, &r.slip, &r.moment}) *v = -*v;
    }
    std::stable_sort(records_.contacts.begin(), records_.contacts.end(),
                     [](const auto& l, const auto& r) { return std::tie(l.a, l.b) < std::tie(r.a, r.b); });
    for (ImpactRecord& r : records_.impacts) {
        r.a = scene_index_[r.a];
        r.b = scene_index_[r.b];
        if (r.a < r.b) continue;
        std::swap(r.a, r.b);
        std::swap(r.struck_a, r.struck_b);
        r.features = swapped(r.features);
        for (Vec3* v : {&r.normal, &r.friction, &r.moment}) *v = -*v;
    }
    for (ExternalLoad& load : records_.loads) load.body = scene_index_[load.body];
    std::sort(records_.loads.begin(), records_.loads.end(),
              [](const ExternalLoad& l, const ExternalLoad& r) { return l.body < r.body; });
}

ContactRecords ContactLog::finish_frame(const std::vector<Body>& bodies, const ForceField& forces,
                                        const std::vector<Manifold>& touching, double duration) {
    for (std::uint32_t i = 0; i < bodies.size(); ++i)
        if (bodies[i].flying && !bodies[i].jointed) {
            const double before = accounts_[i].work;
            end_flight(i, bodies[i], !forces.only_gravity(i));
            if (forces.has_water()) accounts_[i].water += accounts_[i].work - before;
        }
    add_losses(bodies);
    if (!has_records()) return records_;
    // Contacts of sleeping bodies keep the forces of their last frame.
    std::erase_if(asleep_,
                  [&](const auto& item) { return !at_rest(item.first, bodies) || sums_.contains(item.first); });
    for (const auto& [key, record] : asleep_) {
        const Vec3 force = record.normal_force * record.normal + record.tangential_force;
        add_contact(key.a, key.b, {duration * force, duration * record.moment});
        records_.contacts.push_back(record);
    }
    add_touching(touching, bodies);
    for (auto& [key, sum] : sums_) records_.contacts.push_back(mean(key, sum, bodies, duration));
    add_loads(bodies, duration);
    add_corrections(bodies, duration);
    name_by_scene();
    // Impacts at the end of a step are recorded before its hits, which have times within the step.
    std::ranges::stable_sort(records_.impacts, {}, [](const ImpactRecord& impact) { return impact.when.time; });
    return records_;
}

}  // namespace tumble
