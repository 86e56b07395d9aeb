#include "sim/impact/impact_laws.h"

#include "sim/impact/active_set.h"
#include "sim/impact/settings.h"

#include <algorithm>
#include <cmath>
#include <span>

namespace tumble {
namespace {

/// Passes of a propagating impact, per contact. Most impacts end within three. More are needed for a light ball
/// between a heavy one and a wall (31415 for masses of 1 : 1e8): their number is proportional to the inverse margin
/// of the contacts. Sets without a margin are jammed. Related tests: HardInput.LightBallBetweenAHeavyOneAndAWall
/// and Galperin.EndsAsInTheUnfoldedWedge.
constexpr int impact_passes_each = 3;
constexpr int impact_passes_more = 10;
constexpr double impact_passes_margin = 4.0;
constexpr int impact_passes_limit = 100000;

/// Bodies between moving walls leave at most at this many times the speed of the walls: a wedge of about 20
/// degrees. Related test: Restitution.InAnAcuteCornerGainsNothing.
constexpr double impact_wedge = 3.0;

/// Contacts with a margin below the inverse of this are jammed where walls move: the two sides of a box in a press.
/// Related test: Kinematic.PushesTheHeavyThroughTheLight.
constexpr double impact_deepest = 100.0;

/// Largest sum over the passes of the squared number of contacts: about 50 ms. Longer impacts are slow inelastic
/// approaches of many contacts to one common speed. Not fitted: a bound of the cost.
constexpr double impact_work = 3e5;

/// Elastic passes end by themselves; they count by this share. Limits the cost.
constexpr double impact_elastic_work = 0.1;

double restitution_now(const ImpactSystem& cluster, std::size_t i, double threshold) {
    if (i < cluster.contacts()) threshold = least_impact(cluster.contact(i), threshold);
    return cluster.speed(i) < -std::max(threshold, cluster.rounding()) ? cluster.restitution(i) : 0.0;
}

ActiveSet::Demand demand(const ImpactSystem& cluster, std::size_t i, double least_speed) {
    const double length = cluster.length(i);
    return {std::uint32_t(i), (cluster.speed(i) - least_speed) / length, cluster.rounding() / length};
}

// Stopped at walls that all move with w, |y|^2 grows by 2 w.d - |d|^2 <= |w|^2. A much larger result would be an escape
// between nearly parallel walls in relative motion, and is rejected. Without moving walls |y| cannot grow.
VelocityBound bound(const ImpactSystem& cluster) {
    if (cluster.wall_velocity() == 0.0) return {};
    const double wall = impact_wedge * cluster.wall_velocity();
    return {&cluster.velocity(), std::sqrt(cluster.velocity().squaredNorm() + wall * wall)};
}

// Adds to d the change of y that the multipliers make; returns lambda . s.
double add_change(const ImpactSystem& cluster, const std::vector<ActiveSet::Demand>& set,
                  const std::vector<double>& lambda, Eigen::VectorXd& d) {
    double work_before = 0.0;
    for (std::size_t i = 0; i < set.size(); ++i) {
        if (lambda[i] == 0.0) continue;
        cluster.rows()[set[i].row].add_to(d, lambda[i]);
        work_before += lambda[i] * cluster.speed(set[i].row) / cluster.length(set[i].row);
    }
    return work_before;
}

// The factor at which a change keeps the energy: -2 d.y / d.d of a Householder reflection.
double reflection_factor(double work_before, double square) { return square > 0.0 ? -2.0 * work_before / square : 0.0; }

// The change of y that multipliers make, and their work: the kinetic energy (in the frame of the walls, where they
// move) grows by lambda . s + |d|^2 / 2, with s = w . y + offset before the change.
struct Change {
    Eigen::VectorXd d;
    double work_before = 0.0, square = 0.0;  // lambda . s, |d|^2

    Change(const ImpactSystem& cluster, const std::vector<ActiveSet::Demand>& set, const std::vector<double>& lambda)
        : d(Eigen::VectorXd::Zero(cluster.velocity().size())) {
        work_before = add_change(cluster, set, lambda, d);
        square = d.squaredNorm();
    }
    double gain() const { return work_before + 0.5 * square; }
    double reflection() const { return reflection_factor(work_before, square); }
};

void apply(ImpactSystem& cluster, const std::vector<ActiveSet::Demand>& set, const std::vector<double>& lambda,
           double factor, std::span<const double> restitution = {}) {
    if (!(factor > 0.0)) return;
    if (cluster.traced())
        for (std::size_t i = 0; i < set.size(); ++i)
            if (lambda[i] > 0.0)
                cluster.announce(set[i].row, factor * lambda[i], restitution.empty() ? 0.0 : restitution[i]);
    for (std::size_t i = 0; i < set.size(); ++i)
        if (lambda[i] > 0.0) cluster.apply(set[i].row, factor * lambda[i]);
    if (cluster.traced()) cluster.end_pass();
}

class Propagation {
public:
    Propagation(ImpactSystem& cluster, double threshold, double slow, double resting)
        : cluster_(cluster),
          threshold_(threshold),
          slow_(cluster.size() > tuning::pass_contacts ? std::max(slow, cluster.rounding()) : cluster.rounding()),
          projection_(cluster.rows(), cluster.bodies(), tuning::pass_contacts),
          change_(Eigen::VectorXd::Zero(cluster.velocity().size())),
          changed_(cluster.bodies() + 1, 1) {
        // A body that is not dynamic has the last index, and never changes.
        const auto place = [&](std::uint32_t body) {
            return body == VelocityRow::none ? std::uint32_t(cluster.bodies()) : body;
        };
        for (const VelocityRow& row : cluster.rows()) bodies_.push_back({place(row.a), place(row.b)});
        for (std::size_t i = 0; i < cluster.size(); ++i)
            rests_.push_back(!cluster.flies(i) && cluster.speed(i) > -resting);
    }

    int run() {
        int limit = impact_passes_each * int(cluster_.size()) + impact_passes_more;
        bool depth_known = false;
        double work = 0.0;
        for (int pass = 0;; ++pass) {
            if (!gather(pass == 0) && (pass > 0 || !gather(false))) return pass;
            if (pass == limit && !depth_known && cluster_.wall_velocity() == 0.0) {
                limit += int(std::min<double>(impact_passes_limit, impact_passes_margin * depth()));
                depth_known = true;
            }
            const bool spent = pass >= limit || work > impact_work;
            const double cost = elastic() ? impact_elastic_work : 1.0;
            if (spent || squeezed(pass) || !reflect()) {
                stop(cluster_);
                return pass + 1;
            }
            work += cost * projection_.work();
        }
    }

private:
    // Collects the approaching contacts, at first without those at rest; returns false when none of them bounces.
    bool gather(bool first) {
        active_.clear();
        restitution_.clear();
        bool any = false;
        for (std::size_t i = 0; i < cluster_.size(); ++i) {
            // Otherwise its speed is that of the last pass.
            if (!changed_[bodies_[i].first] && !changed_[bodies_[i].second]) continue;
            if (!(cluster_.speed(i) < -slow_) || (first && rests_[i])) continue;
            active_.push_back(demand(cluster_, i, 0.0));
            restitution_.push_back(restitution_now(cluster_, i, threshold_));
            any = any || restitution_.back() > 0.0;
        }
        return any;
    }

    // With d the stopping change and q the same weighted by each contact's restitution: y += f (d + q). The factor
    // f = -d.y / d.d is one except for rounding and the error of sweeps, and makes e = 1 a Householder reflection,
    // which keeps the energy for any d. Where restitutions differ d + q may gain energy: it is then scaled down until
    // it does not.
    bool reflect() {
        projection_.solve(active_, lambda_, bound(cluster_));
        const double f = 0.5 * reflection();
        // Between closing walls no stopping change exists, and the impulses cancel: no bounce.
        if (!(f > 0.0 && f < 2.0)) return false;
        for (std::size_t i = 0; i < active_.size(); ++i) lambda_[i] *= 1.0 + restitution_[i];
        apply(cluster_, active_, lambda_, std::min(f, reflection()), restitution_);
        std::fill(changed_.begin(), changed_.end(), 0);
        for (const ActiveSet::Demand& d : active_) changed_[bodies_[d.row].first] = changed_[bodies_[d.row].second] = 1;
        changed_.back() = 0;
        return true;
    }

    // The square of a body's change, which becomes zero: it counts once, and all are zero for the next use.
    static double taken(auto of_body) {
        const double square = of_body.squaredNorm();
        of_body.setZero();
        return square;
    }

    // Change::reflection() from the bodies of the active contacts alone: a pass touches few bodies of a heap.
    double reflection() {
        const double work_before = add_change(cluster_, active_, lambda_, change_);
        double square = 0.0;
        const auto count = [&](std::uint32_t body, std::uint32_t bodies) {
            if (body == VelocityRow::none) return;
            square += bodies == 1 ? taken(change_.segment<6>(6 * Eigen::Index(body)))
                                  : taken(change_.segment(6 * Eigen::Index(body), 6 * Eigen::Index(bodies)));
        };
        for (const ActiveSet::Demand& demand : active_) {
            const VelocityRow& row = cluster_.rows()[demand.row];
            count(row.a, row.bodies_a());
            count(row.b, row.bodies_b());
        }
        return reflection_factor(work_before, square);
    }

    bool elastic() const {
        return std::all_of(restitution_.begin(), restitution_.end(), [](double e) { return e == 1.0; });
    }

    // Inverse of the margin by which one direction can lie inside all contacts' half-spaces: |z| for the least z with
    // w_i . z >= 1. Every reflection moves y along z by at least that margin of its own length, so that all of them
    // together are no longer than |y| |z|. Zero for jammed sets, whose rows balance each other, and for sets too large
    // to compute: they get no more passes.
    double depth() {
        if (cluster_.size() > tuning::projection_contacts) return 0.0;
        std::vector<ActiveSet::Demand> all;
        for (std::size_t i = 0; i < cluster_.size(); ++i) all.push_back({std::uint32_t(i), -1.0, 1e-6});
        std::vector<double> lambda;
        if (!ActiveSet(cluster_.rows(), cluster_.bodies()).solve(all, lambda)) return 0.0;
        return std::sqrt(Change(cluster_, all, lambda).square);
    }

    // Between closing walls, each pass would increase the speeds.
    bool squeezed(int pass) {
        if (cluster_.wall_velocity() == 0.0) return false;
        if (pass > 0) return cluster_.velocity().norm() > longest_;
        longest_ = cluster_.velocity().norm() + impact_wedge * cluster_.wall_velocity();
        if (cluster_.size() > tuning::projection_contacts) return false;
        const double z = depth();
        return z == 0.0 || z > impact_deepest;
    }

    ImpactSystem& cluster_;
    double threshold_, slow_, longest_ = 0.0;
    ActiveSet projection_;
    std::vector<ActiveSet::Demand> active_;
    std::vector<double> restitution_, lambda_;
    Eigen::VectorXd change_;  // zero between uses
    std::vector<std::pair<std::uint32_t, std::uint32_t>>
        bodies_;                 // by contact: the positions of its bodies in the cluster
    std::vector<char> changed_;  // by position: whether the last pass may have changed it
    std::vector<char> rests_;    // by contact
};

}  // namespace

double least_impact(const Contact& c, double threshold) {
    return std::max(threshold, tuning::restitution_threshold * c.load_speed);
}

bool bounces(const ImpactSystem& cluster, double threshold) {
    for (std::size_t i = 0; i < cluster.size(); ++i)
        if (restitution_now(cluster, i, threshold) > 0.0) return true;
    return false;
}

int propagate(ImpactSystem& cluster, double threshold, double slow, double resting) {
    return Propagation(cluster, threshold, slow, resting).run();
}

bool stop(ImpactSystem& cluster) {
    std::vector<ActiveSet::Demand> all;
    for (std::size_t i = 0; i < cluster.size(); ++i) all.push_back(demand(cluster, i, 0.0));
    std::vector<double> lambda;
    const bool met = ActiveSet(cluster.rows(), cluster.bodies()).solve(all, lambda, bound(cluster));
    apply(cluster, all, lambda, std::min(1.0, Change(cluster, all, lambda).reflection()));
    return met;
}

// Newton's law needs more energy than available when restitutions differ, or when other contacts hit one that parts.
// Then y is interpolated between the solution y0 of e = 0 and Newton's, where the energy equals the initial one: both
// stop every approach, so all points between them do.
int resolve_together(ImpactSystem& cluster, double threshold) {
    if (!bounces(cluster, threshold)) return 0;
    std::vector<ActiveSet::Demand> stopping, bouncing;
    std::vector<double> restitution;
    bool elastic = true;
    for (std::size_t i = 0; i < cluster.size(); ++i) {
        const double e = restitution_now(cluster, i, threshold);
        restitution.push_back(e);
        stopping.push_back(demand(cluster, i, 0.0));
        bouncing.push_back(demand(cluster, i, e > 0.0 ? -e * cluster.speed(i) : 0.0));
        elastic = elastic && (!cluster.approaching(i) || e == 1.0);
    }
    ActiveSet projection(cluster.rows(), cluster.bodies());
    std::vector<double> lambda, least;
    const bool met = projection.solve(bouncing, lambda, bound(cluster));
    const Change newton(cluster, bouncing, lambda);
    if (!met || newton.gain() > 0.0) {
        projection.solve(stopping, least, bound(cluster));
        const Change stopped(cluster, stopping, least);
        // gain(s) = g0 + s slope + s^2 bend / 2, from g0 <= 0 at s = 0.
        const double bend = (newton.d - stopped.d).squaredNorm();
        const double slope = newton.work_before - stopped.work_before + stopped.d.dot(newton.d - stopped.d);
        const double root = std::sqrt(std::max(0.0, slope * slope - 2.0 * stopped.gain() * bend));
        // The positive root, without cancellation.
        const double s = slope > 0.0  ? -2.0 * stopped.gain() / (slope + root)
                         : bend > 0.0 ? (root - slope) / bend
                                      : 1.0;
        const double share = met ? std::clamp(s, 0.0, 1.0) : 0.0;
        elastic = elastic && met;
        for (std::size_t i = 0; i < lambda.size(); ++i) lambda[i] = share * lambda[i] + (1.0 - share) * least[i];
    }
    const double reflection = Change(cluster, bouncing, lambda).reflection();
    // With e = 1 throughout, the energy is kept to the last digits, not only bounded.
    apply(cluster, bouncing, lambda, elastic ? reflection : std::min(1.0, reflection), restitution);
    return 1;
}

}  // namespace tumble
