// Manifolds from step to step: what contact has built up stays with the points that are still there.
#include "random_shapes.h"
#include "sim/narrow_phase.h"
#include "sim/tuning.h"

#include <gtest/gtest.h>

#include <algorithm>

using namespace tumble;
using namespace tumble::testing;

namespace {

constexpr double h = 1.0 / 60.0;

Body body_at(const Collider& collider, const Vec3& position, BodyType type = BodyType::dynamic) {
    Body body;
    body.type = type;
    body.collider = collider;
    body.radius = bounding_radius(collider);
    body.position = position;
    return body;
}

void turn(Body& body, const Quat& by) {
    body.orientation = by * body.orientation;
    body.rotation = body.orientation.toRotationMatrix();
}

struct Scene {
    explicit Scene(std::vector<Body> of) : bodies(std::move(of)) {}
    std::vector<Manifold>& find() { return narrow_phase.find(broad_phase.update(bodies, h), bodies, h, pool); }
    std::vector<Body> bodies;
    BroadPhase broad_phase;
    NarrowPhase narrow_phase{1};
    ThreadPool pool{1};
};

Scene box_on_box() {
    return Scene({body_at(box_of({2.0, 1.0, 2.0}), Vec3::Zero(), BodyType::fixed),
                  body_at(box_of({1.0, 1.0, 1.0}), {0.0, 0.999, 0.0})});
}

// Marks every point and the friction with numbers of their own.
void mark(Manifold& m) {
    for (int i = 0; i < m.count; ++i) m.points[std::size_t(i)].impulse = 1.0 + i;
    m.tangent = Vec3::UnitX();
    m.friction[0] = 10.0;
    m.friction[1] = 11.0;
    m.twist = 12.0;
}

}  // namespace

TEST(PersistentManifold, KeepsItsImpulses) {
    Scene scene = box_on_box();
    ASSERT_EQ(scene.find().size(), 1u);
    Manifold& first = scene.find()[0];
    ASSERT_EQ(first.count, 4);
    EXPECT_EQ(first.tangent, Vec3::Zero());
    mark(first);
    const Manifold before = first;
    for (int step = 0; step < 20; ++step) {
        if (step > 2) scene.bodies[1].position.x() += 0.004;   // looked at again in the same step, then slid along
        const Manifold& m = scene.find()[0];
        ASSERT_EQ(m.count, 4);
        for (int i = 0; i < 4; ++i) {
            const ContactPoint& p = m.points[std::size_t(i)];
            const auto same = std::find_if(before.points.begin(), before.points.end(),
                                           [&](const ContactPoint& q) { return q.feature == p.feature; });
            ASSERT_NE(same, before.points.end());
            EXPECT_EQ(p.impulse, same->impulse);
        }
        EXPECT_EQ(m.tangent, Vec3::UnitX());
        EXPECT_EQ(m.friction[0], 10.0);
        EXPECT_EQ(m.friction[1], 11.0);
        EXPECT_EQ(m.twist, 12.0);
    }
}

TEST(PersistentManifold, StartsAnewAfterParting) {
    Scene scene = box_on_box();
    mark(scene.find()[0]);
    scene.bodies[1].position.y() = 2.0;
    EXPECT_TRUE(scene.find().empty());
    scene.bodies[1].position.y() = 0.999;
    const Manifold& m = scene.find()[0];
    EXPECT_EQ(m.tangent, Vec3::Zero());
    EXPECT_EQ(m.friction[0], 0.0);
    EXPECT_EQ(m.twist, 0.0);
    for (int i = 0; i < m.count; ++i) EXPECT_EQ(m.points[std::size_t(i)].impulse, 0.0);
}

// Other features, the same place: a box turned upside down lies on the same four corners.
TEST(PersistentManifold, TakesTheNearestPointWhenFeaturesChange) {
    Scene scene = box_on_box();
    mark(scene.find()[0]);
    const Manifold before = scene.find()[0];
    turn(scene.bodies[1], Quat(Eigen::AngleAxisd(EIGEN_PI, Vec3::UnitZ())));
    const Manifold& m = scene.find()[0];
    ASSERT_EQ(m.count, 4);
    bool other = false;
    for (int i = 0; i < 4; ++i) {
        const ContactPoint& p = m.points[std::size_t(i)];
        for (const ContactPoint& q : before.points) other = other || (q.impulse == p.impulse && q.feature != p.feature);
    }
    EXPECT_TRUE(other);
    double sum = 0.0;
    for (int i = 0; i < 4; ++i) sum += m.points[std::size_t(i)].impulse;
    EXPECT_EQ(sum, 10.0) << "each old impulse once";
}
