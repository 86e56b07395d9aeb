#include "sim/impact/impact_friction.h"

#include <algorithm>
#include <cmath>

namespace tumble {
namespace {

/// Sweeps of friction over an impact system. Not fitted: a bound of the cost.
constexpr int friction_sweeps = 400;

/// Relaxations of contacts in a large system in all, with this least number of sweeps. Each sweep lowers the energy, so
/// any may be the last. Not fitted: bounds of the cost.
constexpr int friction_work = 400;
constexpr int friction_least_sweeps = 2;

/// Change of speed, relative to the slip, at which friction has converged: between steps, and at a step, whose own
/// error is larger. Not fitted.
constexpr double friction_tolerance = 1e-14;
constexpr double friction_tolerance_step = 1e-5;

/// Contacts with friction up to which that tolerance holds, and the tolerance for more. Limits the cost.
constexpr std::size_t friction_few = 8;
constexpr double friction_tolerance_many = 1e-6;

/// Contacts of an impact up to which contacts with friction are relaxed at once, so that no order shows: a rack of 15
/// balls has 47. Beyond, one after the other takes fewer sweeps. Limits the cost. Related test:
/// Rack.BouncesAsItsMirrorImage.
constexpr std::size_t friction_at_once = 128;

/// Sweeps at once in which friction's limits follow the normal impulses. Not fitted: most impacts need fewer.
constexpr int friction_follow = 100;

/// Newton steps to the edge of a friction disc. The method converges quadratically: 4 to 8 are enough for any
/// compliance. Not fitted: a bound of the cost.
constexpr int friction_newton = 50;

// Minimizes k0 f0^2 / 2 + k1 f1^2 / 2 + g0 f0 + g1 f1 over the disc |f| <= radius. On the edge f_i = -g_i / (k_i + nu),
// with nu >= 0 the root of 1/|f(nu)| = 1/radius, which Newton's steps approach from the left (More and Sorensen 1983,
// "Computing a trust region step").
std::pair<double, double> least_in_disc(double k0, double k1, double g0, double g1, double radius, double tolerance) {
    double f0 = -g0 / k0, f1 = -g1 / k1;
    double length = std::sqrt(f0 * f0 + f1 * f1);
    if (length <= radius) return {f0, f1};
    if (!(radius > 0.0)) return {0.0, 0.0};
    double nu = 0.0;
    for (int i = 0; i < friction_newton && length - radius > tolerance * radius; ++i) {
        const double slope = f0 * f0 / (k0 + nu) + f1 * f1 / (k1 + nu);
        nu += length * length / slope * (length - radius) / radius;
        f0 = -g0 / (k0 + nu);
        f1 = -g1 / (k1 + nu);
        length = std::sqrt(f0 * f0 + f1 * f1);
    }
    const double back = std::min(1.0, radius / length);
    return {back * f0, back * f1};
}

}  // namespace

ImpactFriction::Block ImpactFriction::make_block(ImpactSystem& cluster, std::size_t contact) {
    Contact c = cluster.contact(contact);
    c.arm_a += c.rub;
    c.arm_b += c.rub;
    Block block;
    block.contact = contact;
    const Vec3 t = c.normal.unitOrthogonal(), s = c.normal.cross(t);
    const VelocityRow along_t = cluster.relative_row(c, t), along_s = cluster.relative_row(c, s);
    const double tt = along_t.squared_norm(), ss = along_s.squared_norm(), ts = along_t.dot(along_s);
    // Eigenvectors of the two-by-two compliance.
    const double half = 0.5 * (tt - ss), root = std::sqrt(half * half + ts * ts);
    double cosine = 1.0, sine = 0.0;
    if (root > 0.0) {
        const double x = half >= 0.0 ? half + root : std::abs(ts),
                     y = half >= 0.0 ? ts : std::copysign(root - half, ts);
        const double norm = std::sqrt(x * x + y * y);
        cosine = x / norm;
        sine = y / norm;
    }
    block.first = cosine * t + sine * s;
    block.second = cosine * s - sine * t;
    block.first_row = cluster.relative_row(c, block.first);
    block.second_row = cluster.relative_row(c, block.second);
    block.first_offset = cluster.offset(c, block.first);
    block.second_offset = cluster.offset(c, block.second);
    block.first_compliance = block.first_row.squared_norm();
    block.second_compliance = block.second_row.squared_norm();
    // Joints may leave no motion along a direction: no friction there.
    const double normal_compliance = cluster.length(contact) * cluster.length(contact);
    if (block.first_compliance == 0.0) {
        block.first_compliance = normal_compliance;
        block.first_offset = 0.0;
    }
    if (block.second_compliance == 0.0) {
        block.second_compliance = normal_compliance;
        block.second_offset = 0.0;
    }
    block.normal_first = cluster.length(contact) * cluster.rows()[contact].dot(block.first_row);
    block.normal_second = cluster.length(contact) * cluster.rows()[contact].dot(block.second_row);
    return block;
}

// Without a normal impulse there is no friction: most contacts of a heap have none in an impact.
void ImpactFriction::add_blocks(ImpactSystem& cluster) {
    const std::size_t before = blocks_.size();
    for (std::size_t i = 0; i < cluster.contacts(); ++i) {
        if (has_block_[i] || !cluster.felt(i) || cluster.contact(i).friction <= 0.0) continue;
        has_block_[i] = 1;
        blocks_.push_back(make_block(cluster, i));
    }
    if (blocks_.size() == before) return;
    std::sort(blocks_.begin(), blocks_.end(), [](const Block& l, const Block& r) { return l.contact < r.contact; });
}

double ImpactFriction::tolerance() const {
    if (blocks_.size() > friction_few) return friction_tolerance_many;
    return precision_ == Precision::last_digits ? friction_tolerance : friction_tolerance_step;
}

int ImpactFriction::most_sweeps() const {
    if (blocks_.size() <= friction_few) return friction_sweeps;
    return std::max(friction_least_sweeps, friction_work / int(blocks_.size()));
}

// N s, of the block's friction when its normal impulse grows by `added`.
double ImpactFriction::limit(const ImpactSystem& cluster, const Block& block, double added) const {
    if (limits_held_) return block.limit;
    return cluster.contact(block.contact).friction * std::max(0.0, cluster.impulse(block.contact) + added);
}

// Solves a lone block's three impulses; among others does one round towards them, for `crowd` times its compliance.
ImpactFriction::Step ImpactFriction::relaxed(const ImpactSystem& cluster, const Block& block, Normal normal,
                                             double crowd) const {
    const std::size_t i = block.contact;
    const double length = cluster.length(i), k0 = crowd * block.first_compliance, k1 = crowd * block.second_compliance,
                 kn = crowd * length * length;
    double parting = normal == Normal::adapted ? cluster.speed(i) : block.kept, added = 0.0;
    double slip0 = block.first_row.dot(cluster.velocity()) + block.first_offset;
    double slip1 = block.second_row.dot(cluster.velocity()) + block.second_offset;
    double f0 = block.f0, f1 = block.f1, change = 0.0;
    const int rounds = blocks_.size() < 2 && normal == Normal::adapted ? friction_sweeps : 1;
    for (int round = 0; round < rounds; ++round) {
        const double grown = std::max((block.kept - parting) / kn, -cluster.impulse(i) - added);
        added += grown;
        slip0 += crowd * block.normal_first * grown;
        slip1 += crowd * block.normal_second * grown;
        const auto [next0, next1] =
            least_in_disc(k0, k1, slip0 - k0 * f0, slip1 - k1 * f1, limit(cluster, block, added), tolerance());
        const double step0 = next0 - f0, step1 = next1 - f1;
        f0 = next0;
        f1 = next1;
        parting += kn * grown + crowd * (block.normal_first * step0 + block.normal_second * step1);
        slip0 += k0 * step0;
        slip1 += k1 * step1;
        // By its length: the directions are arbitrary where both compliances are the same.
        const double slid = std::sqrt(k0 * step0 * (k0 * step0) + k1 * step1 * (k1 * step1));
        const double now = std::max(kn * std::abs(grown), slid);
        change = std::max(change, now);
        if (now <= tolerance() * change) break;
    }
    return {added, f0 - block.f0, f1 - block.f1, change};
}

void ImpactFriction::take(ImpactSystem& cluster, Block& block, const Step& step) {
    if (step.normal != 0.0) cluster.apply(block.contact, step.normal * cluster.length(block.contact));
    cluster.apply_along(block.first_row, step.f0);
    cluster.apply_along(block.second_row, step.f1);
    block.f0 += step.f0;
    block.f1 += step.f1;
}

// By block: the number of blocks with which it shares the body that has more of them.
void ImpactFriction::find_crowds(const ImpactSystem& cluster) {
    std::vector<int> blocks(cluster.bodies(), 0);  // by body
    const auto each_body = [&](const Block& block, auto&& visit) {
        const VelocityRow& row = cluster.rows()[block.contact];
        for (const auto& [first, count] : {std::pair(row.a, row.bodies_a()), std::pair(row.b, row.bodies_b())})
            for (std::uint32_t k = 0; first != VelocityRow::none && k < count; ++k) visit(first + k);
    };
    for (const Block& block : blocks_) each_body(block, [&](std::uint32_t body) { ++blocks[body]; });
    crowds_.clear();
    for (const Block& block : blocks_) {
        int most = 1;
        each_body(block, [&](std::uint32_t body) { most = std::max(most, blocks[body]); });
        crowds_.push_back(double(most));
    }
}

// All blocks at once from the same velocities, so that no order of contacts shows in the answer: each as if its bodies'
// masses were divided among their blocks (Tonge, Benevolenski and Voroshilov 2012, "Mass splitting"), accelerated
// (Nesterov 1983) and restarted where that overshoots (O'Donoghue and Candes 2015). Returns the largest change of speed
// in a sweep.
double ImpactFriction::relax_at_once(ImpactSystem& cluster, Normal normal) {
    find_crowds(cluster);
    moved_.assign(blocks_.size(), Step{});
    double most = 0.0, time = 1.0, ahead = 0.0;
    limits_held_ = false;
    const int sweeps = precision_ == Precision::last_digits ? friction_sweeps : most_sweeps();
    for (int sweep = 1;; ++sweep) {
        double change = 0.0, along = 0.0;
        steps_.clear();
        for (std::size_t k = 0; k < blocks_.size(); ++k) {
            const Block& block = blocks_[k];
            const Step& step = steps_.emplace_back(relaxed(cluster, block, normal, crowds_[k]));
            change = std::max(change, step.change);
            Step& moved = moved_[k];
            moved = {step.normal + ahead * moved.normal, step.f0 + ahead * moved.f0, step.f1 + ahead * moved.f1, 0.0};
            const double length = cluster.length(block.contact);
            along += crowds_[k] *
                     (length * length * step.normal * moved.normal + block.first_compliance * step.f0 * moved.f0 +
                      block.second_compliance * step.f1 * moved.f1);
        }
        most = std::max(most, change);
        const bool last = sweep == sweeps || change <= tolerance() * most;
        const double next = 0.5 * (1.0 + std::sqrt(1.0 + 4.0 * time * time));
        ahead = last || along < 0.0 ? 0.0 : (time - 1.0) / next;
        time = along < 0.0 ? 1.0 : next;
        for (std::size_t k = 0; k < blocks_.size(); ++k) {
            const Step &step = steps_[k], &moved = moved_[k];
            take(cluster, blocks_[k],
                 {step.normal + ahead * moved.normal, step.f0 + ahead * moved.f0, step.f1 + ahead * moved.f1, 0.0});
        }
        if (last) break;
        if (sweep == friction_follow) hold_limits(cluster);
    }
    if (limits_held_) let_limits_go(cluster);
    return most;
}

// Where limits and loads drive each other, their sweeps have no end, and would amplify rounding.
void ImpactFriction::hold_limits(const ImpactSystem& cluster) {
    for (Block& block : blocks_) block.limit = limit(cluster, block, 0.0);
    limits_held_ = true;
}

// Friction returns into the cones of the normal impulses.
void ImpactFriction::let_limits_go(ImpactSystem& cluster) {
    limits_held_ = false;
    for (Block& block : blocks_) {
        const double size = std::sqrt(block.f0 * block.f0 + block.f1 * block.f1);
        const double most = limit(cluster, block, 0.0);
        if (size > most)
            take(cluster, block, {0.0, (most / size - 1.0) * block.f0, (most / size - 1.0) * block.f1, 0.0});
    }
}

// Returns the largest change of speed in a sweep.
double ImpactFriction::relax_all(ImpactSystem& cluster, Normal normal) {
    if (blocks_.size() > 1 && cluster.contacts() <= friction_at_once) return relax_at_once(cluster, normal);
    double most = 0.0;
    for (int sweep = 0; sweep < most_sweeps(); ++sweep) {
        double change = 0.0;
        for (Block& block : blocks_) {
            const Step step = relaxed(cluster, block, normal, 1.0);
            take(cluster, block, step);
            change = std::max(change, step.change);
        }
        most = std::max(most, change);
        if (blocks_.size() < 2 || change <= tolerance() * most) break;
    }
    return most;
}

ImpactFriction::State ImpactFriction::state(const ImpactSystem& cluster, const Block& block) {
    return {{cluster.impulse(block.contact), block.f0, block.f1},
            {cluster.speed(block.contact), block.first_row.dot(cluster.velocity()) + block.first_offset,
             block.second_row.dot(cluster.velocity()) + block.second_offset}};
}

void ImpactFriction::collect(const ImpactSystem& cluster, std::vector<State>& states) const {
    states.clear();
    for (const Block& block : blocks_) states.push_back(state(cluster, block));
}

// Interpolates between two sets of impulses of the cluster.
void ImpactFriction::set(ImpactSystem& cluster, const std::vector<State>& from, const std::vector<State>& to,
                         double share) {
    for (std::size_t k = 0; k < blocks_.size(); ++k) {
        Block& block = blocks_[k];
        const auto step = [&](std::size_t i) { return share * (to[k].impulse[i] - from[k].impulse[i]); };
        cluster.apply(block.contact, step(0) * cluster.length(block.contact));
        cluster.apply_along(block.first_row, step(1));
        cluster.apply_along(block.second_row, step(2));
        block.f0 += step(1);
        block.f1 += step(2);
    }
}

// Impulses that change by d and change their speeds from u to u + K d do the work d . u + d . K d / 2, K the
// compliance.
void ImpactFriction::limit_energy(ImpactSystem& cluster) {
    const auto sum = [&](const std::vector<State>& from, const std::vector<State>& to, auto&& term) {
        double all = 0.0;
        for (std::size_t k = 0; k < blocks_.size(); ++k)
            for (std::size_t i = 0; i < 3; ++i)
                all += (to[k].impulse[i] - from[k].impulse[i]) * term(from[k].speed[i], to[k].speed[i]);
        return all;
    };
    const auto mean = [](double from, double to) { return 0.5 * (from + to); };
    collect(cluster, kept_);
    if (sum(start_, kept_, mean) <= 0.0) return;
    set(cluster, kept_, start_, 1.0);
    relax_all(cluster, Normal::fixed);
    collect(cluster, least_);
    // gain(s) = g0 + s slope + s^2 bend, from g0 <= 0 at s = 0 to more than 0 at s = 1: the root in between, without
    // cancellation.
    const double g0 = std::min(0.0, sum(start_, least_, mean)),
                 slope = sum(least_, kept_, [](double from, double) { return from; });
    const double bend = 0.5 * sum(least_, kept_, [](double from, double to) { return to - from; });
    const double root = std::sqrt(std::max(0.0, slope * slope - 4.0 * bend * g0));
    const double share = slope > 0.0 ? -2.0 * g0 / (slope + root) : bend > 0.0 ? (root - slope) / (2.0 * bend) : 1.0;
    set(cluster, least_, kept_, std::clamp(share, 0.0, 1.0));
}

bool ImpactFriction::apply(ImpactSystem& cluster) {
    add_blocks(cluster);
    collect(cluster, start_);
    for (std::size_t k = 0; k < blocks_.size(); ++k) blocks_[k].kept = start_[k].speed[0];
    const double most = relax_all(cluster, Normal::adapted);
    limit_energy(cluster);
    return most > cluster.rounding();
}

void ImpactFriction::store(const ImpactSystem& cluster, std::vector<Contact>& contacts) const {
    for (const Block& block : blocks_)
        contacts[cluster.contact_index(block.contact)].impact_friction =
            block.f0 * block.first + block.f1 * block.second;
}

}  // namespace tumble
