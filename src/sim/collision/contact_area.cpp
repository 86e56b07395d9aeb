#include "sim/collision/contact_area.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace tumble {
namespace {

// A polygon narrower than this part of its length is a line: its area is rounding.
constexpr double narrow = 1e-6;
// Least share of a point. Shares that would be less than that, of points all on one side of the area, are drawn towards 1.
constexpr double least_share = 0.1;

Vec3 across(const Vec3& normal, const Vec3& v) { return v - normal.dot(v) * normal; }

// The integral of sqrt(h^2 + x^2) over x from 0 to s: Gauss and Legendre's three points, within 2e-3 for any s / h and exact for the
// ends s << h and s >> h.
double distance_integral(double square, double s) {
    constexpr double near = 0.11270166537925831, far = 1.0 - near;
    const auto at = [&](double part) { return std::sqrt(square + part * part * s * s); };
    return s * ((5.0 / 18.0) * (at(near) + at(far)) + (8.0 / 18.0) * at(0.5));
}

// The integral of the distance from the origin over the triangle (0, p, q): distance grows in proportion to the way out, so it is a
// third of the height over pq times the integral along pq, split at the foot of the height.
double distance_integral(const Vec3& p, const Vec3& q, const Vec3& normal) {
    const Vec3 edge = q - p;
    const double length = edge.norm();
    if (!(length > 0.0)) return 0.0;
    const double height = normal.dot(p.cross(q)) / length, from = p.dot(edge) / length;
    const double square = height * height;
    return height / 3.0 * (distance_integral(square, from + length) - distance_integral(square, from));
}

ContactArea line_area(const Vec3& tail, const Vec3& head) { return {0.5 * (tail + head), 0.25 * (head - tail).norm()}; }

template <class At>
ContactArea polygon_area(std::size_t count, const Vec3& normal, At&& at) {
    if (count < 2) return {count == 0 ? Vec3(Vec3::Zero()) : at(0), 0.0};
    const Vec3 origin = at(0);   // sums from here: digits far from the world's origin
    const auto corner = [&](std::size_t i) { return across(normal, at(i < count ? i : i - count) - origin); };
    double twice = 0.0;   // the area, signed
    Vec3 moment = Vec3::Zero();
    std::size_t farthest = 0;
    for (std::size_t i = 0; i < count; ++i) {
        const Vec3 p = corner(i), q = corner(i + 1);
        const double part = normal.dot(p.cross(q));
        twice += part;
        moment += part * (p + q);
        if (p.squaredNorm() > corner(farthest).squaredNorm()) farthest = i;
    }
    const Vec3 far = corner(farthest);
    if (std::abs(twice) <= narrow * far.squaredNorm()) {
        // The corner farthest from the one farthest from the first: the line's other end.
        std::size_t other = 0;
        for (std::size_t i = 1; i < count; ++i)
            if ((corner(i) - far).squaredNorm() > (corner(other) - far).squaredNorm()) other = i;
        return line_area(origin + far, origin + corner(other));
    }
    const Vec3 centroid = moment / (3.0 * twice);
    double distance = 0.0;
    for (std::size_t i = 0; i < count; ++i) distance += distance_integral(corner(i) - centroid, corner(i + 1) - centroid, normal);
    return {origin + centroid, distance / (0.5 * twice)};
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
    double shares = 0.0, distance = 0.0;
    for (std::size_t i = 0; i < std::size_t(m.count); ++i) shares += double(m.share[i]);
    for (std::size_t i = 0; i < std::size_t(m.count); ++i) area.centroid += double(m.share[i]) / shares * m.points[i].position;
    for (std::size_t i = 0; i < std::size_t(m.count); ++i)
        distance += double(m.share[i]) / shares * across(m.normal, m.points[i].position - area.centroid).norm();
    area.mean_distance = double(m.spread) * distance;
    return area;
}

void spread_pressure(const ContactArea& area, Manifold& m) {
    m.share.fill(1.0f);
    m.spread = 1.0f;
    const auto count = std::size_t(m.count);
    if (count < 2) return;
    std::array<Vec3, Manifold::capacity> arm;
    Vec3 mean = Vec3::Zero();
    for (std::size_t i = 0; i < count; ++i) mean += across(m.normal, m.points[i].position - area.centroid) / double(count);
    // Shares 1 + (arm . slope) with the centroid for their mean: those nearest to all alike. slope = -S^-1 mean, S the arms' second moments;
    // across a line of points there is nothing to be gained.
    const Vec3 first = m.normal.unitOrthogonal(), second = m.normal.cross(first);
    double xx = 0.0, xy = 0.0, yy = 0.0;
    for (std::size_t i = 0; i < count; ++i) {
        arm[i] = across(m.normal, m.points[i].position - area.centroid) - mean;
        const double x = first.dot(arm[i]), y = second.dot(arm[i]);
        xx += x * x / double(count);
        xy += x * y / double(count);
        yy += y * y / double(count);
    }
    const double x = first.dot(mean), y = second.dot(mean), determinant = xx * yy - xy * xy, trace = xx + yy;
    Vec3 slope = Vec3::Zero();
    if (determinant > narrow * narrow * trace * trace) slope = ((xy * y - yy * x) * first + (xy * x - xx * y) * second) / determinant;
    double least = 1.0;
    for (std::size_t i = 0; i < count; ++i) least = std::min(least, 1.0 + slope.dot(arm[i]));
    if (least < least_share) slope *= (1.0 - least_share) / (1.0 - least);
    double distance = 0.0;
    Vec3 center = Vec3::Zero();
    for (std::size_t i = 0; i < count; ++i) {
        const double share = 1.0 + slope.dot(arm[i]);
        m.share[i] = float(share);
        center += share / double(count) * arm[i];
    }
    for (std::size_t i = 0; i < count; ++i) distance += (1.0 + slope.dot(arm[i])) / double(count) * (arm[i] - center).norm();
    // Where the points' own centre is off the area's, the friction there resists a spin too.
    const double off = (center + mean).norm(), square = area.mean_distance * area.mean_distance - off * off;
    if (distance > 0.0) m.spread = float(std::min(1.0, square > 0.0 ? std::sqrt(square) / distance : 0.0));
}

}  // namespace tumble
