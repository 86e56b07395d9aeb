// Forces in the bonds of a body that can break, against closed forms of beams and the least elastic energy.
#include "sim/fracture/bond_graph.h"
#include "scene/load.h"
#include "sim/geometry/shapes/shape.h"

#include <gtest/gtest.h>
#include <Eigen/LU>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

namespace tumble::bond_graph_test {
namespace {

/// The first body of a scene, cut.
struct CutScene {
    SceneDescription scene;
    const FractureDescription& fracture;
    std::vector<MassProperties> cells;

    explicit CutScene(const std::string& body)
        : scene(parse_scene("format = 1\n[[body]]\n" + body, "bonds.toml")), fracture(*scene.bodies.front().fracture) {
        for (const BodyDescription& piece : scene.bodies)
            if (piece.piece_of) cells.push_back(mass_properties(piece));
    }
};

constexpr int slabs = 30;

/// A bar along x of slabs, from x = 0 at its end, as rods without a thickness.
struct Bar : CutScene {
    double length = 3.0, mass = 60.0;

    Bar()
        : CutScene(
              "density = 2000\nstrength = 1e5\nshear_strength = 1e9\nstiffness = 1e9\n"
              "shape = { type = \"box\", size = [3, 0.1, 0.1] }\n"
              "fracture = { cells = 30, pattern = \"slabs\" }\n") {
        for (MassProperties& cell : cells) {
            const double moment = cell.mass * (length / slabs) * (length / slabs) / 12.0;
            cell.inertia = Vec3(1e-6, moment, moment).asDiagonal();
        }
    }
    /// Place of a bond, over the length.
    static double place(std::size_t bond) { return double(bond + 1) / slabs; }
};

std::size_t worst(const BondGraph& graph, std::span<const Wrench> wrenches) {
    std::size_t most = 0;
    for (std::size_t i = 0; i < wrenches.size(); ++i)
        if (graph.utilization(i, wrenches[i]) > graph.utilization(most, wrenches[most])) most = i;
    return most;
}

TEST(BondGraph, AStruckBarBendsMostAThirdFromTheBlow) {
    const Bar bar;
    BondGraph graph(bar.fracture, bar.cells);
    const double blow = 5.0;
    std::vector<Wrench> loads(slabs);
    loads[0].force = Vec3(0.0, 0.0, blow);
    loads[0].torque = Vec3(-0.5 * bar.length / slabs, 0.0, 0.0).cross(loads[0].force);
    const std::span<const Wrench> wrenches = graph.solve(loads);
    for (std::size_t i = 0; i < wrenches.size(); ++i) {
        const double x = Bar::place(i);
        EXPECT_NEAR(-wrenches[i].force.z(), blow * (1.0 - 4.0 * x + 3.0 * x * x), 1e-9 * blow) << x;
        EXPECT_NEAR(std::abs(wrenches[i].torque.y()), blow * bar.length * x * (1.0 - x) * (1.0 - x), 1e-9 * blow) << x;
        EXPECT_NEAR(wrenches[i].force.x(), 0.0, 1e-9 * blow);
    }
    EXPECT_EQ(worst(graph, wrenches), 9u);  // between slabs 9 and 10 of 30
    const double stress = 4.0 / 27.0 * blow * bar.length / (0.1 * 0.1 * 0.1 / 6.0);
    EXPECT_NEAR(graph.utilization(9, wrenches[9]), stress / 1e5, 1e-9 * stress / 1e5);
}

TEST(BondGraph, AFallingChimneyBreaksAThirdUp) {
    const Bar bar;
    BondGraph graph(bar.fracture, bar.cells);
    const double angle = 0.257684, across = 9.81 * std::sin(angle);  // from upright
    std::vector<Wrench> loads(slabs);
    for (std::size_t i = 0; i < loads.size(); ++i) loads[i].force = Vec3(0.0, 0.0, -bar.cells[i].mass * across);
    const Vec3 hinge(0.0, 0.0, 0.25 * bar.mass * across);  // it holds a quarter of the weight
    loads[0].force += hinge;
    loads[0].torque += Vec3(-0.5 * bar.length / slabs, 0.0, 0.0).cross(hinge);
    const std::span<const Wrench> wrenches = graph.solve(loads);
    for (std::size_t i = 0; i < wrenches.size(); ++i) {
        const double x = Bar::place(i) * bar.length, rest = 1.0 - x / bar.length;
        EXPECT_NEAR(std::abs(wrenches[i].torque.y()), 0.25 * bar.mass * across * x * rest * rest, 1e-8) << x;
    }
    EXPECT_EQ(worst(graph, wrenches), 9u);
    EXPECT_NEAR(graph.utilization(9, wrenches[9]), 1.0, 3e-6);  // the angle has six digits
}

TEST(BondGraph, ASpinningBarBurstsInTheMiddle) {
    const CutScene bar(
        "density = 2500\nstrength = 30e6\nshape = { type = \"box\", size = [1, 0.02, 0.01] }\n"
        "fracture = { cells = 30, pattern = \"slabs\" }\n");
    BondGraph graph(bar.fracture, bar.cells);
    std::vector<Wrench> loads;
    for (const MassProperties& cell : bar.cells)
        loads.push_back(rotation_load(cell, Vec3(0.0, 309.838667696593, 0.0), Vec3(0.1, 0.0, 0.0)));
    const auto wrenches = graph.solve(loads);
    EXPECT_EQ(worst(graph, wrenches), 14u);
    EXPECT_NEAR(graph.utilization(14, wrenches[14]), 1.0, 1e-9);
    EXPECT_NEAR(graph.stress(14, wrenches[14]).tension, 30e6, 0.03);
}

TEST(BondGraph, AHangingBarTearsAtItsTop) {
    const CutScene bar(
        "type = \"fixed\"\ndensity = 2000\nstrength = 1e6\nshape = { type = \"box\", size = [1, 50.9683995922528, 1] "
        "}\n"
        "fracture = { cells = 50, pattern = \"slabs\", held = [\"+y\"] }\n");
    BondGraph graph(bar.fracture, bar.cells);
    EXPECT_TRUE(graph.held(graph.component(0)));
    std::vector<Wrench> loads(bar.cells.size());
    for (std::size_t i = 0; i < loads.size(); ++i) loads[i].force = Vec3(0.0, -9.81 * bar.cells[i].mass, 0.0);
    const auto wrenches = graph.solve(loads);
    const std::size_t top = worst(graph, wrenches);
    EXPECT_EQ(graph.bond(top).b, Bond::world);
    EXPECT_NEAR(graph.utilization(top, wrenches[top]), 1.0, 1e-10);
    EXPECT_NEAR(wrenches[top].force.y(), 9.81 * 2000.0 * 50.9683995922528, 1e-4);
    EXPECT_GT(graph.stress(top, wrenches[top]).tension, 0.0);
    graph.cut(top);
    EXPECT_FALSE(graph.held(graph.component(0)));
    for (const Wrench& wrench : graph.solve(loads)) EXPECT_NEAR(wrench.force.norm(), 0.0, 1e-3);  // it falls
}

TEST(BondGraph, ASymmetricFrameCarriesSymmetrically) {
    const CutScene frame(
        "type = \"fixed\"\nstrength = 1e6\nshape = { type = \"compound\", parts = ["
        "{ shape = { type = \"box\", size = [0.2, 1, 0.2] }, position = [-0.9, 0.5, 0] }, "
        "{ shape = { type = \"box\", size = [0.2, 1, 0.2] }, position = [0.9, 0.5, 0] }, "
        "{ shape = { type = \"box\", size = [2, 0.2, 0.2] }, position = [0, 1.1, 0] }] }\n"
        "fracture = { cells = 10, pattern = \"slabs\", axis = [1, 0, 0] }\n");
    ASSERT_EQ(frame.cells.size(), 12u);
    BondGraph graph(frame.fracture, frame.cells);
    std::vector<Wrench> loads(12);
    for (std::size_t i = 0; i < loads.size(); ++i) loads[i].force = Vec3(0.0, -9.81 * frame.cells[i].mass, 0.0);
    const auto wrenches = graph.solve(loads);
    std::vector<Wrench> feet;
    for (std::size_t i = 0; i < wrenches.size(); ++i)
        if (graph.bond(i).b == Bond::world) feet.push_back(wrenches[i]);
    ASSERT_EQ(feet.size(), 2u);
    const double weight = 9.81 * 1000.0 * 0.16;
    EXPECT_NEAR(feet[0].force.y(), 0.5 * weight, 1e-8 * weight);
    EXPECT_NEAR(feet[1].force.y(), 0.5 * weight, 1e-8 * weight);
    EXPECT_NEAR(feet[0].force.x(), -feet[1].force.x(), 1e-8 * weight);
    EXPECT_GT(feet[0].force.x(), 0.01 * weight);  // legs lean inward under the beam: the thrust of a portal
    EXPECT_NEAR(feet[0].torque.z(), -feet[1].torque.z(), 1e-8 * weight);
}

/// Equilibrium of a cell with the wrench of a bond: [1, 0; r x, 1].
Eigen::Matrix<double, 6, 6> on_cell(const Bond& bond, const MassProperties& cell) {
    Eigen::Matrix<double, 6, 6> m = Eigen::Matrix<double, 6, 6>::Identity();
    const Vec3 r = bond.center - cell.center_of_mass;
    m.bottomLeftCorner<3, 3>() << 0.0, -r.z(), r.y(), r.z(), 0.0, -r.x(), -r.y(), r.x(), 0.0;
    return m;
}

TEST(BondGraph, ForcesHaveTheLeastElasticEnergy) {
    const CutScene wall(
        "type = \"fixed\"\nstrength = 1e6\nshape = { type = \"box\", size = [1, 0.8, 0.6] }\nfracture = { cells = 12 "
        "}\n");
    BondGraph graph(wall.fracture, wall.cells);
    const auto cells = Eigen::Index(wall.cells.size()), bonds = Eigen::Index(graph.bond_count());
    ASSERT_GT(bonds, cells);  // statically indeterminate
    std::vector<Wrench> loads(wall.cells.size());
    for (std::size_t i = 0; i < loads.size(); ++i)
        loads[i] = {Vec3(1.0 + double(i), -2.0, 0.5 * double(i * i % 7)), Vec3(0.1, 0.2 * double(i % 3), -0.1)};
    // min 1/2 w C w with A w = -f, by its multipliers.
    Eigen::MatrixXd system = Eigen::MatrixXd::Zero(6 * (bonds + cells), 6 * (bonds + cells));
    Eigen::VectorXd right = Eigen::VectorXd::Zero(6 * (bonds + cells));
    const double young = wall.fracture.stiffness, shear = young / 2.6;
    for (Eigen::Index k = 0; k < bonds; ++k) {
        const Bond& b = graph.bond(std::size_t(k));
        Mat3 axes;
        axes << b.normal, b.axis1, b.axis2;
        const Vec3 force = b.length / b.area * Vec3(1.0 / young, 1.0 / shear, 1.0 / shear);
        const Vec3 torque = b.length * Vec3(1.0 / (shear * (b.moment1 + b.moment2)), 1.0 / (young * b.moment1),
                                            1.0 / (young * b.moment2));
        system.block<3, 3>(6 * k, 6 * k) = young * (axes * force.asDiagonal() * axes.transpose());
        system.block<3, 3>(6 * k + 3, 6 * k + 3) = young * (axes * torque.asDiagonal() * axes.transpose());
        const auto couple = [&](std::uint32_t cell, double sign) {
            const auto m = on_cell(b, wall.cells[cell]);
            const Eigen::Index row = 6 * (bonds + Eigen::Index(cell));
            system.block<6, 6>(row, 6 * k) = sign * m;
            system.block<6, 6>(6 * k, row) = sign * m.transpose();
        };
        couple(b.a, 1.0);
        if (b.b != Bond::world) couple(b.b, -1.0);
    }
    for (Eigen::Index i = 0; i < cells; ++i) {
        right.segment<3>(6 * (bonds + i)) = -loads[std::size_t(i)].force;
        right.segment<3>(6 * (bonds + i) + 3) = -loads[std::size_t(i)].torque;
    }
    const Eigen::VectorXd expected = system.fullPivLu().solve(right);
    const auto wrenches = graph.solve(loads);
    const double size = expected.head(6 * bonds).norm();
    double energy = 0.0;
    for (Eigen::Index k = 0; k < bonds; ++k) {
        const Wrench& wrench = wrenches[std::size_t(k)];
        EXPECT_NEAR((wrench.force - expected.segment<3>(6 * k)).norm(), 0.0, 1e-9 * size) << k;
        EXPECT_NEAR((wrench.torque - expected.segment<3>(6 * k + 3)).norm(), 0.0, 1e-9 * size) << k;
        energy += graph.energy(std::size_t(k), wrench);
    }
    const Eigen::VectorXd w = expected.head(6 * bonds);
    const double least = 0.5 * w.dot(system.topLeftCorner(6 * bonds, 6 * bonds) * w) / young;
    EXPECT_NEAR(energy, least, 1e-9 * least);
}

TEST(BondGraph, BondsThatAreCutCarryNothing) {
    const CutScene block("strength = 1e6\nshape = { type = \"box\", size = [1, 1, 1] }\nfracture = { cells = 20 }\n");
    BondGraph graph(block.fracture, block.cells);
    std::vector<Wrench> loads;
    for (const MassProperties& cell : block.cells)
        loads.push_back(rotation_load(cell, Vec3(1.0, 2.0, 3.0), Vec3::Zero()));
    loads[3].force += Vec3(1.0, 2.0, 3.0);
    graph.solve(loads);
    std::vector<std::size_t> around;
    for (std::size_t i = 0; i < graph.bond_count(); ++i)
        if (graph.bond(i).a == 7 || graph.bond(i).b == 7) around.push_back(i);
    for (const std::size_t i : around) {
        EXPECT_EQ(graph.component(7), 0u);
        graph.cut(i);
    }
    EXPECT_EQ(graph.component(7), 7u);
    EXPECT_EQ(graph.component(8), 0u);
    const auto wrenches = graph.solve(loads);
    for (const std::size_t i : around) EXPECT_EQ(wrenches[i].force, Vec3::Zero());
    // The others as if the free cell had never been there.
    FractureDescription without = block.fracture;
    std::erase_if(without.bonds, [](const Bond& bond) { return bond.a == 7 || bond.b == 7; });
    BondGraph rest(without, block.cells);
    const auto expected = rest.solve(loads);
    for (std::size_t i = 0, k = 0; i < graph.bond_count(); ++i)
        if (graph.intact(i)) {
            EXPECT_NEAR((wrenches[i].force - expected[k++].force).norm(), 0.0, 1e-9);
        }
}

TEST(BondGraph, UtilizationFollowsTheCriterion) {
    FractureDescription fracture;
    fracture.strength = 10.0;
    fracture.shear_strength = 20.0;
    fracture.stiffness = 1e6;
    Bond bond;
    bond.b = 1;
    bond.area = 2.0;
    bond.moment1 = bond.moment2 = 1.0;
    bond.modulus1 = 0.5;
    bond.modulus2 = 0.25;
    bond.polar_modulus = 0.8;
    bond.length = 1.0;
    fracture.bonds = {bond};
    const std::vector<MassProperties> cells{{1.0, Vec3::Zero(), Mat3::Identity()},
                                            {1.0, Vec3::UnitX(), Mat3::Identity()}};
    const BondGraph graph(fracture, cells);
    EXPECT_EQ(graph.utilization(0, {Vec3(4.0, 0.0, 0.0), Vec3(0.0, -1.0, 0.5)}),
              (4.0 / 2 + 1.0 / 0.5 + 0.5 / 0.25) / 10);
    EXPECT_EQ(graph.utilization(0, {Vec3(0.0, 6.0, 8.0), Vec3(-4.0, 0.0, 0.0)}), (10.0 / 2 + 4.0 / 0.8) / 20);
    EXPECT_EQ(graph.utilization(0, {Vec3(-400.0, 0.0, 0.0), Vec3::Zero()}), 0.0);
    fracture.compressive_strength = 50.0;
    EXPECT_EQ(graph.utilization(0, {Vec3(-400.0, 0.0, 0.0), Vec3::Zero()}), 4.0);
}

}  // namespace
}  // namespace tumble::bond_graph_test
