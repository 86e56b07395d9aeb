#include "sim/contact/rest_solver.h"

#include "sim/tuning.h"

#include <algorithm>
#include <cmath>

namespace tumble {
namespace {

// What a sweep reads and writes of a body, packed: the sweeps are most of a heap's run time.
struct Motion {
    Vec3 velocity, spin;
};

struct Row {
    std::uint32_t a, b;                // slots
    double inverse_mass_a, inverse_mass_b;
    double inverse_effective_mass;     // 1/kg
    double required;                   // m/s, least v_rel
    double impulse;                    // N s
    Vec3 normal, arm_cross_a, arm_cross_b, turn_a, turn_b;   // n, r x n, I^-1 (r x n)
};

struct FrictionRow {
    std::uint32_t contact;             // index of the normal row
    double coefficient, inverse_mass;  // mu; 1/kg
    double impact;                     // N s, the collision's share of the normal impulse
    Vec3 impulse;
};

class RestSolver {
public:
    RestSolver(const Island& island, std::vector<Contact>& contacts, std::vector<Body>& bodies,
               const RestSettings& settings)
        : contacts_(contacts), bodies_(bodies), settings_(settings) {
        bodies_used_ = island.bodies;
        for (const std::uint32_t k : island.contacts) add_row(k);
        motion_.resize(bodies_used_.size());
        for (std::size_t i = 0; i < bodies_used_.size(); ++i)
            motion_[i] = {bodies[bodies_used_[i]].velocity, bodies[bodies_used_[i]].angular_velocity};
    }

    void run() {
        warm_start();
        for (int sweep = 0; sweep < tuning::solver_sweeps; ++sweep) {
            double change = 0.0;
            for (FrictionRow& f : friction_) change = std::max(change, solve_friction(f));
            for (Row& r : rows_) change = std::max(change, solve_normal(r));
            if (change <= settings_.tolerance) break;
        }
        store();
        push_out();
    }

private:
    // Islands are small against the world: a body's slot is found by bisection, once a row.
    std::uint32_t slot(std::uint32_t body) {
        const auto end = bodies_used_.begin() + std::ptrdiff_t(dynamic_count());
        const auto found = std::lower_bound(bodies_used_.begin(), end, body);
        if (found != end && *found == body) return std::uint32_t(found - bodies_used_.begin());
        for (std::size_t i = dynamic_count(); i < bodies_used_.size(); ++i)
            if (bodies_used_[i] == body) return std::uint32_t(i);
        bodies_used_.push_back(body);   // fixed or kinematic: behind the island's own
        ++others_;
        return std::uint32_t(bodies_used_.size() - 1);
    }
    std::size_t dynamic_count() const { return bodies_used_.size() - others_; }

    void add_row(std::uint32_t k) {
        Contact& c = contacts_[k];
        const Body &a = bodies_[c.a], &b = bodies_[c.b];
        const double v = relative_velocity(c, a, b);
        double required = -std::max(0.0, c.separation) / settings_.h;
        if (c.impact > 0.0) required = c.bounce_velocity;
        // It will bounce: stopping it at the surface would take the speed it must come back with.
        else if (!c.touching() && c.restitution > 0.0 && -v > settings_.bounce_threshold) {
            c.impulse = 0.0;
            c.friction_impulse.setZero();
            return;
        }
        if (c.friction > 0.0)
            friction_.push_back({std::uint32_t(rows_.size()), c.friction, 1.0 / c.inverse_tangent_mass, c.impact, c.friction_impulse});
        rows_.push_back({slot(c.a), slot(c.b), a.inverse_mass, b.inverse_mass, c.inverse_effective_mass, required,
                         c.impulse, c.normal, c.arm_a.cross(c.normal), c.arm_b.cross(c.normal), c.turn_a, c.turn_b});
        of_row_.push_back(k);
    }

    double speed(const Row& r) const {
        const Motion &a = motion_[r.a], &b = motion_[r.b];
        return r.normal.dot(b.velocity - a.velocity) + r.arm_cross_b.dot(b.spin) - r.arm_cross_a.dot(a.spin);
    }

    void apply(const Row& r, double j) {
        Motion &a = motion_[r.a], &b = motion_[r.b];
        a.velocity -= (j * r.inverse_mass_a) * r.normal;
        a.spin -= j * r.turn_a;
        b.velocity += (j * r.inverse_mass_b) * r.normal;
        b.spin += j * r.turn_b;
    }

    void apply_across(const FrictionRow& f, const Vec3& impulse) {
        const Row& r = rows_[f.contact];
        const Contact& c = contacts_[of_row_[f.contact]];
        Motion &a = motion_[r.a], &b = motion_[r.b];
        a.velocity -= r.inverse_mass_a * impulse;
        a.spin -= bodies_[c.a].inverse_inertia * c.arm_a.cross(impulse);
        b.velocity += r.inverse_mass_b * impulse;
        b.spin += bodies_[c.b].inverse_inertia * c.arm_b.cross(impulse);
    }

    void warm_start() {
        for (const Row& r : rows_)
            if (r.impulse > 0.0) apply(r, r.impulse);
        for (const FrictionRow& f : friction_)
            if (!f.impulse.isZero(0.0)) apply_across(f, f.impulse);
    }

    double solve_normal(Row& r) {
        const double target = std::max(0.0, r.impulse + (r.required - speed(r)) / r.inverse_effective_mass);
        const double delta = target - r.impulse;
        if (delta == 0.0) return 0.0;
        r.impulse = target;
        apply(r, delta);
        return std::abs(delta) * r.inverse_effective_mass;
    }

    // Both tangential directions at once, then back into the disc: Coulomb's cone, not a pyramid. One scalar mass for
    // both keeps friction against the slip; each direction's own would turn it aside when the disc cuts it.
    double solve_friction(FrictionRow& f) {
        const Row& r = rows_[f.contact];
        const double limit = f.coefficient * (r.impulse + f.impact);
        if (limit == 0.0 && f.impulse.isZero(0.0)) return 0.0;
        const Contact& c = contacts_[of_row_[f.contact]];
        const Motion &a = motion_[r.a], &b = motion_[r.b];
        const Vec3 v = b.velocity + b.spin.cross(c.arm_b) - a.velocity - a.spin.cross(c.arm_a);
        const Vec3 slip = v - r.normal.dot(v) * r.normal;
        Vec3 target = f.impulse - f.inverse_mass * slip;
        const double square = target.squaredNorm();
        if (square > limit * limit) target *= limit / std::sqrt(square);
        const Vec3 delta = target - f.impulse;
        f.impulse = target;
        apply_across(f, delta);
        return delta.norm() * r.inverse_effective_mass;
    }

    void store() {
        for (std::size_t i = 0; i < rows_.size(); ++i) {
            contacts_[of_row_[i]].impulse = rows_[i].impulse;
            contacts_[of_row_[i]].friction_impulse.setZero();
        }
        for (const FrictionRow& f : friction_) contacts_[of_row_[f.contact]].friction_impulse = f.impulse;
        for (std::size_t i = 0; i < dynamic_count(); ++i) {
            bodies_[bodies_used_[i]].velocity = motion_[i].velocity;
            bodies_[bodies_used_[i]].angular_velocity = motion_[i].spin;
        }
    }

    // The same rows once more for the push velocities, which start from zero: with them the overlaps shrink by a share.
    void push_out() {
        bool needed = false;
        for (std::size_t i = 0; i < rows_.size(); ++i) {
            Row& r = rows_[i];
            const Contact& c = contacts_[of_row_[i]];
            const double size = c.touch_distance / tuning::touch;   // the smaller radius
            const double depth = -c.separation - tuning::push_slop * size;
            const double wanted = depth > 0.0 ? std::min(tuning::push_share * depth / settings_.h, tuning::push_limit * size)
                                              : std::min(0.0, -c.separation / settings_.h);
            r.required = wanted - speed(r);
            r.impulse = 0.0;
            needed = needed || (depth > 0.0 && r.required > 0.0);
        }
        if (!needed) return;
        for (Motion& m : motion_) m = {Vec3::Zero(), Vec3::Zero()};
        for (int sweep = 0; sweep < tuning::push_sweeps; ++sweep)
            for (Row& r : rows_) solve_normal(r);
        for (std::size_t i = 0; i < dynamic_count(); ++i) {
            bodies_[bodies_used_[i]].push_velocity = motion_[i].velocity;
            bodies_[bodies_used_[i]].push_angular_velocity = motion_[i].spin;
        }
    }

    std::vector<Contact>& contacts_;
    std::vector<Body>& bodies_;
    RestSettings settings_;
    std::vector<std::uint32_t> bodies_used_;   // slot to body: the island's, then others it touches
    std::size_t others_ = 0;
    std::vector<Motion> motion_;               // by slot
    std::vector<Row> rows_;
    std::vector<std::uint32_t> of_row_;        // row to contact
    std::vector<FrictionRow> friction_;
};

}  // namespace

void solve_rest(const Island& island, std::vector<Contact>& contacts, std::vector<Body>& bodies,
                const RestSettings& settings) {
    RestSolver(island, contacts, bodies, settings).run();
}

}  // namespace tumble
