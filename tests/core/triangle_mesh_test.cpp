#include "core/triangle_mesh.h"

#include <gtest/gtest.h>

namespace tumble::triangle_mesh_test {
namespace {

/// A box with these edges and one corner at `origin`, faces outward.
TriangleMesh box(const Vec3& size, const Vec3& origin) {
    TriangleMesh mesh;
    for (int i = 0; i < 8; ++i) {
        mesh.vertices.push_back(origin + Vec3(i & 1 ? size.x() : 0, i & 2 ? size.y() : 0, i & 4 ? size.z() : 0));
    }
    mesh.triangles = {{0, 2, 1}, {1, 2, 3}, {4, 5, 6}, {5, 7, 6}, {0, 1, 4}, {1, 5, 4},
                      {2, 6, 3}, {3, 6, 7}, {0, 4, 2}, {2, 4, 6}, {1, 3, 5}, {3, 7, 5}};
    return mesh;
}

TEST(TriangleMesh, ABoxIsClosedAndHasItsVolume) {
    const Closedness c = closedness(box({2, 3, 4}, {100, -200, 300}));
    EXPECT_TRUE(c.closed());
    EXPECT_NEAR(c.signed_volume, 24.0, 1e-12);
}

TEST(TriangleMesh, InsideOutItsVolumeIsNegative) {
    TriangleMesh mesh = box({1, 1, 1}, Vec3::Zero());
    for (auto& t : mesh.triangles) std::swap(t[1], t[2]);
    const Closedness c = closedness(mesh);
    EXPECT_TRUE(c.closed());
    EXPECT_NEAR(c.signed_volume, -1.0, 1e-15);
}

TEST(TriangleMesh, AMissingTriangleLeavesThreeOpenEdges) {
    TriangleMesh mesh = box({1, 1, 1}, Vec3::Zero());
    mesh.triangles.pop_back();
    const Closedness c = closedness(mesh);
    EXPECT_EQ(c.open_edges, 3u);
    EXPECT_EQ(c.crowded_edges, 0u);
    EXPECT_FALSE(c.closed());
}

TEST(TriangleMesh, ATurnedTriangleDisagreesAtThreeEdges) {
    TriangleMesh mesh = box({1, 1, 1}, Vec3::Zero());
    std::swap(mesh.triangles[5][0], mesh.triangles[5][1]);
    const Closedness c = closedness(mesh);
    EXPECT_EQ(c.open_edges, 0u);
    EXPECT_EQ(c.crowded_edges, 3u);
}

TEST(TriangleMesh, AFinAtAnEdgeIsCrowded) {
    TriangleMesh mesh = box({1, 1, 1}, Vec3::Zero());
    mesh.vertices.push_back({-1, -1, 0.5});
    mesh.triangles.push_back({0, 4, 8});
    const Closedness c = closedness(mesh);
    EXPECT_EQ(c.crowded_edges, 1u);
    EXPECT_EQ(c.open_edges, 2u);
}

TEST(TriangleMesh, BoundsHoldEveryVertex) {
    const Bounds b = box({2, 3, 4}, {1, 1, 1}).bounds();
    EXPECT_EQ(b.min, Vec3(1, 1, 1));
    EXPECT_EQ(b.max, Vec3(3, 4, 5));
    EXPECT_TRUE(TriangleMesh{}.bounds().empty());
    EXPECT_TRUE(closedness(TriangleMesh{}).closed());
}

}  // namespace
}  // namespace tumble::triangle_mesh_test
