// Voronoi cells against those of voro++ (Rycroft 2009), where it is installed.
#include "scene/fracture/bonds.h"
#include "scene/fracture/convex_parts.h"
#include "scene/fracture/cut_pattern.h"
#include "sim/geometry/shapes/mesh.h"

#include <gtest/gtest.h>

#ifdef TUMBLE_VOROXX
#include <voro++/voro++.hh>
#endif

#include <algorithm>
#include <vector>

namespace tumble::voronoi_oracle_test {
namespace {

TEST(VoronoiOracle, HasTheSameVolumesAndFaces) {
#ifdef TUMBLE_VOROXX
    BodyDescription body;
    body.shape = BoxShape{Vec3(1.0, 2.0, 0.5)};
    const ConvexCell part = convex_parts(body).front().cell;
    Random random(7, 0, Random::Purpose::cut);
    for (const std::size_t count : {2u, 20u, 200u}) {
        std::vector<Vec3> sites = draw_sites(part, count, std::nullopt, random);
        std::sort(sites.begin(), sites.end(), [](const Vec3& a, const Vec3& b) { return a.x() < b.x(); });
        std::vector<ConvexCell> cells;
        cut_by_sites(part, sites, {1e-13, 0.0, 0.0}, cells);
        ASSERT_EQ(cells.size(), count);
        std::vector<Vec3> centers;
        for (const ConvexCell& cell : cells) centers.push_back(mesh_mass(cell.mesh(), 1.0).center_of_mass);
        const std::vector<Bond> bonds = find_bonds({cells, centers, 1e-9, 1e-6});

        voro::container box(-0.5, 0.5, -1.0, 1.0, -0.25, 0.25, 4, 8, 2, false, false, false, 8);
        for (std::size_t i = 0; i < count; ++i) box.put(int(i), sites[i].x(), sites[i].y(), sites[i].z());
        voro::c_loop_all loop(box);
        ASSERT_TRUE(loop.start());
        std::size_t faces = 0;
        do {
            voro::voronoicell_neighbor cell;
            ASSERT_TRUE(box.compute_cell(cell, loop));
            const auto i = std::size_t(loop.pid());
            EXPECT_NEAR(cells[i].volume(), cell.volume(), 1e-13) << i;
            std::vector<int> neighbors;
            std::vector<double> areas;
            cell.neighbors(neighbors);
            cell.face_areas(areas);
            for (std::size_t k = 0; k < neighbors.size(); ++k) {
                if (neighbors[k] < int(i) || areas[k] < 1e-6) continue;  // a wall, the other side, or a sliver
                ++faces;
                const auto bond = std::find_if(bonds.begin(), bonds.end(), [&](const Bond& one) {
                    return one.a == i && one.b == std::uint32_t(neighbors[k]);
                });
                ASSERT_NE(bond, bonds.end()) << i << " " << neighbors[k];
                EXPECT_NEAR(bond->area, areas[k], 1e-12) << i << " " << neighbors[k];
            }
        } while (loop.inc());
        EXPECT_EQ(faces, bonds.size());
    }
#else
    GTEST_SKIP() << "needs voro++: scripts/install-dependencies --test";
#endif
}

}  // namespace
}  // namespace tumble::voronoi_oracle_test
