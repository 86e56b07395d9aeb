#include "sim/fracture/blow.h"

#include "core/sort_unique.h"
#include "sim/fracture/spread_load.h"

#include <algorithm>
#include <cmath>
#include <optional>

namespace tumble {
namespace {

/// Energies that differ by less than this share are equal. Not fitted: rounding of an impact of many pieces.
constexpr double energy_rounding = 1e-9;

}  // namespace

Blow::Blow(const Island& island, const std::vector<Contact>& contacts, std::vector<Body>& bodies,
           BreakableBodies& breakables, std::vector<Joint>& joints, const ImpactSettings& settings)
    : island_(island),
      contacts_(contacts),
      bodies_(bodies),
      breakables_(breakables),
      joints_(joints),
      settings_(settings) {
    settings_.complete = true;
    for (Contact& c : contacts_) {
        c.impact = c.bounce_velocity = 0.0;
        c.impact_friction.setZero();
    }
}

bool Blow::resolve() {
    find_sides();
    if (targets_.empty()) return false;
    start_ = velocities(island_);
    std::vector<Contact> whole = contacts_;
    if (!resolve_impact(island_, whole, settings_)) return false;
    std::vector<Failing> fails = failing(whole, sides_a_, sides_b_);
    set_velocities(island_, start_);
    if (fails.empty()) return false;

    ImpactSettings stop = settings_;
    stop.friction = false;
    std::vector<Contact> stopped = contacts_;
    for (Contact& c : stopped) c.restitution = 0.0;
    const bool solved = resolve_impact(island_, stopped, stop);
    const std::vector<BodyVelocity> rigid = velocities(island_);
    set_velocities(island_, start_);
    if (!solved) return false;

    std::optional<Trial> accepted, idle;  // idle: the last one so far, which frees no energy
    std::vector<BondGraph> graphs;        // of the accepted trial, by target
    std::size_t cuts = 0;
    double surface = 0.0;
    while (!fails.empty()) {
        cut(fails);
        Trial trial = part(rigid);
        const std::size_t pieces = trial.island.bodies.size();
        const Trial* last = accepted ? &*accepted : idle ? &*idle : nullptr;
        if (trial.partings.empty() || (last && last->island.bodies.size() == pieces)) {
            // The bodies are as they were: the loads are the same.
            fails = failing(last ? last->contacts : whole, last ? last->sides_a : sides_a_,
                            last ? last->sides_b : sides_b_);
            continue;
        }
        if (!resolve_impact(trial.island, trial.contacts, stop)) break;
        trial.free = velocities(trial.island);
        set_velocities(trial.island, trial.start);
        const double before = product(trial.island, trial.rigid, trial.rigid);
        const double after = product(trial.island, trial.free, trial.free);
        const bool pays = after - 2.0 * surface_ >= before - energy_rounding * after;
        // A piece that the rest pushes along frees nothing, but does not keep others from it.
        if (!pays && (accepted || after > before + energy_rounding * after)) break;
        fails = failing(trial.contacts, trial.sides_a, trial.sides_b);
        if (!pays) {
            idle = std::move(trial);
            continue;
        }
        accepted = std::move(trial);
        graphs.clear();
        for (const Target& t : targets_) graphs.push_back(t.graph);
        cuts = cut_.size();
        surface = surface_;
    }
    put_back();
    if (!accepted) {
        breakables_.attach(joints_, bodies_);
        return false;
    }
    for (std::size_t k = 0; k < targets_.size(); ++k) targets_[k].graph = graphs[k];
    cut_.resize(cuts);
    surface_ = surface;
    accepted->partings = part(rigid).partings;
    finish(*accepted, stopped);
    return true;
}

void Blow::find_sides() {
    const auto side = [&](std::uint32_t i, const Vec3& arm) {
        Side s;
        const std::uint32_t entry = breakables_.entry_of(i);
        if (entry == BreakableBodies::none || !bodies_[i].breakable || !breakables_[entry].may_break(i)) return s;
        s.entry = entry;
        s.point = bodies_[i].rotation.transpose() * arm + bodies_[i].center_of_mass;
        s.cell = breakables_[entry].cell_at(i, s.point);
        add_target(entry);
        return s;
    };
    for (const Contact& c : contacts_) {
        sides_a_.push_back(side(c.a, c.arm_a));
        sides_b_.push_back(side(c.b, c.arm_b));
    }
}

void Blow::add_target(std::uint32_t entry) {
    if (target(entry)) return;
    const BreakableBody& body = breakables_[entry];
    std::vector<std::uint32_t> all{body.whole()};
    for (std::uint32_t cell = 0; cell < body.cells(); ++cell) all.push_back(body.body_of(cell));
    Target t{entry, body, {}, body.graph()};
    for (const std::uint32_t i : all) t.saved.push_back({i, bodies_[i]});
    targets_.push_back(std::move(t));
}

Blow::Target* Blow::target(std::uint32_t entry) {
    const auto found =
        std::find_if(targets_.begin(), targets_.end(), [&](const Target& t) { return t.entry == entry; });
    return found == targets_.end() ? nullptr : &*found;
}

const Body& Blow::body_before(const Target& t, std::uint32_t cell) const {
    const std::uint32_t piece = t.before.piece_of(cell);
    return std::find_if(t.saved.begin(), t.saved.end(), [&](const auto& s) { return s.first == piece; })->second;
}

bool Blow::resolve_impact(const Island& island, std::vector<Contact>& contacts, const ImpactSettings& settings) {
    return resolve_impacts(island, contacts, bodies_, settings) != too_large;
}

std::vector<BodyVelocity> Blow::velocities(const Island& island) const {
    std::vector<BodyVelocity> list;
    for (const std::uint32_t i : island.bodies) list.push_back({bodies_[i].velocity, bodies_[i].angular_velocity});
    return list;
}

void Blow::set_velocities(const Island& island, const std::vector<BodyVelocity>& velocities) {
    for (std::size_t k = 0; k < island.bodies.size(); ++k) {
        bodies_[island.bodies[k]].velocity = velocities[k].velocity;
        bodies_[island.bodies[k]].angular_velocity = velocities[k].angular_velocity;
    }
}

// The bonds that the impulses on the contacts, as forces over the time of a blow, load beyond their strength.
std::vector<Blow::Failing> Blow::failing(const std::vector<Contact>& contacts, const std::vector<Side>& a,
                                         const std::vector<Side>& b) {
    std::vector<Failing> fails;
    for (Target& t : targets_) {
        std::vector<Wrench> loads(t.before.cells());
        const double rate = 1.0 / t.before.blow_time();
        const auto add = [&](std::uint32_t cell, const PointForce& at) {
            loads[cell].force += at.force;
            loads[cell].torque += (at.point - t.before.mass_of(cell).center_of_mass).cross(at.force);
        };
        // The contacts of one manifold follow each other.
        std::vector<PointForce> points;
        std::vector<CellForce> spread;
        const auto add_manifold = [&](const std::vector<Side>& sides, bool second, std::size_t from, std::size_t to) {
            for (std::size_t i = from; i < to;) {
                const Side& side = sides[i];
                const auto piece = [&](std::size_t k) { return second ? contacts[k].b : contacts[k].a; };
                const std::uint32_t on = piece(i);
                const Vec3 into = (second ? 1.0 : -1.0) * contacts[i].normal;
                points.clear();
                spread.clear();
                if (side.entry != t.entry) {
                    ++i;
                    continue;
                }
                const Mat3 to_body = body_before(t, side.cell).rotation.transpose();
                for (; i < to && piece(i) == on; ++i) {
                    const Vec3 friction = (second ? rate : -rate) * contacts[i].impact_friction;
                    if (!friction.isZero(0.0)) add(sides[i].cell, {sides[i].point, to_body * friction});
                    if (contacts[i].impact > 0.0)
                        points.push_back({sides[i].point, to_body * (rate * contacts[i].impact * into)});
                }
                spread_load(breakables_[t.entry], on, to_body * into, points, spread);
                for (const CellForce& f : spread) add(f.cell, f.at);
            }
        };
        for (std::size_t from = 0, to = 0; from < contacts.size(); from = to) {
            const Contact& c = contacts[from];
            for (to = from + 1; to < contacts.size() && contacts[to].part == c.part &&
                                contacts[to].normal == c.normal && to < contacts_.size() && from < contacts_.size() &&
                                contacts_[to].a == contacts_[from].a && contacts_[to].b == contacts_[from].b;)
                ++to;
            add_manifold(a, false, from, to);
            add_manifold(b, true, from, to);
        }
        const auto wrenches = t.graph.solve(loads);
        std::vector<double> utilization(t.graph.bond_count(), 0.0);
        for (std::uint32_t k = 0; k < t.graph.bond_count(); ++k)
            if (t.graph.intact(k) && t.before.may_break(t.before.piece_of(t.graph.bond(k).a)))
                utilization[k] = t.graph.utilization(k, wrenches[k]);
        for (const std::uint32_t k : failing_first(t.graph, utilization)) fails.push_back({t.entry, k, wrenches[k]});
    }
    return fails;
}

void Blow::cut(const std::vector<Failing>& fails) {
    for (const Failing& f : fails) {
        Target& t = *target(f.entry);
        t.graph.cut(f.bond);
        surface_ += t.before.description().toughness * t.graph.bond(f.bond).area;
        cut_.push_back(f);
    }
}

void Blow::put_back() {
    for (const Target& t : targets_) {
        breakables_[t.entry] = t.before;
        for (const auto& [index, body] : t.saved) bodies_[index] = body;
    }
}

Blow::Trial Blow::part(const std::vector<BodyVelocity>& rigid) {
    put_back();
    Trial trial;
    for (const Target& t : targets_)
        for (BreakableBody::Parting& parting : breakables_[t.entry].part(t.graph, bodies_))
            trial.partings.push_back(std::move(parting));
    breakables_.attach(joints_, bodies_);
    trial.island = island_;
    std::erase_if(trial.island.bodies, [&](std::uint32_t i) { return bodies_[i].absent; });
    for (const BreakableBody::Parting& parting : trial.partings)
        for (const std::uint32_t i : parting.pieces)
            if (bodies_[i].dynamic()) trial.island.bodies.push_back(i);
    sort_unique(trial.island.bodies);
    trial.start = velocities(trial.island);

    // The motion after the blow on the wholes.
    trial.rigid = trial.start;
    const auto place = [](const std::vector<std::uint32_t>& list, std::uint32_t i) {
        return std::size_t(std::lower_bound(list.begin(), list.end(), i) - list.begin());
    };
    for (std::size_t k = 0; k < island_.bodies.size(); ++k)
        if (!bodies_[island_.bodies[k]].absent) trial.rigid[place(trial.island.bodies, island_.bodies[k])] = rigid[k];
    for (const BreakableBody::Parting& parting : trial.partings)
        for (const std::uint32_t i : parting.pieces) {
            if (!bodies_[i].dynamic()) continue;
            BodyVelocity motion{parting.whole.velocity, parting.whole.angular_velocity};
            if (parting.whole.dynamic()) motion = rigid[place(island_.bodies, parting.index)];
            motion.velocity += motion.angular_velocity.cross(bodies_[i].position - parting.whole.position);
            trial.rigid[place(trial.island.bodies, i)] = motion;
        }
    set_contacts(trial);
    return trial;
}

// The same contacts, on the pieces and without restitution, and those of pieces at the bonds that failed.
void Blow::set_contacts(Trial& trial) const {
    trial.contacts = contacts_;
    trial.sides_a = sides_a_;
    trial.sides_b = sides_b_;
    const auto move = [&](const Side& side, std::uint32_t& body, Vec3& arm) {
        if (side.entry == BreakableBodies::none) return;
        body = breakables_[side.entry].piece_of(side.cell);
        arm = bodies_[body].rotation * (side.point - bodies_[body].center_of_mass);
    };
    for (std::size_t i = 0; i < trial.contacts.size(); ++i) {
        Contact& c = trial.contacts[i];
        move(sides_a_[i], c.a, c.arm_a);
        move(sides_b_[i], c.b, c.arm_b);
        c.restitution = 0.0;
    }
    for (const Failing& f : cut_) {
        const Bond& bond = breakables_[f.entry].graph().bond(f.bond);
        if (bond.b == Bond::world) continue;
        Contact c;
        const Side a{f.entry, bond.a, bond.center}, b{f.entry, bond.b, bond.center};
        move(a, c.a, c.arm_a);
        move(b, c.b, c.arm_b);
        if (c.a == c.b || (!bodies_[c.a].dynamic() && !bodies_[c.b].dynamic())) continue;
        c.normal = bodies_[c.a].rotation * bond.normal;
        trial.contacts.push_back(c);
        trial.sides_a.push_back(a);
        trial.sides_b.push_back(b);
    }
    trial.island.contacts.clear();
    for (std::uint32_t i = 0; i < trial.contacts.size(); ++i) trial.island.contacts.push_back(i);
}

// Sum of m v.v' + w.I w'; of a motion with itself twice its kinetic energy, J.
double Blow::product(const Island& island, const std::vector<BodyVelocity>& l,
                     const std::vector<BodyVelocity>& r) const {
    double sum = 0.0;
    for (std::size_t k = 0; k < island.bodies.size(); ++k) {
        const Body& body = bodies_[island.bodies[k]];
        const Mat3 to_body = body.rotation.transpose();
        sum += body.mass * l[k].velocity.dot(r[k].velocity) +
               (to_body * l[k].angular_velocity).dot(body.inertia_body * (to_body * r[k].angular_velocity));
    }
    return sum;
}

void Blow::finish(Trial& trial, const std::vector<Contact>& stopped) {
    std::vector<BodyVelocity> change = trial.free;
    for (std::size_t k = 0; k < change.size(); ++k) {
        change[k].velocity -= trial.rigid[k].velocity;
        change[k].angular_velocity -= trial.rigid[k].angular_velocity;
    }
    // |v_r + s d|^2 = |v_f|^2 - 2 E, the larger root.
    const double square = product(trial.island, change, change), half = product(trial.island, trial.rigid, change),
                 rigid = product(trial.island, trial.rigid, trial.rigid),
                 wanted = product(trial.island, trial.free, trial.free) - 2.0 * surface_;
    double share = 1.0;
    if (surface_ > 0.0 && square > 0.0)
        share =
            std::clamp((std::sqrt(std::max(0.0, half * half + square * (wanted - rigid))) - half) / square, 0.0, 1.0);
    for (std::size_t k = 0; k < change.size(); ++k)
        result_.velocities.push_back({trial.rigid[k].velocity + share * change[k].velocity,
                                      trial.rigid[k].angular_velocity + share * change[k].angular_velocity});
    for (std::size_t i = 0; i < trial.contacts.size(); ++i) {
        double& impact = trial.contacts[i].impact;
        impact = share * impact + (i < stopped.size() ? (1.0 - share) * stopped[i].impact : 0.0);
    }
    result_.struck = trial.island.bodies;
    result_.contacts = std::move(trial.contacts);
    result_.partings = std::move(trial.partings);
    result_.surface = surface_;
    for (const Failing& f : cut_) {
        const Target& t = *target(f.entry);
        BreakRecord r = t.before.record(f.bond, f.wrench);
        r.body = t.before.whole();
        r.energy = t.before.description().toughness * r.area;
        r.pieces = breakables_[f.entry].pieces().size();
        result_.breaks.push_back(r);
    }
}

}  // namespace tumble
