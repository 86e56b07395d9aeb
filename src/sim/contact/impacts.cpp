#include "sim/contact/impacts.h"

#include "sim/tuning.h"

#include <algorithm>
#include <cmath>

namespace tumble {
namespace {

class ImpactSolver {
public:
    ImpactSolver(const Island& island, std::vector<Contact>& contacts, std::vector<Body>& bodies)
        : island_(island), contacts_(contacts), bodies_(bodies) {
        for (const std::uint32_t k : island.contacts)
            if (contacts[k].touching()) touching_.push_back(k);
    }

    int run(double threshold) {
        if (touching_.empty()) return 0;
        const int limit = std::min<int>(tuning::impact_passes, 3 * int(touching_.size()) + 10);
        int passes = 0;
        while (gather(threshold)) {
            if (passes++ == limit) {
                stop_all();
                break;
            }
            if (!reflect(threshold)) break;
        }
        if (passes > 0) {
            // Only what took part is held to its new speed; the rest of the island is left to the resting solver.
            for (const std::uint32_t k : touching_)
                if (contacts_[k].impact > 0.0) contacts_[k].bounce_velocity = std::max(0.0, speed(k));
        }
        return passes;
    }

private:
    double speed(std::uint32_t k) const {
        const Contact& c = contacts_[k];
        return relative_velocity(c, bodies_[c.a], bodies_[c.b]);
    }

    void apply(std::uint32_t k, double j) {
        const Contact& c = contacts_[k];
        apply_normal_to_velocities(j, c, bodies_[c.a], bodies_[c.b]);
    }

    // The approaching contacts; false when none of them bounces.
    bool gather(double threshold) {
        active_.clear();
        before_.clear();
        double fastest = 0.0;
        bool bounces = false;
        for (const std::uint32_t k : touching_) fastest = std::max(fastest, std::abs(speed(k)));
        for (const std::uint32_t k : touching_) {
            const double u = speed(k);
            if (classify(u, 1e-12 * fastest) != ContactState::colliding) continue;
            active_.push_back(k);
            before_.push_back(u);
            bounces = bounces || (u < -threshold && contacts_[k].restitution > 0.0);
        }
        return bounces;
    }

    // Impulses j >= 0 that stop every approach with the least change of motion: projected Gauss-Seidel on the
    // non-negative least squares problem. Leaves the velocities stopped.
    void stop(const std::vector<std::uint32_t>& set, std::vector<double>& j) {
        j.assign(set.size(), 0.0);
        double first = 0.0;
        for (int sweep = 0; sweep < tuning::impact_sweeps; ++sweep) {
            double change = 0.0;
            for (std::size_t i = 0; i < set.size(); ++i) {
                const double stiffness = contacts_[set[i]].inverse_effective_mass;
                const double target = std::max(0.0, j[i] - speed(set[i]) / stiffness);
                const double delta = target - j[i];
                if (delta == 0.0) continue;
                apply(set[i], delta);
                j[i] = target;
                change = std::max(change, std::abs(delta) * stiffness);
            }
            if (sweep == 0) first = change;
            if (change <= tuning::impact_tolerance * first) break;
        }
    }

    // With d the stopping change and q the same weighted by each contact's restitution: v += f d + f s q. The factor
    // f = -(d.v)/(d.d) makes the step exact whatever the sweeps left over (with equal e = 1 a Householder reflection);
    // s <= 1 keeps |q| <= |d|, beyond which differing restitutions could gain energy.
    bool reflect(double threshold) {
        stop(active_, impulse_);
        double dv = 0.0, dd = 0.0;   // d . v and d . d in the kinetic metric, as sums over contacts
        for (std::size_t i = 0; i < active_.size(); ++i) {
            dv += impulse_[i] * before_[i];
            dd += impulse_[i] * (speed(active_[i]) - before_[i]);
        }
        const double f = -dv / dd;
        // Squeezed between moving walls there is nothing to stop at, and the sweeps build up impulses that cancel: no bounce.
        const bool jammed = !(f < 2.0);
        if (jammed) {
            for (std::size_t i = 0; i < active_.size(); ++i) contacts_[active_[i]].impact += impulse_[i];
            return false;
        }
        const std::vector<double> stopped = speeds();
        weighted_.resize(active_.size());
        double qq = 0.0;
        for (std::size_t i = 0; i < active_.size(); ++i) {
            const Contact& c = contacts_[active_[i]];
            weighted_[i] = (before_[i] < -threshold ? c.restitution : 0.0) * impulse_[i];
            apply(active_[i], weighted_[i]);
        }
        for (std::size_t i = 0; i < active_.size(); ++i) qq += weighted_[i] * (speed(active_[i]) - stopped[i]);
        const double s = qq > dd ? std::sqrt(dd / qq) : 1.0;
        // So far v + d + q; what is missing to v + f d + f s q.
        for (std::size_t i = 0; i < active_.size(); ++i) {
            const std::uint32_t k = active_[i];
            apply(k, (f - 1.0) * impulse_[i] + (f * s - 1.0) * weighted_[i]);
            contacts_[k].impact += f * (impulse_[i] + s * weighted_[i]);
        }
        return true;
    }

    std::vector<double> speeds() const {
        std::vector<double> u;
        for (const std::uint32_t k : active_) u.push_back(speed(k));
        return u;
    }

    void stop_all() {
        stop(touching_, impulse_);
        for (std::size_t i = 0; i < touching_.size(); ++i) contacts_[touching_[i]].impact += impulse_[i];
    }

    const Island& island_;
    std::vector<Contact>& contacts_;
    std::vector<Body>& bodies_;
    std::vector<std::uint32_t> touching_, active_;
    std::vector<double> before_, impulse_, weighted_;
};

}  // namespace

int resolve_impacts(const Island& island, std::vector<Contact>& contacts, std::vector<Body>& bodies, double threshold) {
    return ImpactSolver(island, contacts, bodies).run(threshold);
}

}  // namespace tumble
