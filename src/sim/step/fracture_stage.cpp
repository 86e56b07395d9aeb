#include "sim/step/fracture_stage.h"

#include "core/sort_unique.h"
#include "sim/fracture/spread_load.h"
#include "sim/geometry/contact_tolerance.h"
#include "sim/log/contact_log.h"
#include "sim/step/contact_detection.h"
#include "sim/step/impact_stage.h"
#include "sim/step/motion_stage.h"
#include "sim/step/step_context.h"

#include <memory>
#include <utility>

namespace tumble {
namespace {

/// Loads that have changed by less than this share of themselves, times the share of its strength that the weakest bond
/// has left, are not examined again. Limits the cost of resting bodies.
constexpr double changed_load = 0.01;

/// Times of a blow after which the mean of a constant load has come within e^-7, 0.1 %, of it.
constexpr double settling_times = 7.0;

/// Share of a speed below which rounding does not matter. Not fitted.
constexpr double surely_below = 0.99;

// m/s, at least the speed at which points of two bodies approach each other that are within `reach` (m) of both.
double fastest_approach(const Body& a, const Body& b, double reach) {
    double sum = (b.velocity - a.velocity).cwiseAbs().sum();
    for (const Body* body : {&a, &b}) {
        const double spin = body->angular_velocity.cwiseAbs().sum();
        if (spin > 0.0) sum += spin * (body->radius + reach);
    }
    return sum;
}

}  // namespace

// Only bodies that break are resolved here: each time the contacts are found again, of one body less.
void FractureStage::strike(const StepContext& step, ContactDetection& detection, MotionStage& motion) {
    if (empty()) return;
    while (strike_one(step, detection, motion)) detection.update(step, motion);
}

// Each cell takes its own impulse, as the pieces will.
bool FractureStage::blast(const StepContext& step, ContactDetection& detection, MotionStage& motion) {
    if (empty() || step.forces.field().explosions().empty()) return false;
    const auto explosions = step.forces.field().explosions().within(step.start(), step.end());
    if (explosions.empty()) return false;
    std::vector<BreakableBody::Parting> partings;
    for (std::uint32_t entry = 0; entry < bodies_.size(); ++entry) {
        const BreakableBody& body = bodies_[entry];
        std::vector<Wrench> loads(body.cells());
        for (std::uint32_t cell = 0; cell < body.cells(); ++cell) {
            const Body& piece = step.set.bodies[body.piece_of(cell)];
            if (!piece.dynamic()) continue;
            const Vec3& center = body.mass_of(cell).center_of_mass;
            const Pose pose{piece.origin() + piece.rotation * center, piece.rotation};
            for (const ExplosionDescription& explosion : explosions) {
                const Vec3 force = impulse_of(explosion, body.collider_of(cell), pose) / body.blow_time();
                const Vec3 arm = explosion.center - pose.position;
                loads[cell].force += piece.rotation.transpose() * force;
                loads[cell].torque += piece.rotation.transpose() * arm.cross(force);
            }
        }
        std::vector<BreakRecord> breaks;
        double utilization = 0.0;
        if (std::optional<BondGraph> graph = cut(entry, loads, step, breaks, utilization))
            part(entry, std::move(*graph), breaks, step, partings);
    }
    finish(partings, step, detection, motion);
    return !partings.empty();
}

// True if a breakable body is hit faster than resting contact.
bool FractureStage::struck(std::span<const std::uint32_t> manifolds, const StepContext& step,
                           ContactDetection& detection) const {
    const std::vector<Body>& bodies = step.set.bodies;
    const double threshold = ImpactStage::threshold(step);
    for (const std::uint32_t k : manifolds) {
        const Manifold& m = detection.manifolds()[k];
        const Body &a = bodies[m.a], &b = bodies[m.b];
        if (!a.breakable && !b.breakable) continue;
        const double touch = touch_distance(a.radius, b.radius);
        if (fastest_approach(a, b, touch) < surely_below * threshold) continue;
        for (int i = 0; i < m.count; ++i) {
            const ContactPoint& p = m.points[std::size_t(i)];
            if (p.separation <= touch && relative_velocity(p, m.normal, a, b) < -threshold) return true;
        }
    }
    return false;
}

bool FractureStage::strike_one(const StepContext& step, ContactDetection& detection, MotionStage& motion) {
    const ContactIslands& islands = detection.islands();
    for (std::size_t k = 0; k < islands.size(); ++k) {
        if (!struck(islands.manifolds(k), step, detection)) continue;
        Island island = island_of(k, islands, step.joints);
        std::vector<Contact> contacts;
        for (const std::uint32_t m : islands.manifolds(k))
            add_contacts(detection.manifolds()[m], step.set.bodies, contacts);
        for (std::uint32_t i = 0; i < contacts.size(); ++i) island.contacts.push_back(i);
        Blow blow(island, contacts, step.set.bodies, bodies_, step.joints.joints(), ImpactStage::settings(step));
        if (!blow.resolve()) continue;
        take(blow.result(), step, step.impact_time());
        exchange(changed_bodies(blow.result().partings), step, detection);
        motion.exchange(step, changed_bodies(blow.result().partings));
        return true;
    }
    return false;
}

// The motion after the blow, and its records.
void FractureStage::take(const BlowResult& result, const StepContext& step, const ImpactTime& when) {
    std::vector<Body>& bodies = step.set.bodies;
    ImpactTrace trace;
    if (step.log) {
        for (const BreakableBody::Parting& parting : result.partings)
            step.log->hand_over(parting.index, parting.whole.dynamic(), parting.pieces, bodies);
        for (std::uint32_t i = 0; i < result.contacts.size(); ++i) {
            const Contact& c = result.contacts[i];
            if (!(c.impact > 0.0)) continue;
            trace.entries.push_back({i, 0, relative_velocity(c, bodies[c.a], bodies[c.b]), 0.0, 0.0, c.impact});
        }
        trace.passes = 1;
    }
    for (std::size_t k = 0; k < result.struck.size(); ++k) {
        Body& body = bodies[result.struck[k]];
        body.velocity = result.velocities[k].velocity;
        body.angular_velocity = result.velocities[k].angular_velocity;
    }
    if (step.log) {
        for (ImpactTrace::Entry& entry : trace.entries) {
            const Contact& c = result.contacts[entry.contact];
            entry.speed_after = relative_velocity(c, bodies[c.a], bodies[c.b]);
        }
        step.log->add_impact(trace, result.contacts, bodies, when);
        step.log->add_surface(result.surface, result.struck);
    }
    for (const std::uint32_t i : result.struck) {
        Body& body = bodies[i];
        body.momentum = body.mass * body.velocity;
        body.angular_momentum =
            body.rotation * (body.inertia_body * (body.rotation.transpose() * body.angular_velocity));
        body.derive_velocities();
    }
    for (BreakRecord r : result.breaks) {
        r.time = when.time;
        r.body = step.set.scene_index[r.body];
        breaks_.push_back(r);
    }
}

FractureStage::Load FractureStage::load_on(const Body& body, const Vec3& force, const Vec3& torque, const Vec3& point) {
    const Mat3 to_body = body.rotation.transpose();
    return {to_body * force, to_body * torque, to_body * (point - body.origin())};
}

// The forces of contacts and joints in the step.
void FractureStage::find_loads(const StepContext& step, ContactDetection& detection) {
    const std::vector<Body>& bodies = step.set.bodies;
    loads_.clear();
    const auto add = [&](std::uint32_t body, const Vec3& force, const Vec3& torque, const Vec3& point,
                         std::uint32_t manifold) {
        if (body != Joint::world && bodies[body].breakable)
            loads_.push_back({bodies_.entry_of(body), body, manifold, load_on(bodies[body], force, torque, point)});
    };
    const double rate = 1.0 / step.h;
    for (std::uint32_t k = 0; k < detection.manifolds().size(); ++k) {
        const Manifold& m = detection.manifolds()[k];
        if (!bodies[m.a].breakable && !bodies[m.b].breakable) continue;
        Vec3 middle = Vec3::Zero();
        double sum = 0.0;
        for (int i = 0; i < m.count; ++i) {
            const ContactPoint& p = m.points[std::size_t(i)];
            middle += p.impulse * p.position;
            sum += p.impulse;
        }
        if (!(sum > 0.0)) continue;
        for (const std::uint32_t body : {m.a, m.b})
            for (int i = 0; i < m.count; ++i) {
                const ContactPoint& p = m.points[std::size_t(i)];
                add(body, (body == m.a ? -rate : rate) * p.impulse * m.normal, Vec3::Zero(), p.position, k);
            }
        const Vec3 friction = rate * (m.friction[0] * m.tangent + m.friction[1] * m.normal.cross(m.tangent)),
                   torsion = rate * m.torsion * m.normal;
        add(m.a, -friction, -torsion, middle / sum, no_manifold);
        add(m.b, friction, torsion, middle / sum, no_manifold);
    }
    for (const std::uint32_t i : step.forces.field().pushed()) {
        if (!bodies[i].breakable) continue;
        step.forces.field().each_point(i, step.start() - 0.5 * step.h, [&](const ForceDescription& f) {
            const Body& body = bodies[i];
            const Vec3 force = f.body_frame ? Vec3(body.rotation * f.force) : f.force;
            add(i, force, Vec3::Zero(), body.origin() + body.rotation * f.point, no_manifold);
        });
    }
    for (const Joint& joint : step.joints.joints()) {
        if (!joint.active || joint.broken || joint.gear()) continue;
        add(joint.a, -joint.force, -joint.torque, joint.point, no_manifold);
        add(joint.b, joint.force, joint.torque, joint.point, no_manifold);
    }
    const auto by_entry = [](const PieceLoad& l, const PieceLoad& r) { return l.entry < r.entry; };
    if (!std::is_sorted(loads_.begin(), loads_.end(), by_entry))
        std::stable_sort(loads_.begin(), loads_.end(), by_entry);
}

void FractureStage::yield(const StepContext& step, ContactDetection& detection, MotionStage& motion) {
    if (empty() || watch_.quiet(detection.manifolds(), step)) return;
    find_loads(step, detection);
    margins_.assign(bodies_.size(), {});
    std::vector<BreakableBody::Parting> partings;
    auto from = loads_.begin();
    for (std::uint32_t entry = 0; entry < bodies_.size(); ++entry) {
        const auto to = std::find_if(from, loads_.end(), [&](const PieceLoad& l) { return l.entry != entry; });
        const std::span<const PieceLoad> loads(std::to_address(from), std::size_t(to - from));
        from = to;
        std::vector<BreakRecord> breaks;
        std::optional<BondGraph> graph = examine(entry, loads, step, breaks);
        if (!graph) continue;
        part(entry, std::move(*graph), breaks, step, partings);
    }
    finish(partings, step, detection, motion);
    const bool settled =
        std::all_of(last_.begin(), last_.end(), [](const Examined& last) { return last.settling == 0; });
    if (partings.empty() && settled)
        watch_.note(detection.manifolds(), step, bodies_, margins_);
    else
        watch_.forget();
}

void FractureStage::part(std::uint32_t entry, BondGraph graph, std::vector<BreakRecord>& breaks,
                         const StepContext& step, std::vector<BreakableBody::Parting>& partings) {
    const std::size_t before = partings.size();
    for (const std::uint32_t i : bodies_[entry].pieces()) step.sleep.wake(i, step.set.bodies);
    for (BreakableBody::Parting& parting : bodies_[entry].part(std::move(graph), step.set.bodies)) {
        if (step.log) step.log->hand_over(parting.index, parting.whole.dynamic(), parting.pieces, step.set.bodies);
        partings.push_back(std::move(parting));
    }
    if (partings.size() == before) return;
    for (BreakRecord& r : breaks) {
        r.pieces = bodies_[entry].pieces().size();
        breaks_.push_back(r);
    }
}

void FractureStage::finish(std::span<const BreakableBody::Parting> partings, const StepContext& step,
                           ContactDetection& detection, MotionStage& motion) {
    if (partings.empty()) return;
    bodies_.attach(step.joints.joints(), step.set.bodies);
    exchange(changed_bodies(partings), step, detection);
    motion.exchange(step, changed_bodies(partings));
}

FractureStage::Difference FractureStage::difference(const std::vector<Load>& then, const std::vector<Load>& now,
                                                    double size) {
    Difference d;
    for (std::size_t i = 0; i < now.size(); ++i) {
        const Load &a = then[i], &b = now[i];
        const double force = b.force.norm(), moved = (b.point - a.point).norm();
        d.sum += force + b.torque.norm() / size;
        d.change += (b.force - a.force).norm() + ((b.torque - a.torque).norm() + force * moved) / size;
        d.moved = std::max(d.moved, moved / size);
    }
    return d;
}

// The bonds that remain; nothing if all of them hold.
std::optional<BondGraph> FractureStage::examine(std::uint32_t entry, std::span<const PieceLoad> piece_loads,
                                                const StepContext& step, std::vector<BreakRecord>& breaks) {
    const std::vector<Body>& bodies = step.set.bodies;
    BreakableBody& body = bodies_[entry];
    const auto may_break = [&](std::uint32_t i) {
        return bodies[i].breakable && !bodies[i].asleep && body.may_break(i);
    };
    std::vector<Load>& now = now_;
    now.clear();
    double size = 0.0;
    for (const PieceLoad& l : piece_loads)
        if (may_break(l.piece)) now.push_back(l.load);
    for (const std::uint32_t i : body.pieces()) {
        const Body& piece = bodies[i];
        if (!may_break(i)) continue;
        size = std::max(size, piece.radius);
        // Rotation as a force at the rim, and the weight of held pieces.
        Load own;
        if (piece.dynamic())
            own.force = piece.mass * piece.radius * piece.angular_velocity.norm() *
                        (piece.rotation.transpose() * piece.angular_velocity);
        else
            own.force = piece.rotation.transpose() * step.settings.gravity;
        if (!own.force.isZero(0.0)) now.push_back(own);
    }
    Examined& last = last_[entry];
    if (now.empty() && last.loads.empty()) return std::nullopt;
    const bool sleeps = std::none_of(body.pieces().begin(), body.pieces().end(), may_break);
    const double share = std::min(1.0, step.h / body.blow_time());  // of a step in the mean
    // Asleep it keeps its last loads.
    bool changed = false;
    if (!sleeps) {
        Difference now_differs;
        const double unexamined = changed_load * std::max(0.0, 1.0 - last.utilization);
        if (now.size() == last.loads.size()) now_differs = difference(last.loads, now, size);
        changed = now.size() != last.loads.size() || now_differs.change > unexamined * now_differs.sum;
        margins_[entry] = {unexamined * now_differs.sum - now_differs.change, now_differs.sum, size, now_differs.moved};
    }
    if (changed)
        last.settling = share < 1.0 ? int(settling_times / share) : 0;
    else if (last.settling == 0)
        return std::nullopt;
    else
        --last.settling;
    last.utilization = 0.0;
    if (!sleeps) {
        last.loads.swap(now);
        last.cells = loads_of_cells(entry, piece_loads, step);
    }
    last.means.resize(last.cells.size());
    for (std::size_t cell = 0; cell < last.cells.size(); ++cell) {
        Wrench& mean = last.means[cell];
        mean.force += share * (last.cells[cell].force - mean.force);
        mean.torque += share * (last.cells[cell].torque - mean.torque);
    }
    std::optional<BondGraph> left = cut(entry, last.means, step, breaks, last.utilization);
    if (!sleeps) {
        const double sum = difference(last.loads, last.loads, size).sum;
        margins_[entry] = {changed_load * std::max(0.0, 1.0 - last.utilization) * sum, sum, size, 0.0};
    }
    return left;
}

std::vector<Wrench> FractureStage::loads_of_cells(std::uint32_t entry, std::span<const PieceLoad> piece_loads,
                                                  const StepContext& step) const {
    const std::vector<Body>& bodies = step.set.bodies;
    const BreakableBody& body = bodies_[entry];
    std::vector<Wrench> loads(body.cells());
    const auto put = [&](std::uint32_t cell, const Load& load) {
        loads[cell].force += load.force;
        loads[cell].torque += (load.point - body.mass_of(cell).center_of_mass).cross(load.force) + load.torque;
    };
    std::vector<PointForce> points;
    std::vector<CellForce> spread;
    for (auto from = piece_loads.begin(); from != piece_loads.end();) {
        if (from->manifold == no_manifold) {
            put(body.cell_at(from->piece, from->load.point), from->load);
            ++from;
            continue;
        }
        points.clear();
        spread.clear();
        const PieceLoad& first = *from;
        for (; from != piece_loads.end() && from->manifold == first.manifold && from->piece == first.piece; ++from)
            points.push_back({from->load.point, from->load.force});
        Vec3 sum = Vec3::Zero();
        for (const PointForce& p : points) sum += p.force;
        spread_load(body, first.piece, sum.normalized(), points, spread);
        for (const CellForce& f : spread) put(f.cell, {f.at.force, Vec3::Zero(), f.at.point});
    }
    for (std::uint32_t cell = 0; cell < body.cells(); ++cell) {
        const Body& piece = bodies[body.piece_of(cell)];
        const Mat3 to_body = piece.rotation.transpose();
        const MassProperties& own = body.mass_of(cell);
        loads[cell].force += own.mass * (to_body * piece.fall(step.settings.gravity));
        if (!piece.dynamic()) continue;
        const Wrench turns = rotation_load(own, to_body * piece.angular_velocity, piece.center_of_mass);
        loads[cell].force += turns.force;
        loads[cell].torque += turns.torque;
    }
    return loads;
}

std::optional<BondGraph> FractureStage::cut(std::uint32_t entry, std::span<const Wrench> loads, const StepContext& step,
                                            std::vector<BreakRecord>& breaks, double& weakest) {
    BreakableBody& body = bodies_[entry];
    std::optional<BondGraph> left;
    for (bool more = true; more;) {
        BondGraph& graph = left ? *left : body.graph();
        std::vector<double> utilization(graph.bond_count(), 0.0);
        const auto wrenches = graph.solve(loads);
        for (std::uint32_t k = 0; k < graph.bond_count(); ++k)
            if (graph.intact(k) && body.may_break(body.piece_of(graph.bond(k).a)))
                utilization[k] = graph.utilization(k, wrenches[k]);
        if (!left) weakest = *std::max_element(utilization.begin(), utilization.end());
        const std::vector<std::uint32_t> fails = failing_first(graph, utilization);
        for (const std::uint32_t k : fails) {
            BreakRecord r = body.record(k, wrenches[k]);
            r.time = step.start();
            r.body = step.set.scene_index[body.whole()];
            breaks.push_back(r);
        }
        more = !fails.empty();
        if (more && !left) left = graph;
        for (const std::uint32_t k : fails) left->cut(k);
    }
    return left;
}

const BlowResult* FractureStage::strike(const Island& island, const std::vector<Contact>& contacts,
                                        const ImpactSettings& settings, const ImpactTime& when,
                                        const StepContext& step) {
    Blow blow(island, contacts, step.set.bodies, bodies_, step.joints.joints(), settings);
    if (!blow.resolve()) return nullptr;
    event_ = blow.result();
    take(event_, step, when);
    for (const std::uint32_t i : changed_bodies(event_.partings)) exchanged_.push_back(i);
    return &event_;
}

void FractureStage::finish_events(const StepContext& step, ContactDetection& detection, MotionStage& motion) {
    if (exchanged_.empty()) return;
    sort_unique(exchanged_);
    exchange(exchanged_, step, detection);
    motion.measure(step.set.bodies);
    exchanged_.clear();
}

// All that knows bodies by their index or their shape, but their motion.
void FractureStage::exchange(std::span<const std::uint32_t> changed, const StepContext& step,
                             ContactDetection& detection) {
    watch_.forget();
    move_forces(step);
    step.set.exchange(changed);
    step.sleep.exchange(changed);
    step.joints.exchange(step.set.bodies);
    detection.exchange(step.set.bodies, changed);
}

// Forces at points act on the pieces that hold the points, forces between bodies on all pieces, and water on their
// shapes.
void FractureStage::move_forces(const StepContext& step) const {
    if (!step.forces.field().pairs().empty()) step.forces.break_pairs(in_pieces());
    for (std::uint32_t i = 0; i < step.set.bodies.size() && step.forces.field().has_water(); ++i) {
        const Body& body = step.set.bodies[i];
        if (bodies_.entry_of(i) != BreakableBodies::none && body.dynamic() && !body.absent)
            step.forces.reshape(i, body);
    }
    const std::vector<std::uint32_t> pushed(step.forces.field().pushed().begin(), step.forces.field().pushed().end());
    for (const std::uint32_t i : pushed) {
        const std::uint32_t entry = bodies_.entry_of(i);
        if (entry == BreakableBodies::none) continue;
        step.forces.move_points(i, [&](const Vec3& point) { return bodies_[entry].piece_at(point); });
    }
}

std::vector<BodyInPieces> FractureStage::in_pieces() const {
    std::vector<BodyInPieces> all;
    for (std::uint32_t entry = 0; entry < bodies_.size(); ++entry) {
        const BreakableBody& body = bodies_[entry];
        if (!body.in_pieces()) continue;
        BodyInPieces& broken = all.emplace_back();
        broken.whole = body.whole();
        double sum = 0.0;
        for (const std::uint32_t piece : body.pieces()) {
            double mass = 0.0;
            for (const std::uint32_t cell : body.cells_of(piece)) mass += body.mass_of(cell).mass;
            broken.pieces.push_back({piece, mass});
            sum += mass;
        }
        for (BodyInPieces::Piece& piece : broken.pieces) piece.share /= sum;
    }
    return all;
}

void FractureStage::restored(const StepContext& step, MotionStage& motion) const {
    move_forces(step);
    if (!empty()) motion.measure(step.set.bodies);
}

}  // namespace tumble
