// Sidedness of open meshes: hills, folds, borders, and one-sided strips.
#include "sim/geometry/mesh_sidedness.h"
#include "core/deterministic_math.h"
#include "sim/random_shapes.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <numeric>

namespace tumble::mesh_sidedness_test {
using namespace tumble::testing;

namespace {

// For each triangle whether the point is behind it: queried for those within `reach`, by bounds.
std::vector<std::pair<std::uint32_t, bool>> sides(const CollisionMesh& s, const Vec3& point, double reach) {
    std::vector<std::uint32_t> near;
    s.tree.query(Bounds{point, point}.grown(reach), [&](std::uint32_t t) { near.push_back(t); });
    std::sort(near.begin(), near.end());
    SideScratch scratch;
    find_sides(s, near, point, scratch);
    std::vector<std::pair<std::uint32_t, bool>> found;
    for (std::size_t k = 0; k < near.size(); ++k) found.emplace_back(near[k], scratch.behind[k] != 0);
    return found;
}

bool behind_plane(const CollisionMesh& s, std::uint32_t t, const Vec3& point) {
    return s.triangles[t].normal.dot(point - s.corner(t, 0)) < 0.0;
}

// A strip around the y axis, 0.4 m wide, that twists by `half_turns` half turns along its length.
TriangleMesh strip(int half_turns) {
    constexpr std::uint32_t n = 48;
    TriangleMesh mesh;
    for (std::uint32_t i = 0; i < n; ++i)
        for (const double w : {-0.2, 0.2}) {
            const double angle = 2.0 * pi * i / n, tilt = 0.5 * half_turns * angle;
            const double r = 1.0 + w * std::cos(tilt);
            mesh.vertices.emplace_back(r * std::cos(angle), w * std::sin(tilt), r * std::sin(angle));
        }
    for (std::uint32_t i = 0; i < n; ++i) {
        const bool swapped = i + 1 == n && half_turns % 2 == 1;
        const std::uint32_t a = 2 * i, b = a + 1, next = 2 * ((i + 1) % n), c = next + swapped, d = next + !swapped;
        mesh.triangles.push_back({a, b, c});
        mesh.triangles.push_back({b, d, c});
    }
    return mesh;
}

}  // namespace

TEST(MeshSidedness, AboveAndBelowHillsAndHollows) {
    Random random(71);
    const auto ground = surface_of(wavy_mesh(24, 6.0));
    int disagreed = 0;
    for (int trial = 0; trial < 2000; ++trial) {
        // Over a triangle's middle, nearer to it than to any border.
        const auto t = std::uint32_t(random.below(int(ground->triangles.size())));
        const Vec3 middle = (ground->corner(t, 0) + ground->corner(t, 1) + ground->corner(t, 2)) / 3.0;
        if (middle.cwiseAbs().maxCoeff() > 5.0) continue;
        const bool above = trial % 2 == 0;
        const Vec3 point = middle + (above ? 0.02 : -0.02) * Vec3::UnitY();
        const bool up = ground->triangles[0].normal.y() > 0.0;
        for (const auto& [other, behind] : sides(*ground, point, 0.8)) {
            EXPECT_EQ(behind, above != up) << trial;
            disagreed += behind_plane(*ground, other, point) != behind;
        }
    }
    EXPECT_GT(disagreed, 1000);
}

// A sheet folded like an S: a point between two of its layers is in front of one and behind the other.
TEST(MeshSidedness, BetweenTheLayersOfAFold) {
    TriangleMesh mesh = grid_mesh(40, 2.0, 0.0);
    for (Vec3& v : mesh.vertices) {
        const double s = v.x();  // along the sheet: three layers 0.2 m apart, joined by half circles
        const double length = 1.0, bend = 0.1 * pi;
        const double u = s + 1.5 * length + bend;
        if (u < length)
            v = {u, 0.0, v.z()};
        else if (u < length + bend)
            v = {length + 0.1 * std::sin((u - length) / 0.1), 0.1 - 0.1 * std::cos((u - length) / 0.1), v.z()};
        else if (u < 2.0 * length + bend)
            v = {2.0 * length + bend - u, 0.2, v.z()};
        else if (u < 2.0 * length + 2.0 * bend)
            v = {-0.1 * std::sin((u - 2.0 * length - bend) / 0.1),
                 0.3 - 0.1 * std::cos((u - 2.0 * length - bend) / 0.1), v.z()};
        else
            v = {u - 2.0 * length - 2.0 * bend, 0.4, v.z()};
    }
    const auto fold = surface_of(mesh);
    for (const double y : {0.09, 0.31}) {
        const Vec3 point(0.5, y, 0.03);
        int layers = 0;
        for (const auto& [t, behind] : sides(*fold, point, 0.15)) {
            EXPECT_EQ(behind, behind_plane(*fold, t, point)) << y;
            layers |= behind ? 1 : 2;
        }
        EXPECT_GT(layers, 0);
    }
}

// For any winding of the input, a component is wound consistently; a strip with a half turn cannot be, and each of its
// triangles' planes decides the side of a point.
TEST(MeshSidedness, ComponentsAreWoundConsistently) {
    Random random(72);
    for (const int half_turns : {0, 1, 2}) {
        TriangleMesh mesh = strip(half_turns);
        for (auto& t : mesh.triangles)
            if (random.below(2) == 0) std::swap(t[0], t[1]);
        const auto s = surface_of(mesh);
        for (const auto& t : s->triangles) EXPECT_EQ(t.sheet == CollisionMesh::none, half_turns == 1);
        if (half_turns != 1) {
            for (std::size_t t = 1; t < s->triangles.size(); ++t)
                EXPECT_GT(s->triangles[t].normal.dot(s->triangles[t - 1].normal), 0.5) << half_turns;
            continue;
        }
        for (int trial = 0; trial < 200; ++trial) {
            const Vec3 point = random.vector(1.2);
            for (const auto& [t, behind] : sides(*s, point, 0.3)) EXPECT_EQ(behind, behind_plane(*s, t, point));
        }
    }
}

// A rod leans out of a bowl, its middle beyond the border: at its foot it is inside all the same.
TEST(MeshSidedness, BeyondTheBorderEachPlaneDecides) {
    TriangleMesh bowl = grid_mesh(16, 1.0, 0.0);
    for (Vec3& v : bowl.vertices) v.y() = 0.8 * v.squaredNorm();
    const auto s = surface_of(bowl);
    const Vec3 point(1.3, 1.2, 0.0);
    for (const auto& [t, behind] : sides(*s, point, 3.0)) EXPECT_EQ(behind, behind_plane(*s, t, point));
}

}  // namespace tumble::mesh_sidedness_test
