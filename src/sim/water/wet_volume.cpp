#include "sim/water/wet_volume.h"

#include "core/deterministic_math.h"
#include "sim/water/gauss.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace tumble {
namespace {

/// Error of the integral along the axis of a curved body, over the whole: rounding of doubles.
constexpr double integral_tolerance = 1e-15;
constexpr int integral_halvings = 12;

/// Sums signed tetrahedra from the origin to triangles, of which only the part below the plane counts.
class ClippedSolid {
public:
    /// Corners by counterclockwise triangles seen from outside, with their heights over the plane.
    void add(const std::array<Vec3, 3>& p, const std::array<double, 3>& height) {
        std::array<Vec3, 4> kept;
        std::size_t count = 0;
        for (std::size_t i = 0; i < 3; ++i) {
            const std::size_t j = (i + 1) % 3;
            if (height[i] < 0.0) kept[count++] = p[i];
            if ((height[i] < 0.0) == (height[j] < 0.0)) continue;
            const std::size_t below = height[i] < 0.0 ? i : j, above = height[i] < 0.0 ? j : i;
            kept[count++] = p[below] + height[below] / (height[below] - height[above]) * (p[above] - p[below]);
        }
        for (std::size_t k = 2; k < count; ++k) add_tetrahedron(kept[0], kept[k - 1], kept[k]);
    }

    WetPart about(const Vec3& origin) const { return {volume_, moment_ + volume_ * origin}; }

private:
    void add_tetrahedron(const Vec3& a, const Vec3& b, const Vec3& c) {
        const double volume = a.dot(b.cross(c)) / 6.0;
        volume_ += volume;
        moment_ += 0.25 * volume * (a + b + c);
    }

    double volume_ = 0.0;
    Vec3 moment_ = Vec3::Zero();
};

/// `visit` calls its argument with the indices of three corners of each triangle.
template <class Visit>
WetPart clipped(const std::vector<Vec3>& vertices, const WaterPlane& plane, const Visit& visit) {
    double lowest = infinity, highest = -infinity;
    for (const Vec3& v : vertices) {
        const double height = plane.normal.dot(v) - plane.offset;
        lowest = std::min(lowest, height);
        highest = std::max(highest, height);
    }
    if (!(lowest < 0.0)) return {};
    // From a point on the plane, the face in the plane adds nothing; a body wholly below has no such face.
    const Vec3 origin = highest > 0.0 ? Vec3(plane.offset * plane.normal) : Vec3(Vec3::Zero());
    ClippedSolid solid;
    visit([&](std::uint32_t a, std::uint32_t b, std::uint32_t c) {
        const std::array<Vec3, 3> p{vertices[a] - origin, vertices[b] - origin, vertices[c] - origin};
        std::array<double, 3> height{-1.0, -1.0, -1.0};
        if (highest > 0.0)
            for (std::size_t k = 0; k < 3; ++k) height[k] = plane.normal.dot(p[k]);
        solid.add(p, height);
    });
    return solid.about(origin);
}

WetPart wet(const HalfSpace&, const WaterPlane&) { return {}; }
WetPart wet(const CollisionMesh&, const WaterPlane&) { return {}; }

/// The part of the unit ball below z = h: its volume, and its first moment along z.
std::array<double, 2> cap(double h) {
    if (h <= -1.0) return {0.0, 0.0};
    if (h >= 1.0) return {4.0 / 3.0 * pi, 0.0};
    const double over = 1.0 + h, under = 1.0 - h;
    return {pi / 3.0 * over * over * (2.0 - h), -0.25 * pi * over * over * under * under};
}

WetPart wet(const Ball& ball, const WaterPlane& plane) {
    const double r = ball.radius;
    const auto [volume, moment] = cap(plane.offset / r);
    return {volume * r * r * r, moment * r * r * r * r * plane.normal};
}

WetPart wet_ellipsoid(const Vec3& radii, const WaterPlane& plane) {
    const Vec3 stretched = radii.cwiseProduct(plane.normal);
    const double length = stretched.norm();
    const auto [volume, moment] = cap(plane.offset / length);
    return {volume * radii.prod(), moment * radii.prod() / length * radii.cwiseProduct(stretched)};
}

WetPart wet(const Polyhedron& hull, const WaterPlane& plane) {
    return clipped(hull.vertices, plane, [&](const auto& add) {
        for (const Polyhedron::Face& face : hull.faces)
            for (std::size_t k = 2; k < face.vertices.size(); ++k)
                add(face.vertices[0], face.vertices[k - 1], face.vertices[k]);
    });
}

/// Between two heights along the axis: of a ball about `middle`, or with the radius base + slope y.
struct Segment {
    double low = 0.0, high = 0.0;
    double base = 0.0, slope = 0.0;
    double ball = 0.0, middle = 0.0;

    double square_at(double y) const {
        if (ball > 0.0) return (ball - (y - middle)) * (ball + (y - middle));
        return (base + slope * y) * (base + slope * y);
    }
    /// Heights at which the plane across u + along y = offset touches the rim of a disc.
    std::array<double, 2> rims(double along, double across, double offset) const {
        std::array<double, 2> y;
        if (ball > 0.0) {
            const double over = offset - along * middle, square = (ball - over) * (ball + over);
            const double half = across * std::sqrt(std::max(0.0, square));
            y = {middle + along * over - half, middle + along * over + half};
        } else {
            y = {(offset - across * base) / (along + across * slope),
                 (offset + across * base) / (along - across * slope)};
        }
        if (y[0] > y[1]) std::swap(y[0], y[1]);
        return y;
    }
};

std::array<Segment, 3> segments_of(const CurvedBody& body) {
    const auto& [low, high] = body.discs;
    if (body.rounding > 0.0) {
        const double r = body.rounding;
        return {Segment{low.y - r, low.y, 0.0, 0.0, r, low.y}, Segment{low.y, high.y, r},
                Segment{high.y, high.y + r, 0.0, 0.0, r, high.y}};
    }
    const double slope = (high.radius - low.radius) / (high.y - low.y);
    return {Segment{low.y, high.y, low.radius - slope * low.y, slope}, Segment{}, Segment{}};
}

/// Integrals of a segment along the axis: of the wet area, of its moments along and across the axis.
using Sums = Eigen::Array3d;

/// The plane is across u + along y < offset, with u across the axis; across > 0.
Sums wet_sums(const Segment& segment, double along, double across, double offset, double tolerance) {
    const auto chord_at = [&](double y) { return (offset - along * y) / across; };
    const auto disc = [&](double y) -> Sums { return pi * std::max(0.0, segment.square_at(y)) * Sums(1.0, y, 0.0); };
    const auto part = [&](double y) -> Sums {
        const double square = segment.square_at(y), s = chord_at(y), under = square - s * s;
        if (!(under > 0.0)) return s > 0.0 ? disc(y) : Sums(Sums::Zero());
        const double half = std::sqrt(under), area = square * (0.5 * pi + atan2_stable(s, half)) + s * half;
        return {area, y * area, -2.0 / 3.0 * under * half};
    };
    std::array<double, 4> ends{segment.low};
    std::size_t used = 1;
    for (const double y : segment.rims(along, across, offset))  // NaN where the plane is parallel to the side
        if (y > ends[used - 1] && y < segment.high) ends[used++] = y;
    ends[used] = segment.high;
    Sums sum = Sums::Zero();
    for (std::size_t k = 0; k < used; ++k) {
        const double low = ends[k], length = ends[k + 1] - low, middle = low + 0.5 * length, s = chord_at(middle);
        if (!(segment.square_at(middle) > s * s)) {
            if (s > 0.0) sum += gauss<Sums>(low, ends[k + 1], disc);
            continue;
        }
        // At the ends the area has terms of the power 3/2: smooth in t of y = low + length t^2 (3 - 2 t).
        const auto smooth = [&](double t) -> Sums {
            return 6.0 * length * t * (1.0 - t) * part(low + length * t * t * (3.0 - 2.0 * t));
        };
        sum += adaptive_gauss<Sums>(0.0, 1.0, gauss<Sums>(0.0, 1.0, smooth), tolerance, integral_halvings, smooth);
    }
    return sum;
}

WetPart wet(const CurvedBody& body, const WaterPlane& plane) {
    if (body.ellipsoid) return wet_ellipsoid(body.radii, plane);
    const double far = body.extent(plane.normal), near = -body.extent(-plane.normal);
    if (near >= plane.offset) return {};
    // A plane beyond the body leaves all of it wet; one across the axis has a chord far away.
    const double offset = std::min(plane.offset, far + body.radius);
    const double out = std::sqrt(plane.normal.x() * plane.normal.x() + plane.normal.z() * plane.normal.z());
    const Vec3 u = out > 0.0 ? Vec3(plane.normal.x() / out, 0.0, plane.normal.z() / out) : Vec3(Vec3::UnitX());
    const double tolerance = integral_tolerance * body.radius * body.radius * body.radius * std::min(1.0, body.radius);
    Sums sum = Sums::Zero();
    for (const Segment& segment : segments_of(body))
        if (segment.high > segment.low)
            sum += wet_sums(segment, plane.normal.y(), std::max(out, 1e-30), offset, tolerance);
    return {sum[0], sum[1] * Vec3::UnitY() + sum[2] * u};
}

WetPart wet(const Compound& compound, const WaterPlane& plane) {
    WetPart sum;
    for (const Compound::Part& part : compound.parts) {
        const WetPart one = wet_part(part.collider, seen_from(part.place, plane));
        sum.volume += one.volume;
        sum.moment += one.volume * part.place.position + part.place.rotation * one.moment;
    }
    return sum;
}

}  // namespace

WetPart wet_part(const CollisionShape& shape, const WaterPlane& plane) {
    return std::visit([&](const auto& held) { return wet(collider_in(held), plane); }, shape);
}

WetPart wet_part(const TriangleMesh& mesh, const WaterPlane& plane) {
    return clipped(mesh.vertices, plane, [&](const auto& add) {
        for (const auto& [a, b, c] : mesh.triangles) add(a, b, c);
    });
}

}  // namespace tumble
