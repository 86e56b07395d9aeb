// The time of impact: never missed, never early, to the last digits; grazing and touching starts.
#include "sim/ccd/time_of_impact.h"
#include "sim/event_driven/contact_transition.h"
#include "sim/event_driven/settings.h"
#include "sim/geometry/separating_axis.h"
#include "sim/random_shapes.h"
#include "support/bodies.h"

#include <gtest/gtest.h>

#include <cmath>

namespace tumble::time_of_impact_test {
using namespace tumble::testing;

namespace {

const Vec3 gravity(0.0, -9.81, 0.0);

struct Flying {
    Body body;
    Trajectory path;
    explicit Flying(const Body& b, const Vec3& acceleration = gravity)
        : body(b), path(Trajectory::flight(b, acceleration)) {}
    MovingBody moving_body(double since = 0.0) const { return {&body, &path, since}; }
};

const Polyhedron& shape_of(const Body& body) { return *std::get<std::shared_ptr<const Polyhedron>>(body.collider); }

double lowest(const Flying& f, double t) {
    const Motion m = f.path.at(t);
    double height = 1e300;
    for (const Vec3& v : shape_of(f.body).vertices) height = std::min(height, m.to_world(v).y());
    return height;
}

// By all separating axes: the distance of boxes or, where vertices are nearest, slightly less.
double gap(const Flying& a, const Flying& b, double t) {
    const Motion ma = a.path.at(t), mb = b.path.at(t);
    CollisionScratch scratch;
    scratch.choice = AxisChoice::nearest;
    const Pose b_in_a{ma.rotation.transpose() * (mb.position - ma.position), ma.rotation.transpose() * mb.rotation};
    const AxisQuery query{shape_of(a.body), shape_of(b.body), b_in_a, 1e9, EdgeSearch::all, Vec3::Zero()};
    return find_separating_axis(query, scratch).separation;
}

struct Ground {
    Body body;
    Trajectory path;
    Ground() {
        body.type = BodyType::fixed;
        body.collider = HalfSpace{Vec3::UnitY(), 0.0};
        body.radius = std::numeric_limits<double>::infinity();
        path = Trajectory::uniform(body, Vec3::Zero(), Vec3::Zero());
    }
    MovingBody moving_body() const { return {&body, &path, 0.0}; }
};

}  // namespace

TEST(TimeOfImpact, BallOnPlaneIsTheQuadratic) {
    const Ground ground;
    ImpactSearch search;
    Random random(7);
    for (int trial = 0; trial < 1000; ++trial) {
        const double r = random(0.01, 1.0), height = r + random(0.0, 10.0), v = random(-10.0, 10.0);
        const Flying ball(free_ball(r, 1.0, {0.0, height, 0.0}, {1.0, v, 0.0}));
        const TimeOfImpact found = search.find(ground.moving_body(), ball.moving_body(), 100.0);
        ASSERT_EQ(found.kind, TimeOfImpact::Kind::impact);
        const double exact = (v + std::sqrt(v * v + 2.0 * 9.81 * (height - r))) / 9.81;
        EXPECT_NEAR(found.time, exact, 1e-14 * (1.0 + exact));
    }
}

TEST(TimeOfImpact, BallsMeetWhereTheirCentersAreARadiusSumApart) {
    ImpactSearch search;
    Random random(7);
    int hits = 0;
    for (int trial = 0; trial < 2000; ++trial) {
        const Flying a(free_ball(random(0.1, 0.5), 1.0, Vec3::Zero(), random.vector(1.0)));
        const Vec3 from = random.direction();
        const Flying b(free_ball(random(0.1, 0.5), 1.0, random(1.0, 3.0) * from, random.vector(2.0) - 2.0 * from));
        const double reach = a.body.radius + b.body.radius;
        const TimeOfImpact found = search.find(a.moving_body(), b.moving_body(), 5.0);
        const auto distance = [&](double t) { return (b.path.position(t) - a.path.position(t)).norm() - reach; };
        const double end = found.kind == TimeOfImpact::Kind::impact ? found.time : 5.0;
        for (int k = 0; k < 100; ++k) EXPECT_GT(distance(end * k / 100.0), -1e-12);
        if (found.kind != TimeOfImpact::Kind::impact) continue;
        ++hits;
        EXPECT_NEAR(distance(found.time), 0.0, 1e-12);
    }
    EXPECT_GT(hits, 100);
}

// A tumbling box reaches the ground for the first time: gap of 1e-12 m then, above it before, below it after.
TEST(TimeOfImpact, TumblingBoxOnPlane) {
    const Ground ground;
    ImpactSearch search;
    Random random(7);
    for (const double spin : {0.0, 1.0, 10.0, 100.0, 1000.0}) {
        for (int trial = 0; trial < 100; ++trial) {
            const Flying box(free_box({1.0, 0.6, 0.2}, 1.0, {0.0, random(1.0, 2.0), 0.0}, random.vector(3.0),
                                      random.turn(), random.vector(spin)));
            const TimeOfImpact found = search.find(ground.moving_body(), box.moving_body(), 5.0);
            ASSERT_EQ(found.kind, TimeOfImpact::Kind::impact);
            EXPECT_NEAR(lowest(box, found.time), 0.0, 1e-12);
            EXPECT_LT(lowest(box, found.time + 1e-9), 0.0);
            for (int k = 0; k < 500; ++k) ASSERT_GT(lowest(box, found.time * (k + 0.5) / 500.0), -1e-12) << spin;
        }
    }
}

TEST(TimeOfImpact, TumblingBoxes) {
    ImpactSearch search;
    Random random(7);
    for (const double spin : {0.0, 1.0, 10.0, 100.0}) {
        int hits = 0;
        for (int trial = 0; trial < 60; ++trial) {
            const Flying a(
                free_box({1.0, 0.6, 0.2}, 1.0, Vec3::Zero(), Vec3::Zero(), random.turn(), random.vector(spin)));
            const Vec3 from = Vec3(random(-1, 1), random(-1, 1), random(-0.4, 0.4)).normalized();
            const Flying b(free_box({0.6, 0.6, 0.6}, 1.0, 2.0 * from, random.vector(0.6) - 4.0 * from, random.turn(),
                                    random.vector(spin)));
            const TimeOfImpact found = search.find(a.moving_body(), b.moving_body(), 1.0);
            ASSERT_NE(found.kind, TimeOfImpact::Kind::check);
            const double end = found.kind == TimeOfImpact::Kind::impact ? found.time : 1.0;
            for (int k = 0; k < 300; ++k) ASSERT_GT(gap(a, b, end * (k + 0.5) / 300.0), -1e-10) << spin << " " << trial;
            if (found.kind != TimeOfImpact::Kind::impact) continue;
            ++hits;
            EXPECT_NEAR(gap(a, b, found.time), 0.0, 1e-12);
            EXPECT_LT(gap(a, b, found.time + 1e-8), 0.0);
        }
        EXPECT_GT(hits, 40);
    }
}

// Round hulls, whose nearest points have to be searched for.
TEST(TimeOfImpact, TumblingHulls) {
    ImpactSearch search;
    Random random(7);
    int hits = 0;
    for (int trial = 0; trial < 40; ++trial) {
        std::vector<Vec3> points_a, points_b;
        for (int i = 0; i < 40; ++i) points_a.push_back(0.5 * random.direction());
        for (int i = 0; i < 40; ++i) points_b.push_back(0.4 * random.direction());
        const Flying a(free_hull(points_a, 1.0, Vec3::Zero(), Vec3::Zero(), random.vector(10.0)));
        const Flying b(free_hull(points_b, 1.0, {2.0, random(-0.5, 0.5), random(-0.5, 0.5)}, {-4.0, 0.0, 0.0},
                                 random.vector(10.0)));
        const TimeOfImpact found = search.find(a.moving_body(), b.moving_body(), 1.0);
        ASSERT_NE(found.kind, TimeOfImpact::Kind::check);
        const double end = found.kind == TimeOfImpact::Kind::impact ? found.time : 1.0;
        for (int k = 0; k < 50; ++k) ASSERT_GT(gap(a, b, end * (k + 0.5) / 50.0), -1e-10) << trial;
        if (found.kind != TimeOfImpact::Kind::impact) continue;
        ++hits;
        EXPECT_NEAR(gap(a, b, found.time), 0.0, 1e-11);
    }
    EXPECT_GT(hits, 30);
}

// A corner that just passes the ground: starting heights that differ by 1e-12 m separate a touch from a miss.
TEST(TimeOfImpact, GrazingIsDecidedToTheLastDigits) {
    const Ground ground;
    ImpactSearch search;
    const auto box = [&](double height) {
        return Flying(free_box({1.0, 0.6, 0.2}, 1.0, {0.0, height, 0.0}, {0.0, 3.0, 0.0},
                               Quat(0.3, 0.5, 0.2, 0.7).normalized(), {3.0, 7.0, 2.0}));
    };
    const auto touches = [&](double height) {
        const Flying f = box(height);
        return lowest(f, 0.0) <= 0.0 ||
               search.find(ground.moving_body(), f.moving_body(), 0.4).kind == TimeOfImpact::Kind::impact;
    };
    double low = 0.2, high = 1.5;
    for (int i = 0; i < 80; ++i) (touches(0.5 * (low + high)) ? low : high) = 0.5 * (low + high);
    for (const double offset : {1e-3, 1e-6, 1e-9, 1e-12}) {
        EXPECT_FALSE(touches(high + offset)) << offset;
        EXPECT_TRUE(touches(high - offset)) << offset;
    }
}

TEST(TimeOfImpact, TouchingAtTheStart) {
    const Ground ground;
    ImpactSearch search;
    // Parting: the impact is the next one. Flat, upwards at 3 m/s: back after 2 v / g.
    const Flying up(free_box({1.0, 0.6, 0.2}, 1.0, {0.0, 0.3, 0.0}, {0.0, 3.0, 0.0}, Quat::Identity(), Vec3::Zero()));
    TimeOfImpact found = search.find(ground.moving_body(), up.moving_body(), 5.0);
    ASSERT_EQ(found.kind, TimeOfImpact::Kind::impact);
    EXPECT_NEAR(found.time, 6.0 / 9.81, 1e-13);
    // Approaching: at once.
    const Flying down(
        free_box({1.0, 0.6, 0.2}, 1.0, {0.0, 0.3, 0.0}, {0.0, -1e-6, 0.0}, Quat::Identity(), Vec3::Zero()));
    found = search.find(ground.moving_body(), down.moving_body(), 5.0);
    ASSERT_EQ(found.kind, TimeOfImpact::Kind::impact);
    EXPECT_EQ(found.time, 0.0);
    // At rest against each other without forces: never.
    const Flying left(free_box({1, 1, 1}, 1.0, Vec3::Zero(), Vec3::Zero(), Quat::Identity(), Vec3::Zero()),
                      Vec3::Zero());
    const Flying right(free_box({1, 1, 1}, 1.0, {1, 0, 0}, Vec3::Zero(), Quat::Identity(), Vec3::Zero()), Vec3::Zero());
    EXPECT_EQ(search.find(left.moving_body(), right.moving_body(), 5.0).kind, TimeOfImpact::Kind::none);
    // At rest, exactly, and about to fall: as soon as the fall exceeds rounding.
    const Flying rests(free_box({1, 1, 1}, 1.0, {0, 1, 0}, Vec3::Zero(), Quat::Identity(), Vec3::Zero()));
    found = search.find(left.moving_body(), rests.moving_body(), 5.0);
    ASSERT_EQ(found.kind, TimeOfImpact::Kind::impact);
    EXPECT_LT(found.time, 1e-5);
    const Flying ball(free_ball(0.5, 1.0, {0, 0.5, 0}, Vec3::Zero()));
    found = search.find(ground.moving_body(), ball.moving_body(), 5.0);
    ASSERT_EQ(found.kind, TimeOfImpact::Kind::impact);
    EXPECT_LT(found.time, 1e-5);
}

// From their first touch on, boxes may overlap up to the allowed depth; also along the border of a face, where no point
// lies on the face.
TEST(TimeOfImpact, TouchingBodiesMayOverlapMore) {
    Random random(5);
    ImpactSearch search;
    int hits = 0;
    for (int trial = 0; trial < trials(20000); ++trial) {
        const auto box = [&](const Vec3& position, const Vec3& velocity) {
            const Vec3 size(random(0.05, 1.0), random(0.05, 1.0), random(0.05, 1.0));
            return Flying(free_box(size, 1.0, position, velocity, random.turn(), random.vector(3.0)), Vec3::Zero());
        };
        const Vec3 from = 2.5 * random.direction();
        const Flying a = box(Vec3::Zero(), Vec3::Zero()), b = box(from, random.vector(0.6) - from);
        const TimeOfImpact touch = search.find(a.moving_body(), b.moving_body(), 1.0);
        if (touch.kind != TimeOfImpact::Kind::impact) continue;
        const TimeOfImpact deeper = search.find(a.moving_body(touch.time), b.moving_body(touch.time), 0.5, 0.002);
        ++hits;
        // No point approaches faster than 2.5 m/s plus twice 5 rad/s about 0.9 m.
        if (deeper.kind != TimeOfImpact::Kind::none) {
            EXPECT_GT(deeper.time, 0.002 / (3.6 + 2.0 * 5.2 * 0.9)) << trial;
        }
    }
    EXPECT_GT(hits, trials(10000));
}

// A point that touches and stands still overlaps within the harmless time by at most the harmless depth, for any motion
// of the body.
TEST(TimeOfImpact, TheHarmlessTimeIsHarmless) {
    const Ground ground;
    Random random(9);
    double farthest = 0.0;
    for (int trial = 0; trial < 500; ++trial) {
        const Vec3 size(random(0.001, 1.0), random(0.001, 1.0), random(0.001, 1.0)),
            spin = random.vector(trial % 2 ? 100.0 : 1.0);
        Body body = free_box(size, 1.0, Vec3::Zero(), Vec3::Zero(), random.turn(), spin);
        const Vec3 corner = 0.5 * size, arm = body.rotation * corner;
        body.momentum = -body.mass * body.angular_velocity.cross(arm);
        body.derive();
        const Flying flying(body);
        const double t = harmless_time(ground.moving_body(), flying.moving_body()),
                     most = tuning::impact_harmless * body.radius;
        for (const double part : {0.3, 1.0}) {
            const double way = (flying.path.at(part * t).to_world(corner) - arm).norm();
            EXPECT_LT(way, 1.01 * part * part * most) << trial;
            farthest = std::max(farthest, way / most);
        }
    }
    EXPECT_GT(farthest, 0.3);
}

TEST(TimeOfImpact, HugeAndTinySpeeds) {
    const Ground ground;
    ImpactSearch search;
    for (const double v : {1e-9, 1e-3, 1.0, 1e3, 1e6}) {
        const Flying box(free_box({0.1, 0.1, 0.1}, 1.0, {0.0, 1.0, 0.0}, {0.0, -v, 0.0},
                                  Quat(1.0, 0.1, 0.2, 0.3).normalized(), Vec3::Zero()),
                         Vec3::Zero());
        const TimeOfImpact found = search.find(ground.moving_body(), box.moving_body(), 1e10);
        ASSERT_EQ(found.kind, TimeOfImpact::Kind::impact) << v;
        EXPECT_NEAR(found.time * v, lowest(box, 0.0), 1e-12) << v;
    }
}

// The same impact for either order of the bodies and any time since their start.
TEST(TimeOfImpact, DoesNotDependOnTheOrderOrTheOrigin) {
    ImpactSearch search;
    Random random(7);
    for (int trial = 0; trial < 30; ++trial) {
        const Flying a(free_box({1.0, 0.6, 0.2}, 1.0, Vec3::Zero(), Vec3::Zero(), random.turn(), random.vector(5.0)));
        const Flying b(
            free_box({0.6, 0.6, 0.6}, 1.0, {2.0, 0.0, 0.0}, {-4.0, 0.0, 0.0}, random.turn(), random.vector(5.0)));
        const TimeOfImpact first = search.find(a.moving_body(), b.moving_body(), 1.0),
                           second = search.find(b.moving_body(), a.moving_body(), 1.0);
        ASSERT_EQ(first.kind, second.kind);
        EXPECT_NEAR(first.time, second.time, 1e-12);
        const TimeOfImpact later = search.find(a.moving_body(0.1), b.moving_body(0.1), 1.0);
        if (first.kind == TimeOfImpact::Kind::impact && first.time > 0.1) {
            EXPECT_NEAR(later.time + 0.1, first.time, 1e-12);
        }
    }
}

// A search does not affect the next one: a ball over a mesh is found alike before and after others.
TEST(TimeOfImpact, OneSearchDoesNotAffectTheNext) {
    TriangleMesh mesh;
    mesh.vertices = {{-5, 0, -5}, {5, 0, -5}, {5, 0, 5}, {-5, 0, 5}};
    mesh.triangles = {{0, 2, 1}, {0, 3, 2}};
    Body sheet;
    sheet.type = BodyType::fixed;
    sheet.collider = std::make_shared<const CollisionMesh>(make_collision_mesh(mesh, Vec3::Zero()));
    sheet.radius = bounding_radius(sheet.collider);
    const Trajectory still = Trajectory::uniform(sheet, Vec3::Zero(), Vec3::Zero());
    const Flying ball(free_ball(0.25, 1.0, {0.3, 0.25 + 1e-6, 0.2}, {0.0, 0.01, 0.0}));
    const Flying fast(free_ball(0.25, 1.0, {0.3, 3.0, 0.2}, {0.0, -50.0, 3.0}));
    const double exact = (0.01 + std::sqrt(1e-4 + 2.0 * 9.81 * 1e-6)) / 9.81;
    ImpactSearch search;
    for (int turn = 0; turn < 2; ++turn) {
        const TimeOfImpact found = search.find(ball.moving_body(), {&sheet, &still, 0.0}, 1.0);
        ASSERT_EQ(found.kind, TimeOfImpact::Kind::impact);
        EXPECT_NEAR(found.time, exact, 1e-12);
        const Flying box(
            free_box({1.0, 0.6, 0.2}, 1.0, {0.0, 5.0, 0.0}, {0.0, -50.0, 0.0}, Quat::Identity(), {3.0, 7.0, 2.0}));
        search.find(box.moving_body(), fast.moving_body(), 1.0);
    }
}

}  // namespace tumble::time_of_impact_test
