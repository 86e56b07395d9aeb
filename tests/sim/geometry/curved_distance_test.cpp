// Distances of random pairs of curved shapes against an own search for the nearest points in extended precision.
#include "sim/geometry/curved_axis.h"
#include "sim/geometry/shapes/curved.h"
#include "sim/random_shapes.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

namespace tumble::curved_distance_test {
using namespace tumble::testing;

namespace {

using Real = long double;
using Vec = Eigen::Matrix<Real, 3, 1>;
using CurvedRef = std::shared_ptr<const CurvedBody>;

/// Without triangles for drawing.
CurvedShape random_shape(Random& random, int kind) {
    CurvedShape shape;
    shape.kind = CurvedKind(kind);
    shape.radius = random(0.1, 1.0);
    shape.height = random(0.1, 2.0);
    if (shape.kind == CurvedKind::cylinder) shape.top_radius = shape.radius;
    if (shape.kind == CurvedKind::cone && random.below(2)) shape.top_radius = random(0.1, 1.0);
    if (shape.kind == CurvedKind::ellipsoid) shape.radii = {random(0.2, 1.0), random(0.2, 1.0), random(0.2, 1.0)};
    return shape;
}

CurvedRef body_of(const CurvedShape& shape) {
    ColliderCache cache;
    return std::get<CurvedRef>(make_collider(shape, {false, mass_properties(shape, 1.0).center_of_mass, 1.0}, cache));
}

/// The farthest point along a direction, without the rounding.
Vec support(const CurvedBody& body, const Pose& pose, const Vec& direction) {
    const Eigen::Matrix<Real, 3, 3> turn = pose.rotation.cast<Real>();
    const Vec d = turn.transpose() * direction;
    Vec p;
    if (body.ellipsoid) {
        const Vec radii = body.radii.cast<Real>(), scaled = radii.cwiseProduct(d);
        p = radii.cwiseProduct(scaled) / scaled.norm();
    } else {
        const Real out = std::sqrt(d.x() * d.x() + d.z() * d.z());
        const auto rim = [&](const CurvedBody::Disc& disc) {
            const Real r = out > 0 ? disc.radius / out : 0;
            return Vec(r * d.x(), disc.y, r * d.z());
        };
        const Vec low = rim(body.discs[0]), high = rim(body.discs[1]);
        p = d.dot(high) > d.dot(low) ? high : low;
    }
    return pose.position.cast<Real>() + turn * p;
}

/// The point nearest to the origin of the hull of up to four points, of which only those needed are kept: the best of
/// all subsets.
Vec nearest(std::vector<Vec>& points) {
    std::vector<Vec> best_points;
    Vec best = Vec::Zero();
    Real least = infinity;
    const std::size_t n = points.size();
    for (unsigned subset = 1; subset < 1u << n; ++subset) {
        std::vector<Vec> chosen;
        for (std::size_t i = 0; i < n; ++i)
            if ((subset >> i & 1) != 0) chosen.push_back(points[i]);
        // The point p0 + E x that is nearest to the origin: E^T E x = -E^T p0.
        const auto m = Eigen::Index(chosen.size() - 1);
        Eigen::Matrix<Real, 3, Eigen::Dynamic> edges(3, m);
        for (Eigen::Index i = 0; i < m; ++i) edges.col(i) = chosen[std::size_t(i + 1)] - chosen[0];
        Eigen::Matrix<Real, Eigen::Dynamic, 1> x(m);
        if (m > 0) x = edges.colPivHouseholderQr().solve(-chosen[0]);
        if (m > 0 && (!(x.minCoeff() >= 0) || !(x.sum() <= 1))) continue;
        const Vec p = m > 0 ? Vec(chosen[0] + edges * x) : chosen[0];
        if (!(p.squaredNorm() < least)) continue;
        least = p.squaredNorm();
        best = p;
        best_points = chosen;
    }
    points = best_points;
    return best;
}

/// Lower and upper bound of the distance without the roundings; equal to rounding where it converges.
struct Distance {
    Real low, high;
};
Distance brute_distance(const CurvedBody& a, const Pose& pose_a, const CurvedBody& b, const Pose& pose_b) {
    const auto corner = [&](const Vec& n) { return Vec(support(b, pose_b, -n) - support(a, pose_a, n)); };
    std::vector<Vec> simplex{corner((pose_b.position - pose_a.position).cast<Real>())};
    Vec v = simplex[0];
    Real low = -infinity;
    for (int round = 0; round < 400; ++round) {
        const Real length = v.norm();
        if (!(length > 1e-12L)) return {0, length};
        const Vec n = v / length, w = corner(n);
        low = std::max(low, n.dot(w));
        if (length - low < 1e-16L) break;
        if (simplex.size() == 4) return {0, 0};
        simplex.push_back(w);
        const Vec next = nearest(simplex);
        if (!(next.norm() < length)) break;
        v = next;
    }
    return {low, v.norm()};
}

double separation_of(const CurvedBody& a, const Pose& pose_a, const CurvedBody& b, const Pose& pose_b) {
    const ConvexShape first = convex_shape(a, pose_a), second = convex_shape(b, pose_b);
    CurvedAxisSearch search(first, second);
    search.find_flat(infinity);
    return search.find_best().separation;
}

// To 1e-12 of the size; from either side; and no farther from that of moved bodies than they have moved.
TEST(CurvedDistance, AgreesWithASearchInExtendedPrecision) {
    Random random(5);
    int apart = 0, settled = 0;
    for (int trial = 0; trial < trials(10000); ++trial) {
        const CurvedRef a = body_of(random_shape(random, trial % 4)), b = body_of(random_shape(random, trial / 4 % 4));
        const Pose pose_a = random.pose(0.5), pose_b = random.pose(3.0);
        const double size = a->radius + b->radius, rounding = a->rounding + b->rounding;
        const Distance brute = brute_distance(*a, pose_a, *b, pose_b);
        if (!(brute.low > 1e-3L * size)) continue;
        ++apart;
        const double found = separation_of(*a, pose_a, *b, pose_b);
        EXPECT_LE(found, double(brute.high) - rounding + 1e-13 * size) << "trial " << trial;
        EXPECT_GE(found, double(brute.low) - rounding - 1e-12 * size) << "trial " << trial;
        settled += double(brute.high - brute.low) < 1e-12 * size;
        EXPECT_NEAR(separation_of(*b, pose_b, *a, pose_a), found, 1e-13 * size) << "trial " << trial;
        const Vec3 step = 1e-9 * random.direction();
        const Pose moved{pose_b.position + step, pose_b.rotation};
        EXPECT_NEAR(separation_of(*a, pose_a, *b, moved), found, 1e-9 + 1e-13 * size) << "trial " << trial;
    }
    EXPECT_GT(apart, trials(10000) / 2);
    EXPECT_GT(settled, apart * 9 / 10);  // the bounds of the others are apart
}

// From the axis of the last step: the same distance.
TEST(CurvedDistance, IsThatFromTheLastAxis) {
    Random random(6);
    int near = 0;
    for (int trial = 0; trial < trials(10000); ++trial) {
        const CurvedRef a = body_of(random_shape(random, trial % 4)), b = body_of(random_shape(random, trial / 4 % 4));
        const Pose pose_a = random.pose(0.5), pose_b = random.pose(2.0);
        const double size = a->radius + b->radius;
        const ConvexShape first = convex_shape(*a, pose_a), second = convex_shape(*b, pose_b);
        CurvedAxisSearch search(first, second);
        search.find_flat(infinity);
        const CurvedAxis best = search.find_best();
        if (best.separation < -0.02 * size) continue;
        ++near;
        const Vec3 guess = (best.normal + 1e-3 * random.direction()).normalized();
        CurvedAxisSearch again(first, second);
        again.find_flat(infinity, guess);
        EXPECT_NEAR(again.find_best().separation, best.separation, 1e-12 * size) << "trial " << trial;
    }
    EXPECT_GT(near, trials(10000) / 2);
}

}  // namespace
}  // namespace tumble::curved_distance_test
