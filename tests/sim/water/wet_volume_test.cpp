// Wet volumes and their centers against closed forms, invariants, and each other.
#include "sim/water/wet_volume.h"
#include "core/deterministic_math.h"
#include "support/curved.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace tumble::wet_volume_test {
using namespace tumble::testing;

namespace {

CollisionShape collider_of(const Shape& shape) {
    ColliderCache cache;
    return make_collider(shape, {false, mass_properties(shape, 1.0).center_of_mass, 1.0}, cache);
}

WaterPlane plane(const Vec3& normal, double offset) { return {normal.normalized(), offset}; }

class Random {
public:
    double number() { return 2.0 * double(engine_() >> 11) / double(1ull << 53) - 1.0; }
    Vec3 direction() {
        for (;;) {
            const Vec3 v(number(), number(), number());
            if (v.norm() > 0.1 && v.norm() < 1.0) return v.normalized();
        }
    }

private:
    std::mt19937_64 engine_{7};
};

TEST(WetVolume, ACubeOnItsCorner) {
    const CollisionShape cube = collider_of(BoxShape{{1.0, 1.0, 1.0}});
    const Vec3 up(1.0, 1.0, 1.0);
    const double corner = -0.5 * std::sqrt(3.0);
    const WetPart low = wet_part(cube, plane(up, corner + 0.4));
    EXPECT_NEAR(low.volume, 0.055425625842204073, 1e-16);
    EXPECT_NEAR(low.center().dot(up.normalized()) - corner, 0.3, 1e-15);
    const WetPart half = wet_part(cube, plane(up, 0.0));
    EXPECT_NEAR(half.volume, 0.5, 1e-15);
    EXPECT_NEAR(half.center().dot(up.normalized()) - corner, 0.63147685692615318, 1e-15);
}

TEST(WetVolume, ABallAndAConeAtTheirDrafts) {
    const CollisionShape ball = collider_of(SphereShape{0.5});
    const double full = pi / 6.0;
    for (const auto& [density, draft] : {std::pair(0.25, 0.3263518223330696511),
                                         {0.4, 0.4329310771477317638},
                                         {0.5, 0.5},
                                         {0.9, 0.8041998943409082825}})
        EXPECT_NEAR(wet_part(ball, plane({0.0, 1.0, 0.0}, draft - 0.5)).volume, density * full, 1e-15);
    const Shape tip_down = cone(0.0, 1.0, 0.4);  // the lower end is the tip
    const double middle = mass_properties(tip_down, 1.0).center_of_mass.y();
    const WetPart wet = wet_part(collider_of(tip_down), plane({0.0, 1.0, 0.0}, -0.5 - middle + 0.79370052598409974));
    EXPECT_NEAR(wet.volume, 0.5 * pi * 0.16 / 3.0, 1e-15);
    EXPECT_NEAR(wet.center().y(), -0.5 - middle + 0.75 * 0.79370052598409974, 1e-14);
}

TEST(WetVolume, ATiltedCylinderIsAWedge) {
    const double r = 0.3, h = 1.7;
    const CollisionShape shape = collider_of(cylinder(r, h));
    for (const double slope : {0.0, 1e-12, 1e-9, 1e-5, 0.1, 0.9, 2.0}) {
        // The plane u slope + y = middle crosses the side alone.
        const double middle = 0.1, length = std::sqrt(1.0 + slope * slope), depth = middle + 0.5 * h;
        const WetPart wet = wet_part(shape, {Vec3(0.6 * slope, 1.0, 0.8 * slope) / length, middle / length});
        EXPECT_NEAR(wet.volume, pi * r * r * depth, 2e-15) << slope;
        const Vec3 center = wet.center();
        EXPECT_NEAR(center.y() + 0.5 * h, 0.5 * depth + r * r * slope * slope / (8.0 * depth), 5e-15) << slope;
        EXPECT_NEAR(center.dot(Vec3(0.6, 0.0, 0.8)), -0.25 * r * r * slope / depth, 5e-15) << slope;
        EXPECT_NEAR(center.dot(Vec3(0.8, 0.0, -0.6)), 0.0, 1e-15) << slope;
    }
    // Half of a hoof: 2/3 r^2 h, where the plane passes through the center of the base.
    const double steep = 1.2, length = std::sqrt(1.0 + steep * steep);
    const WetPart hoof = wet_part(shape, {Vec3(steep, 1.0, 0.0) / length, -0.5 * h / length});
    EXPECT_NEAR(hoof.volume, 2.0 / 3.0 * r * r * r * steep, 1e-15);
}

TEST(WetVolume, AConeCutAcrossAtATilt) {
    // A plane that cuts the side alone leaves an oblique cone: a third of the ellipse's area times the distance.
    const double r = 0.5, h = 1.0, slope = r / h;
    const Shape shape = cone(r, h);
    const double middle = mass_properties(shape, 1.0).center_of_mass.y(), tip = 0.5 * h - middle;
    for (const double tilt : {0.0, 0.2, 0.5}) {
        const Vec3 down(std::sin(tilt), -std::cos(tilt), 0.0);
        const double depth = 0.5;  // of the plane from the tip
        const double over = std::cos(tilt) * std::cos(tilt) - slope * slope * std::sin(tilt) * std::sin(tilt);
        const double area = pi * depth * depth * slope * slope / (over * std::sqrt(over));
        const WetPart wet = wet_part(collider_of(shape), {down, down.y() * tip + depth});
        EXPECT_NEAR(wet.volume, area * depth / 3.0, 1e-14) << tilt;
    }
}

TEST(WetVolume, APlaneAndItsReverseMakeTheWhole) {
    Random random;
    const Shape shapes[] = {
        BoxShape{{1.0, 0.4, 0.7}}, SphereShape{0.6},  cylinder(0.4, 1.3), cone(0.5, 1.1),
        cone(0.5, 1.1, 0.3),       capsule(0.3, 0.9), capsule(0.3, 1e-6), ellipsoid({0.3, 0.5, 0.9})};
    for (const Shape& shape : shapes) {
        const CollisionShape solid = collider_of(shape);
        const double volume = mass_properties(shape, 1.0).mass, size = bounding_radius(solid);
        for (int n = 0; n < 300; ++n) {
            const Vec3 normal = random.direction();
            const double offset = 1.05 * size * random.number();
            const WetPart one = wet_part(solid, {normal, offset}), other = wet_part(solid, {-normal, -offset});
            EXPECT_NEAR(one.volume + other.volume, volume, 1e-13 * volume);
            EXPECT_LT((one.moment + other.moment).norm(), 1e-13 * volume * size);
            EXPECT_GE(one.volume, 0.0);
        }
    }
}

/// The same shape with flat faces, and a bound of the difference of volumes.
CollisionShape with_faces(const CurvedShape& shape) {
    const Vec3 middle = mass_properties(shape, 1.0).center_of_mass;
    return std::make_shared<const Polyhedron>(make_hull(shape.drawn->mesh.vertices, middle));
}

TEST(WetVolume, CurvedBodiesAreNearTheirFaces) {
    Random random;
    for (const CurvedShape& shape :
         {cylinder(0.4, 1.3), cone(0.5, 1.1), cone(0.5, 1.1, 0.3), capsule(0.3, 0.9), ellipsoid({0.3, 0.5, 0.9})}) {
        const CollisionShape solid = collider_of(shape), faces = with_faces(shape);
        const double volume = mass_properties(shape, 1.0).mass;
        for (int n = 0; n < 100; ++n) {
            const WaterPlane water{random.direction(), 0.5 * random.number()};
            const WetPart exact = wet_part(solid, water), flat = wet_part(faces, water);
            EXPECT_NEAR(exact.volume, flat.volume, 0.02 * volume);
            EXPECT_LT((exact.moment - flat.moment).norm(), 0.02 * volume);
        }
    }
}

// The rate of change of the moment by the offset is the plane's area times its center, which lies in the plane.
TEST(WetVolume, TheMomentChangesByTheWaterPlane) {
    Random random;
    const double step = 1e-4;
    for (const Shape& shape : {Shape(cylinder(0.4, 1.3)), Shape(cone(0.5, 1.1)), Shape(capsule(0.3, 0.9)),
                               Shape(ellipsoid({0.3, 0.5, 0.9})), Shape(BoxShape{{1.0, 0.4, 0.7}})}) {
        const CollisionShape solid = collider_of(shape);
        for (int n = 0; n < 50; ++n) {
            const Vec3 normal = random.direction();
            const double offset = 0.3 * random.number();
            const WetPart less = wet_part(solid, {normal, offset - step}),
                          more = wet_part(solid, {normal, offset + step});
            const double area = more.volume - less.volume;
            EXPECT_NEAR(normal.dot(more.moment - less.moment), offset * area, 1e-9);
        }
    }
}

TEST(WetVolume, AMeshWithAHollowIsNotItsHull) {
    // A cup: a box of side 1 with a square hole of side 0.5 and depth 0.8 from above.
    TriangleMesh cup;
    const auto box = [&](double half, double low, double high) {
        const auto first = std::uint32_t(cup.vertices.size());
        for (int k = 0; k < 8; ++k)
            cup.vertices.push_back({k & 1 ? half : -half, k & 2 ? high : low, k & 4 ? half : -half});
        return first;
    };
    const std::uint32_t a = box(0.5, 0.0, 1.0), b = box(0.25, 0.2, 1.0);
    const auto quad = [&](std::uint32_t p, std::uint32_t q, std::uint32_t r, std::uint32_t s) {
        cup.triangles.push_back({p, q, r});
        cup.triangles.push_back({p, r, s});
    };
    quad(a + 0, a + 1, a + 5, a + 4);  // bottom
    quad(b + 0, b + 4, b + 5, b + 1);  // bottom of the hole, seen from above
    const std::uint32_t around[] = {0, 1, 5, 4};
    for (int k = 0; k < 4; ++k) {
        const std::uint32_t p = around[k], q = around[(k + 1) % 4];
        quad(a + p, a + p + 2, a + q + 2, a + q);  // outer side
        quad(b + q, b + q + 2, b + p + 2, b + p);
        quad(a + p + 2, b + p + 2, b + q + 2, a + q + 2);  // rim
    }
    ASSERT_TRUE(closedness(cup).closed());
    ASSERT_NEAR(closedness(cup).signed_volume, 0.8, 1e-15);
    const WetPart wet = wet_part(cup, {Vec3::UnitY(), 0.6});
    EXPECT_NEAR(wet.volume, 0.6 - 0.25 * 0.4, 1e-15);
    EXPECT_NEAR(wet.moment.y(), 0.6 * 0.3 - 0.25 * 0.4 * 0.4, 1e-15);
}

}  // namespace
}  // namespace tumble::wet_volume_test
