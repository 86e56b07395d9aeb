#include "sim/notes/notes_method.h"

#include "sim/contact/model/contact_constraint.h"
#include "sim/dynamics/integrator.h"
#include "sim/step/step_context.h"

#include <algorithm>

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

// Eqs. 14 and 20, with n away from A and towards B, so that J = j n acts on B and -j n on A (contact.h says why).
void resolve(const Vec3& point, const Vec3& n, Body& a, Body& b) {
    const Vec3 r_a = point - a.position, r_b = point - b.position;
    const double v_rel = n.dot(b.point_velocity(r_b) - a.point_velocity(r_a));
    if (!(v_rel < 0.0)) return;
    const double e = pair_restitution(a, b);
    const double k = a.inverse_mass + b.inverse_mass +
                     n.dot(angular_response(a, r_a, n).cross(r_a) + angular_response(b, r_b, n).cross(r_b));
    const double j = -(1.0 + e) * v_rel / k;
    add_impulse(a, r_a, -j * n);
    add_impulse(b, r_b, j * n);
}

// Moves the bodies apart along the normal by their deepest overlap, the lighter one farther.
void push_out(const Manifold& m, double depth, Body& a, Body& b) {
    const double share = depth / (a.inverse_mass + b.inverse_mass);
    a.position -= share * a.inverse_mass * m.normal;
    b.position += share * b.inverse_mass * m.normal;
}

}  // namespace

// In the order of the bodies in the scene, of A and then of B; the points of a pair by their feature number, which is
// for a corner its index.
void NotesMethod::collide(const StepContext& step) {
    std::vector<Body>& bodies = step.set.bodies;
    for (Manifold& m : narrow_phase_.find(broad_phase_.update(bodies, step.h), bodies, step.h, step.pool)) {
        Body &a = bodies[m.a], &b = bodies[m.b];
        const auto points = std::span(m.points).first(std::size_t(m.count));
        std::sort(points.begin(), points.end(),
                  [](const ContactPoint& l, const ContactPoint& r) { return l.feature < r.feature; });
        double depth = 0.0;
        for (const ContactPoint& p : points) {
            if (p.separation > 0.0) continue;
            depth = std::max(depth, -p.separation);
            resolve(p.position, m.normal, a, b);
        }
        if (step.settings.push_out && depth > 0.0) push_out(m, depth, a, b);
    }
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
        advance_pose(body, before ? old.velocity : body.velocity, before ? old.angular_velocity : body.angular_velocity,
                     step.h, step.settings.rotation);
        body.derive();
        step.check.look_at(i, set.bodies);
    }
}

}  // namespace tumble
