// The bonds between the cells of a body that can break: their forces under a load, and their failure.
// Cells are rigid. Each bond is a short elastic beam with the section of the shared face, so that the forces in the
// bonds are those with the least elastic energy. SI units; the frame of the whole.
#pragma once

#include "core/vector.h"
#include "scene/description/fracture.h"
#include "sim/math/block_cholesky.h"
#include "sim/math/mass_properties.h"
#include "sim/math/wrench.h"

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace tumble {

/// The largest stresses in a bond, Pa.
struct BondStress {
    double tension = 0.0;  // below 0: compression
    double bending = 0.0, shear = 0.0, torsion = 0.0;
};

/// Load of a cell by the rotation of its body about a point, on its center of mass (d'Alembert): -m w x (w x r) and
/// -w x I w.
inline Wrench rotation_load(const MassProperties& cell, const Vec3& angular_velocity, const Vec3& about) {
    const Vec3& w = angular_velocity;
    return {-cell.mass * w.cross(w.cross(cell.center_of_mass - about)), -w.cross(cell.inertia * w)};
}

class BondGraph {
public:
    /// `cells`: by volume and density, about their centers of mass. `fracture` must outlive the graph.
    BondGraph(const FractureDescription& fracture, std::vector<MassProperties> cells);

    std::size_t cell_count() const { return cells_.size(); }
    std::size_t bond_count() const { return bonds_.size(); }
    const Bond& bond(std::size_t i) const { return bonds_[i]; }
    bool intact(std::size_t bond) const { return intact_[bond] != 0; }
    void cut(std::size_t bond);

    /// The lowest cell that intact bonds join with this one.
    std::uint32_t component(std::size_t cell) const { return component_[cell]; }
    /// True for cells that intact bonds hold to the world.
    bool held(std::size_t component) const { return held_[component] != 0; }

    /// Wrenches on cell `a` of each bond, about the bond's center; zero for a cut one. `applied`: on the cells, about
    /// their centers of mass. A component that nothing holds takes the part of them that accelerates it as a rigid body
    /// (d'Alembert).
    std::span<const Wrench> solve(std::span<const Wrench> applied);

    BondStress stress(std::size_t bond, const Wrench& wrench) const;
    /// The load over the strength, the largest of tension with bending, of shear with torsion, and of compression with
    /// bending: a bond fails from 1 on.
    double utilization(std::size_t bond, const Wrench& wrench) const;
    /// Elastic energy of a bond, J.
    double energy(std::size_t bond, const Wrench& wrench) const;

private:
    using Block = Eigen::Matrix<double, 6, 6>;

    /// Stiffness of a bond: of forces by displacements and of torques by rotations.
    struct Stiffness {
        Mat3 force, torque;
    };

    void find_components();
    bool pinned(std::uint32_t cell) const;
    void assemble(double more);
    void factor();
    void add_block(const Block& block, BlockCholesky::Block& to, bool transposed) const;
    Block on_cell(std::size_t bond, std::uint32_t cell) const;
    std::vector<Wrench> balanced(std::span<const Wrench> applied) const;
    std::vector<Wrench> with_bonds(std::vector<Wrench> loads) const;
    void add_displacement();

    const FractureDescription* fracture_;
    std::span<const Bond> bonds_;
    std::vector<MassProperties> cells_;
    std::vector<Stiffness> stiffness_;  // of each bond
    std::vector<char> intact_;          // of each bond
    std::vector<std::uint32_t> component_;
    std::vector<char> held_;              // of each component, by its lowest cell
    std::vector<std::uint32_t> pair_of_;  // of each bond between cells: its coupling in the matrix
    BlockCholesky matrix_;
    bool factored_ = false;
    double lever_ = 0.0;            // m, the longest bond: compares forces with torques
    std::vector<double> solution_;  // six numbers for each cell: displacement, rotation
    std::vector<Wrench> wrenches_;
};

}  // namespace tumble
