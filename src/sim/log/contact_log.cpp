#include "sim/log/contact_log.h"

#include <algorithm>
#include <tuple>
#include <utility>

namespace tumble {
namespace {

// A slip below this fraction of the speed that gravity gives in a step counts as sticking: the solvers leave such
// speeds by their tolerances.
constexpr double stick_share = 1e-3;
// Corrections below this fraction of a body's impulses in the frame are rounding.
constexpr double correction_rounding = 1e-13;

Vec3 across(const Vec3& v, const Vec3& normal) { return v - normal.dot(v) * normal; }

ContactFeatures features_of(Corners corners, const PointGeometry& geometry, int points, const Body& a, const Body& b) {
    const auto is = [&]<class Shape>(std::in_place_type_t<Shape>) {
        return std::holds_alternative<Shape>(a.collider) || std::holds_alternative<Shape>(b.collider);
    };
    if (is(std::in_place_type<std::shared_ptr<const CollisionMesh>>)) return ContactFeatures::mesh;
    if (is(std::in_place_type<Ball>) || std::holds_alternative<BallOverFace>(geometry) ||
        std::holds_alternative<CurvedGap>(geometry))
        return ContactFeatures::sphere;
    if (std::holds_alternative<CrossingEdges>(geometry)) return ContactFeatures::edge_edge;
    if (points > 2 && !is(std::in_place_type<HalfSpace>)) return ContactFeatures::face_face;
    return corners == Corners::of_a ? ContactFeatures::vertex_face : ContactFeatures::face_vertex;
}

ContactFeatures swapped(ContactFeatures features) {
    if (features == ContactFeatures::vertex_face) return ContactFeatures::face_vertex;
    if (features == ContactFeatures::face_vertex) return ContactFeatures::vertex_face;
    return features;
}

Vec3 acting_point_of(const Manifold& m, int i, const Body& a, const Body& b) {
    const ContactPoint& p = m.points[std::size_t(i)];
    return acting_point(p.position, p.separation, m.normal, a.dynamic(), b.dynamic());
}

}  // namespace

ContactLog::ContactLog(std::span<const std::uint32_t> scene_index, const Vec3& origin, const Vec3& gravity)
    : scene_index_(scene_index.begin(), scene_index.end()),
      origin_(origin),
      gravity_(gravity),
      accounts_(scene_index.size()) {}

double ContactLog::energy(const Body& body) const {
    return body.kinetic_energy() - body.mass * gravity_.dot(body.position);
}

void ContactLog::begin_frame(const std::vector<Body>& bodies) {
    sums_.clear();
    records_.impacts.clear();
    records_.contacts.clear();
    friction_ = 0.0;
    for (std::size_t i = 0; i < bodies.size(); ++i) {
        accounts_[i] = {};
        accounts_[i].momentum = bodies[i].momentum;
        if (bodies[i].dynamic()) accounts_[i].energy = energy(bodies[i]);
    }
}

void ContactLog::add_entry(const ImpactTrace::Entry& entry, const Contact& c, const Vec3& point,
                           const std::vector<Body>& bodies, const ImpactTime& when) {
    const Body &a = bodies[c.a], &b = bodies[c.b];
    ImpactRecord record;
    record.when = when;
    record.a = c.a;
    record.b = c.b;
    record.point = origin_ + point;
    record.normal = c.normal;
    record.features = features_of(c.corners, c.geometry, c.points, a, b);
    record.speed_before = entry.speed_before;
    record.speed_after = entry.speed_after;
    record.restitution = entry.restitution;
    record.impulse = entry.impulse;
    record.pass = entry.pass;
    records_.impacts.push_back(record);
    const Vec3 j = entry.impulse * c.normal;
    accounts_[c.a].contact -= j;
    accounts_[c.b].contact += j;
    accounts_[c.a].touched = accounts_[c.b].touched = true;
    if (!a.dynamic()) accounts_[c.b].work += j.dot(a.point_velocity(c.arm_a));
    if (!b.dynamic()) accounts_[c.a].work -= j.dot(b.point_velocity(c.arm_b));
}

void ContactLog::add_impact(const ImpactTrace& trace, const std::vector<Contact>& contacts,
                            const std::vector<Body>& bodies, const ImpactTime& when) {
    for (std::size_t k = 0; k < trace.entries.size(); ++k) {
        const ImpactTrace::Entry& entry = trace.entries[k];
        const Contact& c = contacts[entry.contact];
        add_entry(entry, c, bodies[c.a].position + c.arm_a, bodies, when);
        const bool last = std::none_of(trace.entries.begin() + std::ptrdiff_t(k) + 1, trace.entries.end(),
                                       [&](const ImpactTrace::Entry& e) { return e.contact == entry.contact; });
        if (!last) continue;
        records_.impacts.back().friction = c.impact_friction;
        accounts_[c.a].contact -= c.impact_friction;
        accounts_[c.b].contact += c.impact_friction;
    }
}

void ContactLog::set_place(ContactRecord& record, const Manifold& m, int i, const std::vector<Body>& bodies) const {
    const Body &a = bodies[m.a], &b = bodies[m.b];
    const Vec3 at = acting_point_of(m, i, a, b);
    record.a = m.a;
    record.b = m.b;
    record.point = origin_ + at;
    record.normal = m.normal;
    record.gap = m.points[std::size_t(i)].separation;
    record.features = features_of(m.corners, m.geometry(), m.count, a, b);
    record.slip = across(b.point_velocity(at - b.position) - a.point_velocity(at - a.position), m.normal);
}

void ContactLog::add_contacts(std::span<const std::uint32_t> manifolds, const ContactProblem& problem,
                              const std::vector<ManifoldImpulse>& totals) {
    for (const std::uint32_t k : manifolds) {
        const Manifold& m = problem.manifolds[k];
        const ManifoldImpulse& total = totals[k];
        if (total.on_b.isZero(0.0) && total.turn_a.isZero(0.0) && total.turn_b.isZero(0.0)) continue;
        const Body &a = problem.bodies[m.a], &b = problem.bodies[m.b];
        accounts_[m.a].contact -= total.on_b;
        accounts_[m.b].contact += total.on_b;
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
        double torsion = m.normal.dot(about_b ? total.turn_b : Vec3(-total.turn_a));
        for (int i = 0; i < m.count; ++i)
            torsion -= m.normal.dot((place(i) - (about_b ? b.position : a.position)).cross(share(i) * total.on_b));
        const double turn = m.normal.dot(b.angular_velocity - a.angular_velocity);
        for (int i = 0; i < m.count; ++i) {
            if (!(share(i) > 0.0)) continue;
            Sum& point = sums_[key_of(m, i)];
            point.impulse += share(i) * total.on_b;
            point.torsion += share(i) * torsion;
            point.span += problem.settings.h;
            point.stick_speed = stick_share * gravity_.norm() * problem.settings.h;
            set_place(point.last, m, i, problem.bodies);
            friction_ -= share(i) * (across(total.on_b, m.normal).dot(point.last.slip) + torsion * turn);
        }
    }
}

void ContactLog::add_external(std::uint32_t body, const Impulse& impulse, const BodyVelocity& mean) {
    accounts_[body].external += impulse.linear;
    accounts_[body].work += impulse.linear.dot(mean.velocity) + impulse.angular.dot(mean.angular_velocity);
}

bool ContactLog::at_rest(const Key& key, const std::vector<Body>& bodies) const {
    const auto rests = [&](std::uint32_t i) { return bodies[i].asleep || !bodies[i].moves(); };
    return rests(key.a) && rests(key.b);
}

// Gives known points their present places, and adds those without load.
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
    const Vec3 force = sum.impulse / span;
    r.normal_force = r.normal.dot(force);
    r.tangential_force = force - r.normal_force * r.normal;
    r.torsion = sum.torsion / span;
    r.state = r.slip.norm() > sum.stick_speed ? ContactRecord::State::slip : ContactRecord::State::stick;
    if (!sleeps) return r;
    r.state = ContactRecord::State::asleep;
    r.slip.setZero();
    asleep_[key] = r;
    const Vec3 rest = std::max(0.0, duration - sum.span) * force;
    accounts_[key.a].contact -= rest;
    accounts_[key.b].contact += rest;
    return r;
}

void ContactLog::add_corrections(const std::vector<Body>& bodies, const ForceField& forces, double duration) {
    for (std::uint32_t i = 0; i < bodies.size(); ++i) {
        const Body& body = bodies[i];
        Account& account = accounts_[i];
        // Forces on a ballistic body act along its trajectory, not in steps.
        if (!body.dynamic() || !(duration > 0.0) || (body.flying && !forces.only_gravity(i))) continue;
        account.external += duration * body.mass * gravity_;
        const Vec3 left = body.momentum - account.momentum - account.external - account.contact;
        const double size =
            body.momentum.norm() + account.momentum.norm() + account.external.norm() + account.contact.norm();
        if (left.norm() <= correction_rounding * size) continue;
        ContactRecord r;
        r.a = ContactRecord::nobody;
        r.b = i;
        r.point = origin_ + body.position;
        r.normal = left.normalized();
        r.normal_force = left.norm() / duration;
        r.state = body.asleep ? ContactRecord::State::asleep : ContactRecord::State::stick;
        records_.contacts.push_back(r);
    }
}

// Bodies in free flight lose nothing: a change of their energy is an error of the integrator.
void ContactLog::add_losses(const std::vector<Body>& bodies) {
    double lost = 0.0;
    for (std::size_t i = 0; i < bodies.size(); ++i) {
        if (!bodies[i].dynamic()) continue;
        records_.energy.work += accounts_[i].work;
        if (accounts_[i].touched) lost -= energy(bodies[i]) - accounts_[i].energy - accounts_[i].work;
    }
    records_.energy.friction_loss += friction_;
    records_.energy.impact_loss += lost - friction_;
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
        for (Vec3* v : {&r.normal, &r.tangential_force, &r.slip}) *v = -*v;
    }
    std::stable_sort(records_.contacts.begin(), records_.contacts.end(),
                     [](const auto& l, const auto& r) { return std::tie(l.a, l.b) < std::tie(r.a, r.b); });
    for (ImpactRecord& r : records_.impacts) {
        r.a = scene_index_[r.a];
        r.b = scene_index_[r.b];
        if (r.a < r.b) continue;
        std::swap(r.a, r.b);
        r.features = swapped(r.features);
        for (Vec3* v : {&r.normal, &r.friction}) *v = -*v;
    }
}

ContactRecords ContactLog::finish_frame(const std::vector<Body>& bodies, const ForceField& forces,
                                        const std::vector<Manifold>& touching, double duration) {
    // Contacts of sleeping bodies keep the forces of their last frame.
    std::erase_if(asleep_,
                  [&](const auto& item) { return !at_rest(item.first, bodies) || sums_.contains(item.first); });
    for (const auto& [key, record] : asleep_) {
        const Vec3 j = duration * (record.normal_force * record.normal + record.tangential_force);
        accounts_[key.a].contact -= j;
        accounts_[key.b].contact += j;
        records_.contacts.push_back(record);
    }
    add_touching(touching, bodies);
    for (auto& [key, sum] : sums_) records_.contacts.push_back(mean(key, sum, bodies, duration));
    add_corrections(bodies, forces, duration);
    add_losses(bodies);
    name_by_scene();
    return records_;
}

}  // namespace tumble
