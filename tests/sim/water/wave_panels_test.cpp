// The load of waves on long bodies against integrals of the pressure, and against the exact wet part on flat water.
#include "sim/water/wave_panels.h"
#include "core/deterministic_math.h"
#include "support/curved.h"
#include "support/scenes.h"

#include <gtest/gtest.h>

#include <cmath>

namespace tumble::wave_panels_test {
using namespace tumble::testing;

namespace {

constexpr double g = 9.81;

CollisionShape collider_of(const Shape& shape) {
    ColliderCache cache;
    return make_collider(shape, {false, mass_properties(shape, 1.0).center_of_mass, 1.0}, cache);
}

WaterSurface waves_of(double height, double length, const Vec3& direction = Vec3::UnitX()) {
    WaterDescription water;
    water.waves.push_back({height, length, direction, 0.0});
    return {water, g};
}

WavePanels panels_of(const CollisionShape& shape, double wave) {
    WaterDescription water;
    water.waves.push_back({1.0, wave});
    return {shape, water, world_bounds(shape, {}).extent().maxCoeff()};
}

const Vec3 no_current = Vec3::Zero();

WaveLoad load_at(const WavePanels& panels, const WaterSurface& surface, const Pose& pose, double time,
                 const FlowPast& motion = {}) {
    return panels.wet({surface, no_current, pose, time}).load(motion);
}

/// Forces of a wave along x on an upright box, over rho g: by the rule of Simpson on many parts.
struct BoxInWave {
    double length, breadth, draft, amplitude, number, phase;  // of the crest at the middle of the box
    double bottom_y;                                          // of the box over its center

    double wave(double x) const { return amplitude * std::cos(number * x - phase); }
    double heave = 0.0, surge = 0.0, pitch = 0.0;

    template <class F>
    static double integral(double from, double to, const F& f) {
        constexpr int parts = 4000;
        const double h = (to - from) / parts;
        double sum = f(from) + f(to);
        for (int n = 1; n < parts; ++n) sum += (n % 2 ? 4.0 : 2.0) * f(from + n * h);
        return sum * h / 3.0;
    }
    double pressure(double x, double depth) const {  // depth below the surface there
        return depth + wave(x) * (std::exp(-number * depth) - 1.0);
    }
    void solve() {
        const auto bottom = [&](double x) { return pressure(x, draft + wave(x)); };
        heave = breadth * integral(-0.5 * length, 0.5 * length, bottom);
        pitch = breadth * integral(-0.5 * length, 0.5 * length, [&](double x) { return x * bottom(x); });
        for (const double side : {-1.0, 1.0}) {
            const double x = 0.5 * side * length, deep = draft + wave(x);
            surge -= side * breadth * integral(0.0, deep, [&](double d) { return pressure(x, d); });
            // About z: x times the vertical force less y times the horizontal one.
            pitch +=
                side * breadth * integral(0.0, deep, [&](double d) { return (bottom_y + deep - d) * pressure(x, d); });
        }
    }
};

TEST(WavePanels, ABoxOfHalfAWaveAWholeOneAndTwoHasTheIntegralOfThePressure) {
    const double wave = 4.0, height = 0.2, breadth = 0.8, tall = 0.6, draft = 0.3, number = 2.0 * pi / wave;
    const WaterSurface surface = waves_of(height, wave);
    double worst = 0.0;
    for (const double length : {0.5 * wave, wave, 2.0 * wave})
        for (const double middle : {0.0, 0.4, 1.0, 1.7, 2.9}) {
            const WavePanels panels = panels_of(collider_of(BoxShape{{length, tall, breadth}}), wave);
            Pose pose;
            pose.position = {middle, 0.5 * tall - draft, 0.3};
            const WaveLoad load = load_at(panels, surface, pose, 0.0);
            BoxInWave exact{length, breadth, draft, 0.5 * height, number, -number * middle, -0.5 * tall};
            exact.solve();
            const double scale = 0.5 * height * breadth * length * std::exp(-number * draft);
            worst = std::max({worst, std::abs(load.force.y() - exact.heave) / scale,
                              std::abs(load.force.x() - exact.surge) / scale,
                              std::abs(load.torque.z() - exact.pitch) / (0.5 * length * scale)});
            EXPECT_NEAR(load.force.y(), exact.heave, 0.01 * scale) << length << ' ' << middle;
            EXPECT_NEAR(load.force.x(), exact.surge, 0.01 * scale) << length << ' ' << middle;
            EXPECT_NEAR(load.torque.z(), exact.pitch, 0.01 * 0.5 * length * scale) << length << ' ' << middle;
            EXPECT_NEAR(load.force.z(), 0.0, 0.01 * scale);
        }
    RecordProperty("worst", std::to_string(worst));
}

TEST(WavePanels, LowWavesPushByTheirClosedForm) {
    const double wave = 4.0, amplitude = 1e-6, breadth = 0.8, draft = 0.3, number = 2.0 * pi / wave;
    const WaterSurface surface = waves_of(2.0 * amplitude, wave);
    for (const double length : {0.5 * wave, wave, 2.0 * wave}) {
        const WavePanels panels = panels_of(collider_of(BoxShape{{length, 0.6, breadth}}), wave);
        Pose pose;
        // The middle on a crest, and between it and the trough.
        for (const double middle : {0.0, 1.0}) {
            pose.position = {middle, 0.0, 0.0};
            const double heave = load_at(panels, surface, pose, 0.0).force.y() - breadth * draft * length,
                         expected = amplitude * std::exp(-number * draft) * breadth * 2.0 / number *
                                    std::sin(0.5 * number * length) * std::cos(number * middle);
            EXPECT_NEAR(heave, expected, 0.005 * amplitude * breadth * length) << length << ' ' << middle;
        }
    }
}

TEST(WavePanels, ATurnedBodyTakesTheForceOfTheTurnedWave) {
    const CollisionShape box = collider_of(BoxShape{{3.0, 0.4, 1.0}});
    const WavePanels panels = panels_of(box, 2.0);
    Pose level, turned;
    turned.rotation = turn({0.0, 1.0, 0.0}, 0.7).toRotationMatrix();
    const WaveLoad first = load_at(panels, waves_of(0.1, 2.0), level, 0.4),
                   second = load_at(panels, waves_of(0.1, 2.0, turned.rotation * Vec3::UnitX()), turned, 0.4);
    EXPECT_LT((first.force - second.force).norm(), 1e-12);
    EXPECT_LT((first.torque - second.torque).norm(), 1e-12);
}

TEST(WavePanels, OnACrestNothingTurnsASymmetricBody) {
    for (const Shape& shape : {Shape(BoxShape{{3.0, 0.4, 1.0}}), Shape(SphereShape{0.6}), Shape(capsule(0.3, 1.0))}) {
        const WavePanels panels = panels_of(collider_of(shape), 2.0);
        for (const double crest : {0.0, 1.0}) {  // and in a trough
            Pose pose;
            pose.position.x() = crest;
            const WaveLoad load = load_at(panels, waves_of(0.1, 2.0), pose, 0.0);
            const double scale = 0.05 * 3.0;  // m^3, of the wave over the raft
            EXPECT_LT(load.torque.norm(), 2e-3 * scale);
            EXPECT_LT(std::abs(load.force.x()) + std::abs(load.force.z()), 2e-3 * scale);
        }
    }
}

TEST(WavePanels, OnFlatWaterAreTheExactWetParts) {
    const WaterSurface flat = waves_of(1e-12, 2.0);
    for (const auto& [shape, tolerance] : {std::pair<Shape, double>(BoxShape{{3.0, 0.4, 1.0}}, 1e-11),
                                           {SphereShape{0.6}, 6e-3},
                                           {capsule(0.3, 1.0), 6e-3},
                                           {cylinder(0.4, 1.0), 6e-3},
                                           {cone(0.5, 1.0, 0.1), 6e-3},
                                           {ellipsoid({0.5, 0.8, 0.4}), 6e-3}}) {
        const CollisionShape collider = collider_of(shape);
        const WavePanels panels = panels_of(collider, 2.0);
        const double whole = wet_part(collider, {Vec3::UnitY(), 10.0}).volume;
        for (const double height : {-2.0, -0.2, 0.0, 0.1, 0.25})
            for (const double angle : {0.0, 0.5, 1.4}) {
                Pose pose;
                pose.rotation = turn({1.0, 0.3, 0.5}, angle).toRotationMatrix();
                pose.position.y() = height;
                const WaveLoad load = load_at(panels, flat, pose, 0.0);
                const WaterPlane plane = seen_from(pose, {Vec3::UnitY(), 0.0});
                const WetPart exact = wet_part(collider, plane);
                EXPECT_NEAR(load.wet.volume, exact.volume, tolerance * whole) << height << ' ' << angle;
                EXPECT_LT((load.wet.moment - exact.moment).norm(), tolerance * whole) << height << ' ' << angle;
                EXPECT_LT((load.force - load.wet.volume * plane.normal).norm(), 1e-11) << height << ' ' << angle;
                EXPECT_LT((load.torque - exact.moment.cross(plane.normal)).norm(), tolerance * whole)
                    << height << ' ' << angle;
            }
    }
}

TEST(WavePanels, ForcesAreContinuousWhileABodyEnters) {
    const WaterSurface surface = waves_of(0.2, 1.5, Vec3(0.8, 0.0, 0.6));
    const WavePanels panels = panels_of(collider_of(BoxShape{{1.5, 0.3, 0.9}}), 1.5);
    Pose pose;
    pose.rotation = turn({0.3, 0.2, 1.0}, 0.2).toRotationMatrix();
    WaveLoad last;
    const double step = 1e-4, area = 1.7;
    for (double y = 0.6; y > -0.6; y -= step) {
        pose.position.y() = y;
        const WaveLoad load = load_at(panels, surface, pose, 0.2);
        // A wave of this steepness adds its slope to the side forces.
        ASSERT_LT((load.force - last.force).norm(), 2.0 * area * step) << y;
        ASSERT_LT((load.torque - last.torque).norm(), 2.0 * area * step) << y;
        last = load;
    }
    EXPECT_NEAR(last.wet.volume, 1.5 * 0.3 * 0.9, 1e-3);
}

TEST(WavePanels, AClosedMeshIsTheSolidThatItEncloses) {
    const CollisionShape shape = collider_of(BoxShape{{3.0, 0.4, 1.0}});
    const Polyhedron& box = *std::get<std::shared_ptr<const Polyhedron>>(shape);
    TriangleMesh mesh{box.vertices, {}};
    for (const Polyhedron::Face& face : box.faces)
        for (std::size_t k = 2; k < face.vertices.size(); ++k)
            mesh.triangles.push_back({face.vertices[0], face.vertices[k - 1], face.vertices[k]});
    WaterDescription water;
    water.waves.push_back({0.1, 2.0});
    Pose pose;
    pose.rotation = turn({1.0, 0.3, 0.5}, 0.2).toRotationMatrix();
    const WaveLoad solid = load_at(WavePanels(mesh, water, 3.0), waves_of(0.1, 2.0), pose, 0.3),
                   hull = load_at(panels_of(shape, 2.0), waves_of(0.1, 2.0), pose, 0.3);
    EXPECT_GT(hull.wet.volume, 0.3);
    EXPECT_EQ(solid.wet.volume, hull.wet.volume);
    EXPECT_EQ(solid.force, hull.force);
    EXPECT_EQ(solid.torque, hull.torque);
}

TEST(WavePanels, WavesFarShorterThanABodyDoNotPushIt) {
    const CollisionShape raft = collider_of(BoxShape{{20.0, 0.4, 3.0}});
    const WavePanels panels = panels_of(raft, 1.2);
    Pose pose;
    const WaveLoad flat = load_at(panels, waves_of(1e-12, 1.2), pose, 0.0),
                   load = load_at(panels, waves_of(0.1, 1.2), pose, 0.0),
                   felt = load_at(panels_of(raft, 1.3), waves_of(0.1, 1.3), pose, 0.0);
    EXPECT_LT((load.force - flat.force).norm(), 1e-9);
    EXPECT_GT((felt.force - flat.force).norm(), 1e-3);
}

TEST(WavePanels, ACurrentBrakesAsOnASurfaceOfDrag) {
    const WaterSurface flat = waves_of(1e-12, 2.0);
    for (const Shape& shape : {Shape(BoxShape{{3.0, 0.4, 1.0}}), Shape(SphereShape{0.6}), Shape(cylinder(0.4, 1.0))}) {
        const CollisionShape collider = collider_of(shape);
        const WavePanels panels = panels_of(collider, 2.0);
        const DragSurface surface(collider);
        const FlowPast motion{{0.7, -0.4, 0.2}, {0.1, 0.3, -0.2}};
        for (const double height : {0.0, -3.0}) {  // and wholly under
            Pose pose;
            pose.rotation = turn({1.0, 0.3, 0.5}, 0.3).toRotationMatrix();
            pose.position.y() = height;
            const WaveLoad load = load_at(panels, flat, pose, 0.0, motion);
            const DragIntegral exact = surface.drag(seen_from(pose, {Vec3::UnitY(), 0.0}), motion);
            const double force = exact.force.norm();
            EXPECT_LT((load.drag.force - exact.force).norm(), 0.04 * force) << height;
            // The cut by the surface brakes as if at one place.
            EXPECT_LT((load.drag.torque - exact.torque).norm(), (height < 0.0 ? 0.04 : 0.15) * force) << height;
            EXPECT_NEAR(load.drag.plane, exact.plane, 0.02 * exact.plane + 1e-12) << height;
            EXPECT_LT((load.drag.heave - exact.heave).norm(), 0.02 * exact.heave.norm() + 1e-12) << height;
            EXPECT_GT(load.grip * motion.velocity.norm(), force) << height;
        }
    }
}

}  // namespace
}  // namespace tumble::wave_panels_test
