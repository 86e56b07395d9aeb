#include "sim/notes/notes_method.h"

#include "sim/contact/model/contact_constraint.h"
#include "sim/dynamics/integrator.h"
#include "sim/log/contact_log.h"
#include "sim/step/step_context.h"

#include <algorithm>
#include <tuple>

namespace tumble {
namespace {

Vec3 angular_response(const Body& body, const Vec3& arm, const Vec3& direction) {
    return body.inverse_inertia * arm.cross(direction);
}

void add_impulse(Body& body, const Vec3& arm, const Vec3& impulse) {
    if (!body.dynamic()) return;                  // the state of fixed and kinematic bodies is not updated
    body.momentum += impulse;                     // eq. 9
    body.angular_momentum += arm.cross(impulse);  // eq. 10
    body.derive_velocities();                     // eqs. 2 and 4
}

// Moves the bodies apart along the normal by their deepest overlap, the lighter one farther.
void push_out(const Manifold& m, double depth, Body& a, Body& b) {
    const double share = depth / (a.inverse_mass + b.inverse_mass);
    a.position -= share * a.inverse_mass * m.normal;
    b.position += share * b.inverse_mass * m.normal;
}

}  // namespace

// Eqs. 14 and 20, with n away from A and towards B, so that J = j n acts on B and -j n on A (contact.h says why).
NotesMethod::Collision NotesMethod::resolve(const Vec3& point, const Vec3& n, Body& a, Body& b) {
    const Vec3 r_a = point - a.position, r_b = point - b.position;
    const double v_rel = n.dot(b.point_velocity(r_b) - a.point_velocity(r_a));
    if (!(v_rel < 0.0)) return {};
    const double e = pair_restitution(a, b);
    const double k = a.inverse_mass + b.inverse_mass +
                     n.dot(angular_response(a, r_a, n).cross(r_a) + angular_response(b, r_b, n).cross(r_b));
    const double j = -(1.0 + e) * v_rel / k;
    add_impulse(a, r_a, -j * n);
    add_impulse(b, r_b, j * n);
    return {v_rel, j};
}

// In ascending order of (A, B, feature number); A and B are the indices in the scene, the feature number of a corner is
// the corner's index.
void NotesMethod::collide(const StepContext& step) {
    std::vector<Body>& bodies = step.set.bodies;
    const std::vector<Manifold>& manifolds =
        narrow_phase_.find(broad_phase_.update(bodies, step.h), bodies, step.h, step.pool);
    points_.clear();
    for (std::uint32_t m = 0; m < manifolds.size(); ++m)
        for (int i = 0; i < manifolds[m].count; ++i)
            if (manifolds[m].points[std::size_t(i)].separation <= 0.0) points_.push_back({m, i});
    std::stable_sort(points_.begin(), points_.end(), [&](const Point& l, const Point& r) {
        const auto key = [&](const Point& p) {
            const Manifold& m = manifolds[p.manifold];
            return std::tuple(m.a, m.b, m.points[std::size_t(p.index)].feature);
        };
        return key(l) < key(r);
    });
    for (const Point& point : points_) {
        const Manifold& m = manifolds[point.manifold];
        const Collision found =
            resolve(m.points[std::size_t(point.index)].position, m.normal, bodies[m.a], bodies[m.b]);
        if (step.log && found.impulse > 0.0) log_impulse(step, m, point, found);
    }
    if (!step.settings.push_out) return;
    for (const Manifold& m : manifolds) {
        double depth = 0.0;
        for (int i = 0; i < m.count; ++i) depth = std::max(depth, -m.points[std::size_t(i)].separation);
        if (depth > 0.0) push_out(m, depth, bodies[m.a], bodies[m.b]);
    }
}

void NotesMethod::log_impulse(const StepContext& step, const Manifold& m, const Point& point, const Collision& found) {
    const std::vector<Body>& bodies = step.set.bodies;
    contacts_.clear();
    add_contacts(m, bodies, contacts_);
    const Contact& c = contacts_[std::size_t(point.index)];
    const double e = c.restitution;
    step.log->add_entry({0, 0, found.before, -e * found.before, e, found.impulse}, c,
                        m.points[std::size_t(point.index)].position, bodies, step.impact_time());
}

// Explicit Euler moves the body by the old velocity, as if the forces acted at the end of the step.
void NotesMethod::log_forces(const StepContext& step, std::uint32_t i, const Wrench& wrench, const BodyVelocity& old) {
    const Body& body = step.set.bodies[i];
    const bool before = body.integrator == IntegratorKind::explicit_euler;
    const Vec3 place = before ? Vec3(body.position + step.h * old.velocity) : body.position;
    step.log->add_gravity(i, body, step.h, place);
    if (step.forces.field().only_gravity(i)) return;
    step.log->add_external(
        i, {step.h * (wrench.force - body.mass * body.fall(step.settings.gravity)), step.h * wrench.torque}, place,
        {0.5 * (old.velocity + body.velocity), 0.5 * (old.angular_velocity + body.angular_velocity)});
}

void NotesMethod::step(const StepContext& step) {
    BodySet& set = step.set;
    set.list(step.sleep);
    collide(step);
    for (const std::uint32_t i : set.awake) {
        Body& body = set.bodies[i];
        const BodyVelocity old{body.velocity, body.angular_velocity};
        const Wrench wrench = step.forces.field().at(i, body, step.start());
        advance_momenta(body, wrench.force, wrench.torque, step.h);
        body.derive_velocities();  // omega = I_n^-1 L_n+1
        const bool before = body.integrator == IntegratorKind::explicit_euler;
        if (step.log) log_forces(step, i, wrench, old);
        advance_pose(body, before ? old.velocity : body.velocity, before ? old.angular_velocity : body.angular_velocity,
                     step.h, step.settings.rotation);
        body.derive();
        step.check.examine(i, set.bodies);
    }
}

}  // namespace tumble
