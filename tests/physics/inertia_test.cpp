// Masses, centers of mass and inertia tensors against their formulas.
#include "sim/geometry/shapes/shape.h"
#include "support/meshes.h"
#include "support/scenes.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace tumble::inertia_test {
using namespace tumble::testing;

TEST(Inertia, BoxAndSphere) {
    const MassProperties box = mass_properties(BoxShape{Vec3(1.0, 2.0, 3.0)}, 500.0);
    EXPECT_DOUBLE_EQ(box.mass, 3000.0);
    EXPECT_DOUBLE_EQ(box.inertia(0, 0), 3000.0 * 13.0 / 12.0);
    EXPECT_DOUBLE_EQ(box.inertia(1, 1), 3000.0 * 10.0 / 12.0);
    EXPECT_DOUBLE_EQ(box.inertia(2, 2), 3000.0 * 5.0 / 12.0);
    const MassProperties sphere = mass_properties(SphereShape{0.5}, 1000.0);
    EXPECT_NEAR(sphere.mass, 523.5987755982989, 1e-9);
    EXPECT_NEAR(sphere.inertia(2, 2), 0.4 * sphere.mass * 0.25, 1e-12);
}

// The mesh integrals of a box equal the box formulas, for any origin.
TEST(Inertia, MeshOfABoxFarFromItsOrigin) {
    const Vec3 low(100.0, -50.0, 7.0), size(1.0, 2.0, 3.0);
    const MassProperties mesh = mesh_mass(box_mesh(low, low + size), 500.0),
                         box = mass_properties(BoxShape{size}, 500.0);
    EXPECT_NEAR(mesh.mass, box.mass, 1e-9);
    EXPECT_LT((mesh.center_of_mass - low - 0.5 * size).norm(), 1e-12);
    EXPECT_LT((mesh.inertia - box.inertia).norm(), 1e-8);
}

// Tetrahedron (0, a e_x, b e_y, c e_z): V = abc/6, center (a, b, c)/4, I_xx = m 3/80 (b^2 + c^2), I_xy = m ab/80.
TEST(Inertia, RightTetrahedron) {
    const double a = 1.0, b = 2.0, c = 3.0;
    const MassProperties t = mesh_mass(tetrahedron(Vec3::Zero(), {a, 0, 0}, {0, b, 0}, {0, 0, c}), 2.0);
    EXPECT_NEAR(t.mass, 2.0, 1e-14);
    EXPECT_LT((t.center_of_mass - Vec3(a, b, c) / 4.0).norm(), 1e-14);
    EXPECT_NEAR(t.inertia(0, 0), t.mass * 3.0 / 80.0 * (b * b + c * c), 1e-13);
    EXPECT_NEAR(t.inertia(1, 1), t.mass * 3.0 / 80.0 * (a * a + c * c), 1e-13);
    EXPECT_NEAR(t.inertia(0, 1), t.mass * a * b / 80.0, 1e-13);
}

// A mesh with an offset origin rotates about its center of mass.
TEST(Inertia, BodyWithOffsetOriginRotatesAboutItsCenterOfMass) {
    SceneDescription scene = empty_scene(16);
    BodyDescription& body =
        add_body(scene, MeshShape{asset_of(box_mesh({1.0, 0.0, 0.0}, {3.0, 1.0, 1.0}))}, {5.0, 0.0, 0.0});
    body.angular_velocity = Vec3(0.0, 0.0, 1.0);
    World world(scene);
    EXPECT_LT((world.snapshot().bodies[0].center_of_mass - Vec3(7.0, 0.5, 0.5)).norm(), 1e-14);
    EXPECT_EQ(world.report(0).center_of_mass, Vec3(2.0, 0.5, 0.5));
    run(world, scene, 1.0);
    const BodyState b = world.snapshot().bodies[0];
    EXPECT_LT((b.center_of_mass - Vec3(7.0, 0.5, 0.5)).norm(), 1e-12);
    EXPECT_LT((b.origin - (b.center_of_mass - b.orientation * Vec3(2.0, 0.5, 0.5))).norm(), 1e-12);
}

TEST(Inertia, GivenMassScalesTheTensor) {
    SceneDescription scene = empty_scene();
    add_body(scene, MeshShape{icosahedron(1.0)}, Vec3::Zero()).mass = 7.0;
    World world(scene);
    const BodyReport r = world.report(0);
    EXPECT_DOUBLE_EQ(r.mass, 7.0);
    EXPECT_NEAR(r.principal_inertia.x(), r.principal_inertia.z(), 1e-12);  // by symmetry
    EXPECT_EQ(r.hull_vertices, 12u);
}

namespace {

Mat3 tensor_of(const PrincipalInertia& p) {
    const Mat3 r = p.axes.toRotationMatrix();
    return r * p.moments.asDiagonal() * r.transpose();
}

}  // namespace

TEST(PrincipalInertia, RebuildsTheTensor) {
    for (int i = 1; i <= 2000; ++i) {
        // Random axes, moments of matter from spheres to needles.
        const Quat axes = turn({std::sin(1.0 * i), std::cos(2.3 * i), std::sin(0.7 * i + 1.0)}, 0.37 * i);
        const double thin = std::pow(10.0, -(i % 7));
        const Vec3 size(1.0, i % 3 == 0 ? 1.0 : 0.3 + thin, thin);
        Vec3 moments(size.y() * size.y() + size.z() * size.z(), size.z() * size.z() + size.x() * size.x(),
                     size.x() * size.x() + size.y() * size.y());
        const Mat3 r = axes.toRotationMatrix();
        Mat3 tensor = r * moments.asDiagonal() * r.transpose();
        tensor = 0.5 * (tensor + tensor.transpose()).eval();
        PrincipalInertia p = principal_inertia(tensor);
        EXPECT_LT((tensor_of(p) - tensor).cwiseAbs().maxCoeff(), 1.5e-14 * moments.maxCoeff()) << i;
        EXPECT_NEAR(p.axes.norm(), 1.0, 1e-15);
        std::sort(moments.begin(), moments.end());
        std::sort(p.moments.begin(), p.moments.end());
        EXPECT_LT((p.moments - moments).cwiseAbs().maxCoeff(), 2e-15 * moments.maxCoeff()) << i;
    }
}

TEST(PrincipalInertia, DiagonalTensorsKeepTheirAxes) {
    for (const Vec3& moments :
         {Vec3(1, 2, 3), Vec3(3, 2, 1.5), Vec3(1, 1, 1e-9), Vec3(2, 2, 2), Vec3(1, 1 + 1e-13, 1.5)}) {
        const PrincipalInertia p = principal_inertia(moments.asDiagonal());
        EXPECT_EQ(p.axes.coeffs(), Quat::Identity().coeffs());
        EXPECT_EQ(p.moments, moments);
    }
}

TEST(PrincipalInertia, EqualForSymmetricShapes) {
    const Vec3 ball = principal_inertia(mass_properties(SphereShape{0.37}, 911.0).inertia).moments;
    EXPECT_TRUE(ball.x() == ball.y() && ball.y() == ball.z());
    const Vec3 cube = principal_inertia(mass_properties(BoxShape{Vec3(0.3, 0.3, 0.3)}, 700.0).inertia).moments;
    EXPECT_TRUE(cube.x() == cube.y() && cube.y() == cube.z());
    const Vec3 rod = principal_inertia(mass_properties(BoxShape{Vec3(0.3, 0.7, 0.3)}, 700.0).inertia).moments;
    EXPECT_TRUE(rod.x() == rod.z() && rod.x() > rod.y());
    // Meshes, whose integrals are rounded: a cube far from its origin, an icosahedron.
    const Vec3 low(3.1, -7.3, 0.9);
    const PrincipalInertia far = principal_inertia(mesh_mass(box_mesh(low, low + Vec3(0.5, 0.5, 0.5)), 700.0).inertia);
    EXPECT_TRUE(far.moments.x() == far.moments.y() && far.moments.y() == far.moments.z());
    EXPECT_EQ(far.axes.coeffs(), Quat::Identity().coeffs());
    const Vec3 icosahedral = principal_inertia(mesh_mass(icosahedron(0.7)->mesh, 700.0).inertia).moments;
    EXPECT_TRUE(icosahedral.x() == icosahedral.y() && icosahedral.y() == icosahedral.z());
}

}  // namespace tumble::inertia_test
