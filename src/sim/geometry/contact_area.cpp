#include "sim/geometry/contact_area.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

namespace tumble {
namespace {

// Width over length below which a polygon counts as a line: its area would be rounding error.
constexpr double narrow = 1e-6;
// Least load share of a point. Smaller shares, of points all on one side of the area, are moved towards 1.
constexpr double least_share = 0.1;

struct Flat {
    double x, y;  // m
    Flat operator-(const Flat& o) const { return {x - o.x, y - o.y}; }
    double dot(const Flat& o) const { return x * o.x + y * o.y; }
    double cross(const Flat& o) const { return x * o.y - y * o.x; }
};

// Coordinates in the plane normal to an axis, relative to a nearby origin, which keeps digits far from the world's
// origin.
class Plane {
public:
    Plane(const Vec3& normal, const Vec3& origin) : origin_(origin) {
        const int k = normal.x() * normal.x() < 0.36 ? 0 : 1;  // a coordinate axis at a large angle to the normal
        first_ = (Vec3::Unit(k) - normal[k] * normal) / std::sqrt(1.0 - normal[k] * normal[k]);
        second_ = normal.cross(first_);
    }
    Flat operator()(const Vec3& p) const {
        const Vec3 arm = p - origin_;
        return {first_.dot(arm), second_.dot(arm)};
    }
    Vec3 world(const Flat& p) const { return origin_ + p.x * first_ + p.y * second_; }

private:
    Vec3 origin_, first_, second_;
};

// The mean of sqrt(h^2 + x^2) over an interval of x, given h^2: Gauss-Legendre quadrature with three points.
double mean_root(double square, double from, double to) {
    constexpr double near = 0.11270166537925831;
    const double a = from + near * (to - from), b = 0.5 * (from + to), c = to - near * (to - from);
    return (5.0 / 18.0) * (std::sqrt(square + a * a) + std::sqrt(square + c * c)) +
           (8.0 / 18.0) * std::sqrt(square + b * b);
}

// The integral of the distance from the origin over the triangle (0, p, q). Distance grows linearly along a ray, so the
// integral is a third of the height over pq times the integral along pq. Where the foot of the height lies on a long
// edge, its two sides are integrated apart: three points are then within 2e-3 for any edge, and exact for edges through
// the origin or far from it.
double distance_integral(const Flat& p, const Flat& q) {
    const Flat edge = q - p;
    const double length_square = edge.dot(edge), twice = p.cross(q);
    if (!(length_square > 0.0)) return 0.0;
    const double length = std::sqrt(length_square), per_length = 1.0 / length, height = twice * per_length,
                 square = height * height;
    const double from = p.dot(edge) * per_length, to = from + length;
    if (from < 0.0 && to > 0.0 && std::max(from * from, to * to) > square)
        return height / 3.0 * (to * mean_root(square, 0.0, to) - from * mean_root(square, from, 0.0));
    return twice / 3.0 * mean_root(square, from, to);
}

template <class At>
ContactArea polygon_area(std::size_t count, const Vec3& normal, At&& at) {
    if (count < 2) return {count == 0 ? Vec3(Vec3::Zero()) : at(0), 0.0};
    const Plane plane(normal, at(0));
    // twice the signed area, m^2; six times its first moments, m^3; farthest distance, m
    double twice = 0.0, x = 0.0, y = 0.0, farthest = 0.0;
    Flat far{0.0, 0.0}, p = far;
    for (std::size_t i = 1; i < count; ++i) {  // triangle fan from the first corner
        const Flat q = plane(at(i));
        const double part = p.cross(q), square = q.dot(q);
        twice += part;
        x += part * (p.x + q.x);
        y += part * (p.y + q.y);
        if (square > farthest) {
            farthest = square;
            far = q;
        }
        p = q;
    }
    if (std::abs(twice) <= narrow * farthest) {
        Flat other{0.0, 0.0};  // the other end of the line
        for (std::size_t i = 1; i < count; ++i)
            if (const Flat q = plane(at(i)); (q - far).dot(q - far) > (other - far).dot(other - far)) other = q;
        return {plane.world({0.5 * (far.x + other.x), 0.5 * (far.y + other.y)}),
                0.25 * std::sqrt((far - other).dot(far - other))};
    }
    const Flat centroid{x / (3.0 * twice), y / (3.0 * twice)};
    double distance = 0.0;
    const Flat first = Flat{0.0, 0.0} - centroid;
    p = first;
    for (std::size_t i = 1; i < count; ++i) {
        const Flat q = plane(at(i)) - centroid;
        distance += distance_integral(p, q);
        p = q;
    }
    return {plane.world(centroid), (distance + distance_integral(p, first)) / (0.5 * twice), 0.5 * std::abs(twice)};
}

// Twice the signed area of a triangle or quadrilateral.
double twice_area(std::span<const Flat> corners) {
    double twice = 0.0;
    for (std::size_t i = 2; i < corners.size(); ++i)
        twice += (corners[i - 1] - corners[0]).cross(corners[i] - corners[0]);
    return twice;
}

// Four points of a convex quadrilateral, in any order, become its corners in order: of the three orders, an order that
// crosses have less area.
void order_corners(std::span<Flat> points) {
    if (points.size() < 4) return;
    const auto area = [&] { return std::abs(twice_area(points)); };
    double most = area();
    for (const auto& [i, k] : {std::pair(1, 2), {2, 3}}) {
        std::swap(points[std::size_t(i)], points[std::size_t(k)]);
        if (const double now = area(); now > most)
            most = now;
        else
            std::swap(points[std::size_t(i)], points[std::size_t(k)]);
    }
}

}  // namespace

ContactArea contact_area(std::span<const Vec3> polygon, const Vec3& normal) {
    return polygon_area(polygon.size(), normal, [&](std::size_t i) -> const Vec3& { return polygon[i]; });
}
ContactArea contact_area(std::span<const ContactPoint> polygon, const Vec3& normal) {
    return polygon_area(polygon.size(), normal, [&](std::size_t i) -> const Vec3& { return polygon[i].position; });
}

ContactArea contact_area(const Manifold& m) {
    ContactArea area;
    const auto count = std::size_t(m.count);
    double shares = 0.0, distance = 0.0;
    for (std::size_t i = 0; i < count; ++i) shares += double(m.share[i]);
    for (std::size_t i = 0; i < count; ++i) area.centroid += double(m.share[i]) / shares * m.points[i].position;
    const Plane plane(m.normal, area.centroid);
    for (std::size_t i = 0; i < count; ++i) {
        const Flat p = plane(m.points[i].position);
        distance += double(m.share[i]) / shares * std::sqrt(p.dot(p));
    }
    area.mean_distance = double(m.spread) * distance;
    area.size = double(m.area);
    return area;
}

double mean_distance(const Manifold& m, const Vec3& from) {
    const Plane plane(m.normal, from);
    std::array<Flat, Manifold::capacity> all{};
    const auto points = std::span(all).first(std::size_t(m.count));
    double shares = 0.0;
    Flat centroid{0.0, 0.0};
    for (std::size_t i = 0; i < points.size(); ++i) {
        const double share = double(m.share[i]);
        points[i] = plane(m.points[i].position);
        centroid.x += share * points[i].x;
        centroid.y += share * points[i].y;
        shares += share;
    }
    centroid = {centroid.x / shares, centroid.y / shares};
    order_corners(points);
    const double twice = twice_area(points), scale = std::sqrt(2.0 * double(m.area) / std::abs(twice));
    // The centroid of the points' own polygon.
    Flat own{0.0, 0.0};
    for (std::size_t i = 2; i < points.size(); ++i) {
        const Flat p = points[i - 1] - points[0], q = points[i] - points[0];
        const double part = p.cross(q) / (3.0 * twice);
        own.x += part * (p.x + q.x);
        own.y += part * (p.y + q.y);
    }
    own = {own.x + points[0].x, own.y + points[0].y};
    for (Flat& p : points) p = {centroid.x + scale * (p.x - own.x), centroid.y + scale * (p.y - own.y)};
    double distance = 0.0;
    for (std::size_t i = 0; i < points.size(); ++i)
        distance += distance_integral(points[i], points[(i + 1) % points.size()]);
    return distance / (0.5 * scale * scale * twice);
}

// Shares 1 + (arm . slope), with arms from the mean of the points, such that their centroid is that of the area: of all
// such shares those nearest to 1. slope = -S^-1 mean, with S the second moments of the arms. Across a line of points
// the slope is zero.
void spread_pressure(const ContactArea& area, Manifold& m) {
    m.share.fill(1.0f);
    m.spread = 1.0f;
    m.area = float(area.size);
    const auto count = std::size_t(m.count);
    if (count < 2) return;
    const Plane plane(m.normal, area.centroid);
    const double each = 1.0 / double(count);
    std::array<Flat, Manifold::capacity> arm{};
    Flat mean{0.0, 0.0};
    for (std::size_t i = 0; i < count; ++i) {
        arm[i] = plane(m.points[i].position);
        mean.x += each * arm[i].x;
        mean.y += each * arm[i].y;
    }
    double xx = 0.0, xy = 0.0, yy = 0.0;
    for (std::size_t i = 0; i < count; ++i) {
        arm[i] = arm[i] - mean;
        xx += each * arm[i].x * arm[i].x;
        xy += each * arm[i].x * arm[i].y;
        yy += each * arm[i].y * arm[i].y;
    }
    const double determinant = xx * yy - xy * xy, trace = xx + yy;
    Flat slope{0.0, 0.0};
    if (determinant > narrow * narrow * trace * trace)
        slope = {(xy * mean.y - yy * mean.x) / determinant, (xy * mean.x - xx * mean.y) / determinant};
    double least = 1.0;
    for (std::size_t i = 0; i < count; ++i) least = std::min(least, 1.0 + slope.dot(arm[i]));
    if (least < least_share) {
        const double part = (1.0 - least_share) / (1.0 - least);
        slope = {part * slope.x, part * slope.y};
    }
    std::array<double, Manifold::capacity> load;
    Flat center{0.0, 0.0};  // center of the load, relative to the mean of the points
    for (std::size_t i = 0; i < count; ++i) {
        const double share = 1.0 + slope.dot(arm[i]);
        m.share[i] = float(share);
        load[i] = each * share;
        center.x += load[i] * arm[i].x;
        center.y += load[i] * arm[i].y;
    }
    double distance = 0.0;
    for (std::size_t i = 0; i < count; ++i) {
        const Flat from = arm[i] - center;
        distance += load[i] * std::sqrt(from.dot(from));
    }
    // Where the center of the points differs from that of the area, friction at the offset resists a spin too.
    const Flat off{center.x + mean.x, center.y + mean.y};
    const double square = area.mean_distance * area.mean_distance - off.dot(off);
    if (distance > 0.0) m.spread = float(std::min(1.0, square > 0.0 ? std::sqrt(square) / distance : 0.0));
}

}  // namespace tumble
