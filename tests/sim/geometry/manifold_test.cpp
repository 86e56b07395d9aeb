// The choice of four points of many: those that carry the load.
#include "sim/contact/model/predicted_gap.h"
#include "sim/random_shapes.h"

#include <gtest/gtest.h>

namespace tumble::manifold_test {
using namespace tumble::testing;

namespace {
Mat3 turn_about_y(double angle) { return Eigen::AngleAxisd(angle, Vec3::UnitY()).toRotationMatrix(); }
}  // namespace

// A plate of any proportions on a half-space and on a box, with so large a margin that its upper corners are candidates
// too: its four lower corners, at any rotation about the normal.
TEST(Manifold, APlateStandsOnItsFourCorners) {
    Random random(9);
    for (const double width : {1.0, 0.3, 0.1, 0.03, 0.01})
        for (const double thick : {0.1, 0.01, 0.001})
            for (int trial = 0; trial < 20; ++trial) {
                const Vec3 size(1.0, thick, width);
                const Pose pose{{0.0, 0.5 * thick, 0.0}, turn_about_y(random(-3.0, 3.0))};
                const CollisionShape floors[] = {HalfSpace{Vec3::UnitY(), 0.0}, box_of({3.0, 1.0, 3.0})};
                for (const bool box : {false, true}) {
                    const Pose floor{box ? Vec3(0.0, -0.5, 0.0) : Vec3(Vec3::Zero()), Mat3::Identity()};
                    const auto manifolds = collide_all(floors[box], floor, box_of(size), pose, 3.0 * thick);
                    ASSERT_EQ(manifolds.size(), 1u);
                    ASSERT_EQ(manifolds[0].count, 4) << width << " " << thick << " " << box;
                    for (int corner = 0; corner < 4; ++corner) {
                        const Vec3 at =
                            pose.to_world(0.5 * Vec3(corner & 1 ? 1.0 : -1.0, -thick, corner & 2 ? width : -width));
                        double nearest = 1e9;
                        for (int i = 0; i < 4; ++i) {
                            nearest = std::min(nearest, (manifolds[0].points[std::size_t(i)].position - at).norm());
                            EXPECT_NEAR(manifolds[0].points[std::size_t(i)].separation, 0.0, 1e-12);
                        }
                        EXPECT_LE(nearest, 1e-9) << width << " " << thick << " " << box << " " << corner;
                    }
                }
            }
}

// Four of many points on a circle are kept: they support its middle well.
TEST(Manifold, ADiscStandsAroundItsMiddle) {
    for (int corners = 5; corners <= 40; ++corners) {
        std::vector<ContactPoint> points;
        for (int i = 0; i < corners; ++i) {
            const double angle = 6.283185307179586 * i / corners;
            ContactPoint p;
            p.position = Vec3(std::cos(angle), 0.0, std::sin(angle));
            points.push_back(p);
        }
        Manifold m;
        m.normal = Vec3::UnitY();
        std::vector<ContactPoint> reduced;
        keep_best_points(points, m, reduced);
        ASSERT_EQ(m.count, 4);
        for (int k = 0; k < 64;
             ++k) {  // in every direction a point extends farther than cos 72 degrees: a corner of a pentagon
            const Vec3 way(std::cos(0.1 * k), 0.0, std::sin(0.1 * k));
            double most = 0.0;
            for (int i = 0; i < 4; ++i) most = std::max(most, way.dot(m.points[std::size_t(i)].position));
            EXPECT_GE(most, 0.3) << corners << " " << k;
        }
    }
}

// Load-carrying corners are preferred to those above: a reduced one would sink until it is restored.
TEST(Manifold, LoadedPointsAreKept) {
    Random random(10);
    for (int trial = 0; trial < 2000; ++trial) {
        const int corners = 5 + random.below(4), bearing = 1 + random.below(4);
        std::vector<ContactPoint> points;
        for (int i = 0; i < corners; ++i) {
            ContactPoint p;
            const double angle = 6.283185307179586 * (i + random(-0.2, 0.2)) / corners;
            p.position = Vec3(std::cos(angle), 0.0, std::sin(angle));
            p.feature = std::uint64_t(i);
            p.separation = i < bearing ? random(-2e-3, -1e-4) : random(5e-3, 3e-2);
            points.push_back(p);
        }
        for (std::size_t i = points.size(); i > 1; --i)
            std::swap(points[i - 1], points[std::size_t(random.below(int(i)))]);
        Manifold m;
        m.normal = Vec3::UnitY();
        std::vector<ContactPoint> reduced;
        keep_best_points(points, m, reduced);
        ASSERT_EQ(m.count, 4);
        ASSERT_EQ(int(reduced.size()), corners - 4);
        for (const ContactPoint& p : reduced) EXPECT_FALSE(m.has(p.feature)) << trial;
        int kept = 0;
        for (int i = 0; i < 4; ++i) kept += m.points[std::size_t(i)].separation < 0.0;
        EXPECT_EQ(kept, bearing) << trial;
    }
}

// A point on a ball closes its gap along a curve; stored values of removed points must not make a curve of a box's last
// one.
TEST(Manifold, RemovedPointsAreNoCurve) {
    Body a, b;
    a.radius = b.radius = 0.5;
    b.position = Vec3::UnitY();
    const BodyVelocity still, passes{{3.0, -0.7, 0.0}, Vec3::Zero()};
    constexpr double gap = 0.01, h = 1.0 / 60.0;
    Manifold m;
    m.count = 1;
    m.normal = Vec3::UnitY();
    m.points[0] = {{0.0, 0.5, 0.0}, gap, 1};
    m.points[1] = {Vec3::Zero(), 1.0, 2};
    m.points[3].position = b.position;
    EXPECT_EQ(predicted_gap(m, 0, {a, b, still, passes}, h).gap, gap);
    m.set_geometry(CurvedGap{1.0, Vec3::Zero(), a.position, b.position});
    EXPECT_GT(predicted_gap(m, 0, {a, b, still, passes}, h).gap, gap);
}

}  // namespace tumble::manifold_test
