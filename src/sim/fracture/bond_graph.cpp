#include "sim/fracture/bond_graph.h"

#include "core/check.h"
#include "core/disjoint_sets.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace tumble {
namespace {

constexpr double shear_ratio = 2.6;  // Young's modulus over the shear modulus, for Poisson's ratio 0.3

Mat3 cross_matrix(const Vec3& r) {
    Mat3 m;
    m << 0.0, -r.z(), r.y(), r.z(), 0.0, -r.x(), -r.y(), r.x(), 0.0;
    return m;
}

Mat3 in_bond_frame(const Bond& bond, const Vec3& values) {
    Mat3 axes;
    axes << bond.normal, bond.axis1, bond.axis2;
    return axes * values.asDiagonal() * axes.transpose();
}

/// N m, with forces at a lever (m).
double largest_load(std::span<const Wrench> wrenches, double lever) {
    double most = 0.0;
    for (const Wrench& wrench : wrenches) most = std::max(most, lever * wrench.force.norm() + wrench.torque.norm());
    return most;
}

}  // namespace

BondGraph::BondGraph(const FractureDescription& fracture, std::vector<MassProperties> cells)
    : fracture_(&fracture),
      bonds_(fracture.bonds),
      cells_(std::move(cells)),
      intact_(bonds_.size(), 1),
      wrenches_(bonds_.size()) {
    const double young = fracture.stiffness, shear = young / shear_ratio;
    std::vector<BlockCholesky::Pair> pairs;
    for (const Bond& bond : bonds_) {
        const double a = bond.area / bond.length, i1 = bond.moment1 / bond.length, i2 = bond.moment2 / bond.length;
        stiffness_.push_back({in_bond_frame(bond, Vec3(young * a, shear * a, shear * a)),
                              in_bond_frame(bond, Vec3(shear * (i1 + i2), young * i1, young * i2))});
        lever_ = std::max(lever_, bond.length);
        pair_of_.push_back(std::uint32_t(pairs.size()));
        if (bond.b != Bond::world) pairs.push_back({bond.a, bond.b});
    }
    matrix_.analyze(cells_.size(), pairs);
    find_components();
}

void BondGraph::cut(std::size_t bond) {
    TUMBLE_CHECK_EQ(int(intact_[bond]), 1);
    intact_[bond] = 0;
    factored_ = false;
    find_components();
}

void BondGraph::find_components() {
    DisjointSets sets(cells_.size());
    for (std::size_t i = 0; i < bonds_.size(); ++i)
        if (intact_[i] && bonds_[i].b != Bond::world) sets.join(bonds_[i].a, bonds_[i].b);
    component_.resize(cells_.size());
    for (std::size_t i = 0; i < cells_.size(); ++i) component_[i] = std::uint32_t(sets.root(i));
    held_.assign(cells_.size(), 0);
    for (std::size_t i = 0; i < bonds_.size(); ++i)
        if (intact_[i] && bonds_[i].b == Bond::world) held_[component_[bonds_[i].a]] = 1;
}

/// Strains of the bond by the motion of a cell: [1, -r x; 0, 1], with r from the cell's center to the bond's.
BondGraph::Block BondGraph::on_cell(std::size_t bond, std::uint32_t cell) const {
    Block strain = Block::Identity();
    strain.topRightCorner<3, 3>() = -cross_matrix(bonds_[bond].center - cells_[cell].center_of_mass);
    return strain;
}

void BondGraph::add_block(const Block& block, BlockCholesky::Block& to, bool transposed) const {
    for (int r = 0; r < 6; ++r)
        for (int c = 0; c < 6; ++c) to.row[r][c] += transposed ? block(c, r) : block(r, c);
}

// Forces in bonds do not depend on the place of a component that nothing holds: its lowest cell stands still.
bool BondGraph::pinned(std::uint32_t cell) const { return component_[cell] == cell && !held(cell); }

// The stiffness matrix of all cells, with its diagonal enlarged by a share.
void BondGraph::assemble(double more) {
    matrix_.set_zero();
    for (std::uint32_t cell = 0; cell < cells_.size(); ++cell)
        if (pinned(cell)) add_block(Block::Identity(), matrix_.diagonal(cell), false);
    for (std::size_t i = 0; i < bonds_.size(); ++i) {
        if (!intact_[i]) continue;
        const auto [a, b] = std::pair(bonds_[i].a, bonds_[i].b);
        Block law = Block::Zero();
        law.topLeftCorner<3, 3>() = stiffness_[i].force;
        law.bottomRightCorner<3, 3>() = stiffness_[i].torque;
        const Block of_a = on_cell(i, a), force_a = of_a.transpose() * law;
        if (!pinned(a)) add_block(force_a * of_a, matrix_.diagonal(a), false);
        if (b == Bond::world) continue;
        const Block of_b = on_cell(i, b);
        if (!pinned(b)) add_block(of_b.transpose() * law * of_b, matrix_.diagonal(b), false);
        if (!pinned(a) && !pinned(b))
            add_block(-force_a * of_b, matrix_.coupling(pair_of_[i]), matrix_.transposed(pair_of_[i]));
    }
    for (std::uint32_t cell = 0; cell < cells_.size(); ++cell)
        for (int k = 0; k < 6; ++k) matrix_.diagonal(cell).row[k][k] *= 1.0 + more;
}

// A long thin chain can lose all digits in a pivot: a stiffer one does not, and the rounds of solve() correct it.
void BondGraph::factor() {
    assemble(0.0);
    for (double more = 1e-15; !matrix_.factor(); more *= 10.0) assemble(more);
    factored_ = true;
}

std::vector<Wrench> BondGraph::balanced(std::span<const Wrench> applied) const {
    struct Motion {
        std::vector<MassProperties> parts;
        MassProperties whole;
        Wrench load;  // about the center of mass
        Vec3 acceleration = Vec3::Zero(), turn = Vec3::Zero();
    };
    std::vector<Motion> motions(cells_.size());
    const auto motion_of = [&](std::size_t cell) -> Motion& { return motions[component_[cell]]; };
    for (std::size_t i = 0; i < cells_.size(); ++i)
        if (!held(component_[i])) motion_of(i).parts.push_back(cells_[i]);
    for (Motion& motion : motions) motion.whole = sum_of_masses(motion.parts);
    for (std::size_t i = 0; i < cells_.size(); ++i) {
        Motion& motion = motion_of(i);
        motion.load.force += applied[i].force;
        motion.load.torque +=
            applied[i].torque + (cells_[i].center_of_mass - motion.whole.center_of_mass).cross(applied[i].force);
    }
    for (Motion& motion : motions) {
        if (motion.parts.empty()) continue;
        motion.acceleration = motion.load.force / motion.whole.mass;
        motion.turn = motion.whole.inertia.inverse() * motion.load.torque;
    }
    std::vector<Wrench> loads(applied.begin(), applied.end());
    for (std::size_t i = 0; i < cells_.size(); ++i) {
        const Motion& motion = motion_of(i);
        if (motion.parts.empty()) continue;
        const Vec3 r = cells_[i].center_of_mass - motion.whole.center_of_mass;
        loads[i].force -= cells_[i].mass * (motion.acceleration + motion.turn.cross(r));
        loads[i].torque -= cells_[i].inertia * motion.turn;
    }
    return loads;
}

/// Adds the wrenches of the displacements in the solution.
void BondGraph::add_displacement() {
    const auto vector = [&](std::uint32_t cell, std::size_t part) {
        const double* x = solution_.data() + 6 * std::size_t(cell) + 3 * part;
        return Vec3(x[0], x[1], x[2]);
    };
    for (std::size_t i = 0; i < bonds_.size(); ++i) {
        if (!intact_[i]) continue;
        const Bond& bond = bonds_[i];
        const auto at_bond = [&](std::uint32_t cell) {
            return Vec3(vector(cell, 0) + vector(cell, 1).cross(bond.center - cells_[cell].center_of_mass));
        };
        Vec3 gap = -at_bond(bond.a), bend = -vector(bond.a, 1);
        if (bond.b != Bond::world) {
            gap += at_bond(bond.b);
            bend += vector(bond.b, 1);
        }
        wrenches_[i].force += stiffness_[i].force * gap;
        wrenches_[i].torque += stiffness_[i].torque * bend;
    }
}

/// Loads of the cells together with the wrenches of their bonds; zero in equilibrium.
std::vector<Wrench> BondGraph::with_bonds(std::vector<Wrench> loads) const {
    for (std::size_t i = 0; i < bonds_.size(); ++i) {
        const auto add = [&](std::uint32_t cell, double sign) {
            const Vec3 r = bonds_[i].center - cells_[cell].center_of_mass;
            loads[cell].force += sign * wrenches_[i].force;
            loads[cell].torque += sign * (wrenches_[i].torque + r.cross(wrenches_[i].force));
        };
        add(bonds_[i].a, 1.0);
        if (bonds_[i].b != Bond::world) add(bonds_[i].b, -1.0);
    }
    return loads;
}

// Displacements of long chains lose digits: their forces are corrected by the rest of the loads.
std::span<const Wrench> BondGraph::solve(std::span<const Wrench> applied) {
    constexpr int most_rounds = 8;
    constexpr double rounding = 1e-13;  // of the largest load
    TUMBLE_CHECK_EQ(applied.size(), cells_.size());
    if (!factored_) factor();
    const std::vector<Wrench> loads = balanced(applied);
    std::fill(wrenches_.begin(), wrenches_.end(), Wrench{});
    const double enough = rounding * largest_load(loads, lever_);
    for (int round = 0; round < most_rounds; ++round) {
        std::vector<Wrench> rest = with_bonds(loads);
        for (std::uint32_t cell = 0; cell < cells_.size(); ++cell)
            if (pinned(cell)) rest[cell] = {};
        if (largest_load(rest, lever_) <= enough) break;
        solution_.clear();
        for (const Wrench& wrench : rest)
            for (const Vec3& v : {wrench.force, wrench.torque})
                solution_.insert(solution_.end(), v.data(), v.data() + 3);
        matrix_.solve(solution_);
        add_displacement();
    }
    return wrenches_;
}

BondStress BondGraph::stress(std::size_t i, const Wrench& wrench) const {
    const Bond& bond = bonds_[i];
    const double pull = bond.normal.dot(wrench.force), twist = bond.normal.dot(wrench.torque);
    return {pull / bond.area,
            std::abs(bond.axis1.dot(wrench.torque)) / bond.modulus1 +
                std::abs(bond.axis2.dot(wrench.torque)) / bond.modulus2,
            (wrench.force - pull * bond.normal).norm() / bond.area, std::abs(twist) / bond.polar_modulus};
}

double BondGraph::utilization(std::size_t i, const Wrench& wrench) const {
    const BondStress s = stress(i, wrench);
    double most = std::max((std::max(s.tension, 0.0) + s.bending) / fracture_->strength,
                           (s.shear + s.torsion) / fracture_->shear_strength);
    if (fracture_->compressive_strength > 0.0)
        most = std::max(most, (std::max(-s.tension, 0.0) + s.bending) / fracture_->compressive_strength);
    return most;
}

double BondGraph::energy(std::size_t i, const Wrench& wrench) const {
    const Vec3 gap = stiffness_[i].force.inverse() * wrench.force,
               bend = stiffness_[i].torque.inverse() * wrench.torque;
    return 0.5 * (wrench.force.dot(gap) + wrench.torque.dot(bend));
}

}  // namespace tumble
