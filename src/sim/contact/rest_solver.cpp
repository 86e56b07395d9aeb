#include "sim/contact/rest_solver.h"

#include "sim/tuning.h"

#include <algorithm>
#include <cmath>

namespace tumble {
namespace {

class RestSolver {
public:
    RestSolver(const Island& island, std::vector<Contact>& contacts, std::vector<Body>& bodies,
               const RestSettings& settings)
        : contacts_(contacts), bodies_(bodies), settings_(settings) {
        for (const std::uint32_t k : island.contacts) {
            Contact& c = contacts[k];
            Row row{&c, &bodies[c.a], &bodies[c.b], required_velocity(c)};
            if (row.required == skipped) {
                c.impulse = 0.0;
                c.friction_impulse.setZero();
                continue;
            }
            rows_.push_back(row);
        }
    }

    void run() {
        for (Row& r : rows_) {   // warm start
            const Contact& c = *r.contact;
            apply_to_velocities(c.impulse * c.normal + c.friction_impulse, c, *r.a, *r.b);
        }
        for (int sweep = 0; sweep < tuning::solver_sweeps; ++sweep) {
            double change = 0.0;
            for (Row& r : rows_) change = std::max(change, solve_friction(r));
            for (Row& r : rows_) change = std::max(change, solve_normal(r));
            if (change <= settings_.tolerance) break;
        }
        push_out();
    }

private:
    static constexpr double skipped = -1e300;

    struct Row {
        Contact* contact;
        Body *a, *b;
        double required;        // m/s, least v_rel
        double push_required = 0.0;
    };

    double required_velocity(const Contact& c) const {
        if (c.impact > 0.0) return c.bounce_velocity;
        const double approach = -relative_velocity(c, bodies_[c.a], bodies_[c.b]);
        // It will bounce: stopping it at the surface would take the speed it must come back with.
        if (!c.touching() && c.restitution > 0.0 && approach > settings_.bounce_threshold) return skipped;
        return -std::max(0.0, c.separation) / settings_.h;
    }

    double solve_normal(Row& r) {
        Contact& c = *r.contact;
        const double v = relative_velocity(c, *r.a, *r.b);
        const double target = std::max(0.0, c.impulse + (r.required - v) / c.inverse_effective_mass);
        const double delta = target - c.impulse;
        if (delta == 0.0) return 0.0;
        c.impulse = target;
        apply_normal_to_velocities(delta, c, *r.a, *r.b);
        return std::abs(delta) * c.inverse_effective_mass;
    }

    // Both tangential directions at once, then back into the disc: Coulomb's cone, not a pyramid. One scalar mass for
    // both keeps friction against the slip; each direction's own would turn it aside when the disc cuts it.
    double solve_friction(Row& r) {
        Contact& c = *r.contact;
        if (c.friction <= 0.0) return 0.0;
        const Vec3 v = r.b->point_velocity(c.arm_b) - r.a->point_velocity(c.arm_a);
        const Vec3 slip = v - c.normal.dot(v) * c.normal;
        Vec3 target = c.friction_impulse - slip / c.inverse_tangent_mass;
        const double limit = c.friction * (c.impulse + c.impact);
        const double size = target.norm();
        if (size > limit) target *= limit / size;
        const Vec3 delta = target - c.friction_impulse;
        c.friction_impulse = target;
        apply_to_velocities(delta, c, *r.a, *r.b);
        return delta.norm() * c.inverse_effective_mass;
    }

    void push_out() {
        bool needed = false;
        for (Row& r : rows_) {
            const Contact& c = *r.contact;
            const double size = c.touch_distance / tuning::touch;   // the smaller radius
            const double depth = -c.separation - tuning::push_slop * size;
            const double wanted = depth > 0.0 ? std::min(tuning::push_share * depth / settings_.h, tuning::push_limit * size)
                                              : std::min(0.0, -c.separation / settings_.h);
            r.push_required = wanted - relative_velocity(c, *r.a, *r.b);
            needed = needed || (depth > 0.0 && r.push_required > 0.0);
        }
        if (!needed) return;
        for (Row& r : rows_) r.contact->push = 0.0;
        for (int sweep = 0; sweep < tuning::push_sweeps; ++sweep)
            for (Row& r : rows_) solve_push(r);
    }

    void solve_push(Row& r) {
        Contact& c = *r.contact;
        Body &a = *r.a, &b = *r.b;
        const Vec3 at_a = a.push_velocity + a.push_angular_velocity.cross(c.arm_a);
        const Vec3 at_b = b.push_velocity + b.push_angular_velocity.cross(c.arm_b);
        const double v = c.normal.dot(at_b - at_a);
        const double target = std::max(0.0, c.push + (r.push_required - v) / c.inverse_effective_mass);
        const double delta = target - c.push;
        if (delta == 0.0) return;
        c.push = target;
        if (a.dynamic()) {
            a.push_velocity -= (delta * a.inverse_mass) * c.normal;
            a.push_angular_velocity -= delta * c.turn_a;
        }
        if (b.dynamic()) {
            b.push_velocity += (delta * b.inverse_mass) * c.normal;
            b.push_angular_velocity += delta * c.turn_b;
        }
    }

    std::vector<Contact>& contacts_;
    std::vector<Body>& bodies_;
    RestSettings settings_;
    std::vector<Row> rows_;
};

}  // namespace

void solve_rest(const Island& island, std::vector<Contact>& contacts, std::vector<Body>& bodies,
                const RestSettings& settings) {
    RestSolver(island, contacts, bodies, settings).run();
}

}  // namespace tumble
