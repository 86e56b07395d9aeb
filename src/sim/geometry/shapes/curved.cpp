#include "sim/geometry/shapes/curved.h"

#include "core/deterministic_math.h"
#include "sim/geometry/shapes/shape.h"

#include <algorithm>
#include <cmath>

namespace tumble {
namespace {

/// Surface area over 4 (Cauchy 1832). Of an ellipsoid the mean over a grid of directions that is dense enough for five
/// digits.
double mean_projected_area(const CurvedShape& shape) {
    const double r = shape.radius, top = shape.top_radius;
    switch (shape.kind) {
        case CurvedKind::capsule:
            return pi * r * (r + 0.5 * shape.height);
        case CurvedKind::cylinder:
        case CurvedKind::cone:
            return 0.25 * pi * (r * r + top * top + (r + top) * hypotenuse(shape.height, r - top));
        case CurvedKind::ellipsoid:
            break;
    }
    constexpr int heights = 256, turns = 32;
    const Vec3& a = shape.radii;
    const Vec3 sides(a.y() * a.z(), a.z() * a.x(), a.x() * a.y());
    double sum = 0.0;
    for (int i = 0; i < heights; ++i)
        for (int k = 0; k < turns; ++k) {
            const double up = (i + 0.5) / heights, out = std::sqrt(1.0 - up * up);
            const SinCos turn = sincos(2.0 * pi * (k + 0.5) / turns);
            sum += sides.cwiseProduct(Vec3(out * turn.cos, up, out * turn.sin)).norm();
        }
    return pi * sum / (heights * turns);
}

CurvedBody make_body(const CurvedShape& shape, double origin) {
    CurvedBody body;
    const double half = 0.5 * shape.height;
    body.ellipsoid = shape.kind == CurvedKind::ellipsoid;
    body.radii = shape.radii;
    body.projected_area = mean_projected_area(shape);
    if (body.ellipsoid) {
        body.radius = shape.radii.maxCoeff();
        body.inner_radius = shape.radii.minCoeff();
        return body;
    }
    const bool capsule = shape.kind == CurvedKind::capsule;
    body.rounding = capsule ? shape.radius : 0.0;
    body.discs = {CurvedBody::Disc{-half - origin, capsule ? 0.0 : shape.radius},
                  CurvedBody::Disc{half - origin, capsule ? 0.0 : shape.top_radius}};
    const auto& [low, high] = body.discs;
    const double length = hypotenuse(shape.height, low.radius - high.radius);
    body.slant = Vec3(shape.height, low.radius - high.radius, 0.0) / length;
    body.ends = {low.y * Vec3::UnitY(), high.y * Vec3::UnitY()};
    body.radius = std::max(hypotenuse(low.y, low.radius), hypotenuse(high.y, high.radius)) + body.rounding;
    body.inner_radius =
        std::min({-low.y, high.y, body.slant.x() * low.radius + body.slant.y() * low.y}) + body.rounding;
    return body;
}

/// Heights over the surfaces of two discs and the side between them, m: of the side in its own direction.
struct Heights {
    double below, above, beside;
};
Heights heights_over(const CurvedBody& body, const Vec3& p) {
    const auto& [low, high] = body.discs;
    const double out = hypotenuse(p.x(), p.z());
    return {low.y - p.y(), p.y() - high.y, body.slant.x() * (out - low.radius) + body.slant.y() * (p.y() - low.y)};
}

// The roots of a t^2 + 2 b t + c, without cancellation; infinity for none.
std::array<double, 2> roots(double a, double b, double c) {
    const double square = b * b - a * c;
    if (square < 0.0) return {infinity, infinity};
    const double q = b > 0.0 ? -b - std::sqrt(square) : -b + std::sqrt(square);
    return {a != 0.0 ? q / a : infinity, q != 0.0 ? c / q : infinity};
}

double first_on_ball(const Vec3& from, const Vec3& direction, double radius) {
    const auto [one, other] = roots(direction.squaredNorm(), from.dot(direction), from.squaredNorm() - radius * radius);
    const double first = std::min(one, other);
    return first > 0.0 ? first : infinity;
}

// Length of a direction's part across the axis: squares of directions neither overflow nor vanish.
double across_axis(const Vec3& d) { return std::sqrt(d.x() * d.x() + d.z() * d.z()); }

}  // namespace

int CurvedBody::end_along(const Vec3& d) const {
    const double out = across_axis(d);
    return d.y() * (discs[1].y - discs[0].y) + out * (discs[1].radius - discs[0].radius) > 0.0 ? 1 : 0;
}

Vec3 CurvedBody::rim_point(int end, const Vec3& d) const {
    const Disc& disc = discs[std::size_t(end)];
    const double out = across_axis(d);
    if (!(out > 0.0)) return {disc.radius, disc.y, 0.0};
    return {disc.radius * d.x() / out, disc.y, disc.radius * d.z() / out};
}

Vec3 CurvedBody::support(const Vec3& d) const {
    if (!ellipsoid) return rim_point(end_along(d), d);
    const Vec3 scaled = radii.cwiseProduct(d);
    return radii.cwiseProduct(scaled) / scaled.norm();
}

Mat3 CurvedBody::bend(const Vec3& d) const {
    if (ellipsoid) {
        const Vec3 square = radii.cwiseProduct(radii), point = square.cwiseProduct(d);
        const double length = radii.cwiseProduct(d).norm();
        return Mat3(square.asDiagonal()) / length - point * point.transpose() / (length * length * length);
    }
    const double out = across_axis(d);
    if (!(out > 0.0)) return Mat3::Zero();
    const Vec3 around(d.z() / out, 0.0, -d.x() / out);
    return discs[std::size_t(end_along(d))].radius / out * around * around.transpose();
}

double CurvedBody::farthest_from(const Vec3& p) const {
    if (ellipsoid) return radius + p.norm();
    const double out = hypotenuse(p.x(), p.z());
    double farthest = 0.0;
    for (const Disc& disc : discs) farthest = std::max(farthest, hypotenuse(out + disc.radius, p.y() - disc.y));
    return farthest + rounding;
}

Bounds CurvedBody::world_bounds(const Pose& pose) const {
    Bounds bounds;
    for (int k = 0; k < 3; ++k) {
        const Vec3 axis = pose.rotation.row(k).transpose();
        bounds.max[k] = pose.position[k] + extent(axis);
        bounds.min[k] = pose.position[k] - extent(-axis);
    }
    return bounds;
}

bool CurvedBody::contains(const Vec3& p, double tolerance) const {
    if (ellipsoid) return p.cwiseQuotient(radii).norm() <= 1.0 + tolerance / inner_radius;
    if (rounding > 0.0) {
        const double y = std::clamp(p.y(), discs[0].y, discs[1].y);
        return (p - y * Vec3::UnitY()).norm() <= rounding + tolerance;
    }
    const Heights over = heights_over(*this, p);
    return std::max({over.below, over.above, over.beside}) <= tolerance;
}

// Polygons of 16 sides around the rims, two of which lie along each axis; around an ellipsoid the
// corners of the octahedron cut by a cube, both around the ball.
void visit_extent(const CurvedShape& shape, const ExtentVisitor& visit) {
    const double half = 0.5 * shape.height;
    if (shape.kind == CurvedKind::capsule) {
        for (const double y : {-half, half}) visit(y * Vec3::UnitY(), shape.radius);
        return;
    }
    if (shape.kind == CurvedKind::ellipsoid) {
        const double cut = std::sqrt(3.0) - 1.0;
        for (int k = 0; k < 3; ++k)
            for (const double side : {-1.0, 1.0})
                for (int other = 1; other < 3; ++other)
                    for (const double at : {-cut, cut}) {
                        Vec3 corner = side * Vec3::Unit(k);
                        corner[(k + other) % 3] = at;
                        visit(shape.radii.cwiseProduct(corner), 0.0);
                    }
        return;
    }
    constexpr int sides = 16;
    const double over = 1.0 / sincos(pi / sides).cos;
    for (const auto& [y, radius] : {std::pair(-half, shape.radius), std::pair(half, shape.top_radius)}) {
        for (int i = 0; i < (radius > 0.0 ? sides : 1); ++i) {
            const SinCos turn = sincos(pi * (2 * i + 1) / sides);
            // Exact along the axes: the rounding of the angles must not show in the bounds.
            Vec3 corner = over * radius * Vec3(turn.cos, 0.0, turn.sin);
            for (const int k : {0, 2})
                if (std::fabs(std::fabs(corner[k]) - radius) < 1e-12 * radius)
                    corner[k] = std::copysign(radius, corner[k]);
            visit(corner + y * Vec3::UnitY(), 0.0);
        }
    }
}

MassProperties mass_properties(const CurvedShape& shape, double density) {
    MassProperties p;
    const double r = shape.radius, h = shape.height;
    if (shape.kind == CurvedKind::ellipsoid) {
        const Vec3 square = shape.radii.cwiseProduct(shape.radii);
        p.mass = density * 4.0 / 3.0 * pi * shape.radii.prod();
        p.inertia.diagonal() =
            0.2 * p.mass * Vec3(square.y() + square.z(), square.z() + square.x(), square.x() + square.y());
        return p;
    }
    double along, across;
    if (shape.kind == CurvedKind::capsule) {
        const double side = density * pi * r * r * h, ends = density * 4.0 / 3.0 * pi * r * r * r;
        p.mass = side + ends;
        along = (0.5 * side + 0.4 * ends) * r * r;
        across = side * (3.0 * r * r + h * h) / 12.0 + ends * (0.4 * r * r + 0.25 * h * h + 0.375 * h * r);
    } else if (shape.top_radius == r) {
        p.mass = density * pi * r * r * h;
        along = 0.5 * p.mass * r * r;
        across = p.mass * (3.0 * r * r + h * h) / 12.0;
    } else {
        const double top = shape.top_radius, squares = r * r + r * top + top * top;
        p.mass = density * pi * h / 3.0 * squares;
        const double height = 0.25 * h * (r * r + 2.0 * r * top + 3.0 * top * top) / squares;  // of the center
        p.center_of_mass.y() = height - 0.5 * h;
        along = density * pi * h / 10.0 * (r * r * r * r + r * top * squares + top * top * top * top);
        // Half of that about a diameter of each slice, and the squared distances of the slices from the base.
        across = 0.5 * along + density * pi * h * h * h * (r * r + 3.0 * r * top + 6.0 * top * top) / 30.0 -
                 p.mass * height * height;
    }
    p.inertia.diagonal() = Vec3(across, along, across);
    return p;
}

double first_hit(const CurvedShape& shape, const Vec3& from, const Vec3& direction) {
    if (make_body(shape, 0.0).contains(from, 0.0)) return infinity;
    if (shape.kind == CurvedKind::ellipsoid)
        return first_on_ball(from.cwiseQuotient(shape.radii), direction.cwiseQuotient(shape.radii), 1.0);
    const double half = 0.5 * shape.height;
    double first = infinity;
    const auto take = [&](double t) {
        if (t > 0.0) first = std::min(first, t);
    };
    const bool capsule = shape.kind == CurvedKind::capsule;
    const double low = shape.radius, high = capsule ? low : shape.top_radius;
    // The side: the points at a distance of middle + slope y from the axis.
    const double middle = 0.5 * (low + high), slope = (high - low) / shape.height;
    const double at = middle + slope * from.y(), change = slope * direction.y();
    const double a = direction.x() * direction.x() + direction.z() * direction.z() - change * change;
    const double b = from.x() * direction.x() + from.z() * direction.z() - change * at;
    const double c = from.x() * from.x() + from.z() * from.z() - at * at;
    for (const double t : roots(a, b, c))
        if (std::fabs(from.y() + t * direction.y()) <= half) take(t);
    for (const auto& [y, radius] : {std::pair(-half, low), std::pair(half, high)}) {
        if (capsule) {
            take(first_on_ball(from - y * Vec3::UnitY(), direction, radius));
            continue;
        }
        const double t = (y - from.y()) / direction.y();
        const double x = from.x() + t * direction.x(), z = from.z() + t * direction.z();
        if (x * x + z * z <= radius * radius) take(t);
    }
    return first;
}

Vec3 normal_at(const CurvedShape& shape, const Vec3& p) {
    if (shape.kind == CurvedKind::ellipsoid) return p.cwiseQuotient(shape.radii.cwiseProduct(shape.radii)).normalized();
    const double half = 0.5 * shape.height;
    if (shape.kind == CurvedKind::capsule) return (p - std::clamp(p.y(), -half, half) * Vec3::UnitY()).normalized();
    const CurvedBody body = make_body(shape, 0.0);
    const Heights over = heights_over(body, p);
    if (over.below >= over.beside && over.below >= over.above) return -Vec3::UnitY();
    if (over.above >= over.beside) return Vec3::UnitY();
    const double out = hypotenuse(p.x(), p.z());
    if (!(out > 0.0)) return Vec3::UnitY();
    return {body.slant.x() * p.x() / out, body.slant.y(), body.slant.x() * p.z() / out};
}

CurvedShape enlarged(const CurvedShape& shape, double factor) {
    return {shape.kind, shape.radius * factor, shape.top_radius * factor, shape.height * factor, shape.radii * factor};
}

CollisionShape make_collider(const CurvedShape& shape, const ColliderRequest& request, ColliderCache& cache) {
    const Vec3& origin = request.origin;
    const double along = shape.kind == CurvedKind::ellipsoid ? 0.0 : origin.y();
    auto& made = cache.curved[{double(shape.kind), shape.radius, shape.top_radius, shape.height, shape.radii.x(),
                               shape.radii.y(), shape.radii.z(), along}];
    if (!made) made = std::make_shared<const CurvedBody>(make_body(shape, along));
    const Vec3 off = origin - along * Vec3::UnitY();
    if (off.isZero(0.0)) return made;
    // A center of mass off the axis: the shape as a part of a whole.
    auto whole = std::make_shared<Compound>();
    whole->parts.push_back({made, {-off, Mat3::Identity()}});
    whole->complete();
    return std::shared_ptr<const Compound>(std::move(whole));
}

}  // namespace tumble
