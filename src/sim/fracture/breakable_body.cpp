#include "sim/fracture/breakable_body.h"

#include "core/sort_unique.h"
#include "sim/dynamics/body_builder.h"

#include <algorithm>
#include <cmath>

namespace tumble {
namespace {

void vanish(Body& body) {
    body.type = BodyType::fixed;
    body.absent = true;
    body.breakable = body.asleep = body.jointed = body.flying = body.flew = false;
    body.inverse_mass = 0.0;
    body.track.reset();
    for (Vec3* v : {&body.momentum, &body.angular_momentum, &body.velocity, &body.angular_velocity,
                    &body.correction_velocity, &body.correction_angular_velocity, &body.gyration})
        v->setZero();
    body.inverse_inertia.setZero();
}

const Polyhedron& hull_in(const CollisionShape& collider) {
    return *std::get<std::shared_ptr<const Polyhedron>>(collider);
}

/// Pieces collide as shapes that are smaller by this share: a piece without clearance jams in its hole, as a rigid
/// wedge, as soon as it has turned by rounding. Not fitted: 0.1 mm of a hand's breadth. Related test:
/// Fracture.ABallGoesThrough.
constexpr double clearance = 2e-3;

CollisionShape smaller(const CollisionShape& collider) {
    Polyhedron hull = hull_in(collider);
    for (Vec3& vertex : hull.vertices) vertex *= 1.0 - clearance;
    hull.complete();
    return std::make_shared<const Polyhedron>(std::move(hull));
}

// m, of a point outside of the nearest plane of a cell; negative inside.
double outside(const Polyhedron& hull, const Vec3& point) {
    double most = -infinity;
    for (const Polyhedron::Face& face : hull.faces) most = std::max(most, face.normal.dot(point) - face.offset);
    return most;
}

BondGraph graph_of(const FractureDescription& fracture, std::span<const std::uint32_t> own,
                   const std::vector<Body>& bodies) {
    std::vector<MassProperties> cells;
    for (const std::uint32_t i : own)
        cells.push_back({bodies[i].mass, bodies[i].center_of_mass, bodies[i].inertia_body});
    return BondGraph(fracture, std::move(cells));
}

std::vector<std::uint32_t> own_bodies(const FractureDescription& fracture, std::span<const std::uint32_t> place) {
    std::vector<std::uint32_t> own;
    for (std::size_t k = 0; k < fracture.pieces; ++k) own.push_back(place[fracture.first_piece + k]);
    return own;
}

}  // namespace

BreakableBody::BreakableBody(const SceneDescription& scene, std::size_t scene_body,
                             std::span<const std::uint32_t> place, std::vector<Body>& bodies)
    : description_(scene.bodies[scene_body].fracture),
      graph_(graph_of(*description_, own_bodies(*description_, place), bodies)),
      whole_(place[scene_body]),
      own_(own_bodies(*description_, place)),
      piece_(own_.size(), whole_),
      pieces_{whole_},
      generation_(own_.size(), 0),
      cut_(description_->bonds.size(), 0),
      type_(bodies[whole_].type),
      track_(bodies[whole_].track),
      center_(bodies[whole_].center_of_mass),
      blow_time_(description_->blow_time) {
    for (const std::uint32_t i : own_) {
        Body& body = bodies[i];
        cells_.push_back({{body.mass, body.center_of_mass, body.inertia_body}, smaller(body.collider)});
        vanish(body);
    }
    bodies[whole_].breakable = true;
}

const Polyhedron& BreakableBody::hull_of(std::uint32_t cell) const { return hull_in(cells_[cell].collider); }

void BreakableBody::rebuild(std::vector<Body>& bodies) {
    BondGraph graph = graph_;
    for (std::uint32_t k = 0; k < cut_.size(); ++k)
        if (cut_[k] != 0) graph.cut(k);
    const std::vector<int> generation = generation_;
    part(std::move(graph), bodies);
    generation_ = generation;
}

std::vector<std::uint32_t> BreakableBody::cells_of(std::uint32_t piece) const {
    std::vector<std::uint32_t> cells;
    for (std::uint32_t k = 0; k < cells_.size(); ++k)
        if (piece_[k] == piece) cells.push_back(k);
    return cells;
}

bool BreakableBody::may_break(std::uint32_t piece) const {
    const auto first = std::find(piece_.begin(), piece_.end(), piece);
    if (first == piece_.end()) return false;
    const int generation = generation_[std::size_t(first - piece_.begin())];
    return !description_->depth || generation <= *description_->depth;
}

std::uint32_t BreakableBody::piece_at(const Vec3& point) const {
    return piece_[nearest_cell(point, [](std::uint32_t) { return true; })];
}

std::uint32_t BreakableBody::cell_at(std::uint32_t piece, const Vec3& point) const {
    return nearest_cell(point, [&](std::uint32_t k) { return piece_[k] == piece; });
}

template <class Choose>
std::uint32_t BreakableBody::nearest_cell(const Vec3& point, const Choose& choose) const {
    std::uint32_t nearest = 0;
    double least = infinity;
    for (std::uint32_t k = 0; k < cells_.size(); ++k) {
        if (!choose(k)) continue;
        const double now = outside(hull_of(k), point - cells_[k].mass.center_of_mass);
        if (now >= least) continue;
        least = now;
        nearest = k;
    }
    return nearest;
}

BreakRecord BreakableBody::record(std::uint32_t k, const Wrench& wrench) const {
    const Bond& bond = graph_.bond(k);
    BreakRecord r;
    r.bond = k;
    r.area = bond.area;
    r.tension = wrench.force.dot(bond.normal);
    r.shear = (wrench.force - r.tension * bond.normal).norm();
    const double torsion = wrench.torque.dot(bond.normal);
    r.torsion = std::abs(torsion);
    r.bending = (wrench.torque - torsion * bond.normal).norm();
    return r;
}

// A body of these cells, at rest.
void BreakableBody::compose(const std::vector<std::uint32_t>& cells, Body& body) const {
    if (cells.size() == 1) {
        give_mass(body, cells_[cells[0]].mass, cells_[cells[0]].collider);
        return;
    }
    std::vector<MassProperties> masses;
    for (const std::uint32_t k : cells) masses.push_back(cells_[k].mass);
    const MassProperties sum = sum_of_masses(masses);
    auto compound = std::make_shared<Compound>();
    for (const std::uint32_t k : cells)
        compound->parts.push_back(
            {cells_[k].collider, {cells_[k].mass.center_of_mass - sum.center_of_mass, Mat3::Identity()}});
    compound->complete();
    give_mass(body, sum, std::shared_ptr<const Compound>(std::move(compound)));
}

// The pieces of a body, which vanishes.
BreakableBody::Parting BreakableBody::part(std::uint32_t old, const BondGraph& graph, std::vector<Body>& bodies) {
    const std::vector<std::uint32_t> cells = cells_of(old);
    Parting parting{bodies[old], old, {}};
    const Body& from = parting.whole;
    vanish(bodies[old]);
    for (const std::uint32_t first : cells) {
        if (graph.component(first) != first) continue;
        std::vector<std::uint32_t> members;
        for (const std::uint32_t k : cells)
            if (graph.component(k) == first) members.push_back(k);
        const std::uint32_t index = own_[first];
        Body& body = bodies[index];
        parting.pieces.push_back(index);
        for (const std::uint32_t k : members) {
            piece_[k] = index;
            ++generation_[k];
        }
        body.absent = false;
        body.breakable = members.size() > 1 || graph.held(first);
        body.type = BodyType::dynamic;
        compose(members, body);
        body.orientation = from.orientation;
        body.rotation = from.rotation;
        body.position = from.origin() + body.rotation * body.center_of_mass;
        body.velocity = from.point_velocity(body.position - from.position);
        body.angular_velocity = from.angular_velocity;
        if (graph.held(first)) {
            body.type = type_;
            body.track = track_;
            body.mass = body.inverse_mass = 0.0;
            body.inverse_inertia.setZero();
            continue;
        }
        body.momentum = body.mass * body.velocity;
        body.angular_momentum =
            body.rotation * (body.inertia_body * (body.rotation.transpose() * body.angular_velocity));
        body.derive();
    }
    return parting;
}

std::vector<BreakableBody::Parting> BreakableBody::part(BondGraph graph, std::vector<Body>& bodies) {
    std::vector<Parting> partings;
    for (const std::uint32_t old : std::vector<std::uint32_t>(pieces_)) {
        const auto first = std::uint32_t(std::find(piece_.begin(), piece_.end(), old) - piece_.begin());
        const auto held = [&](const BondGraph& of) { return of.held(of.component(first)); };
        bool apart = held(graph) != held(graph_);
        for (std::uint32_t k = first; k < piece_.size(); ++k)
            apart = apart || (piece_[k] == old && graph.component(k) != graph.component(first));
        if (apart) partings.push_back(part(old, graph, bodies));
    }
    in_pieces_ = in_pieces_ || !partings.empty();
    pieces_ = piece_;
    sort_unique(pieces_);
    graph_ = std::move(graph);
    for (std::uint32_t k = 0; k < cut_.size(); ++k) cut_[k] = !graph_.intact(k);
    return partings;
}

std::vector<std::uint32_t> failing_first(const BondGraph& graph, std::span<const double> utilization) {
    // Equal by symmetry but for rounding.
    constexpr double equal = 1.0 - 1e-9;
    std::vector<double> most(graph.cell_count(), 0.0);
    const auto visit = [&](const auto& use) {
        for (std::uint32_t k = 0; k < utilization.size(); ++k) {
            const Bond& bond = graph.bond(k);
            use(k, bond.a, bond.b == Bond::world ? bond.a : bond.b);
        }
    };
    visit([&](std::uint32_t k, std::uint32_t a, std::uint32_t b) {
        most[a] = std::max(most[a], utilization[k]);
        most[b] = std::max(most[b], utilization[k]);
    });
    std::vector<std::uint32_t> first;
    visit([&](std::uint32_t k, std::uint32_t a, std::uint32_t b) {
        if (utilization[k] >= 1.0 && utilization[k] >= equal * std::max(most[a], most[b])) first.push_back(k);
    });
    return first;
}

std::vector<std::uint32_t> changed_bodies(std::span<const BreakableBody::Parting> partings) {
    std::vector<std::uint32_t> changed;
    for (const BreakableBody::Parting& parting : partings) {
        changed.push_back(parting.index);
        changed.insert(changed.end(), parting.pieces.begin(), parting.pieces.end());
    }
    sort_unique(changed);
    return changed;
}

}  // namespace tumble
