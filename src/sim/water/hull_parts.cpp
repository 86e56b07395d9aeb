#include "sim/water/hull_parts.h"

#include "core/deterministic_math.h"
#include "sim/water/wet_volume.h"

#include <cmath>
#include <utility>

namespace tumble {
namespace {

/// Heights and radii of rings from the lower end of a surface of revolution to the upper one. An ellipsoid: of the
/// unit circle times its height.
std::vector<std::pair<double, double>> rings_of(const CurvedBody& body, int to_end) {
    std::vector<std::pair<double, double>> rings;
    const auto& [low, high] = body.discs;
    if (!body.ellipsoid && body.rounding == 0.0)
        return {{low.y, 0.0}, {low.y, low.radius}, {high.y, high.radius}, {high.y, 0.0}};
    const double r = body.ellipsoid ? 1.0 : body.rounding;
    for (int k = -to_end; k <= to_end; ++k) {
        const SinCos turn = sincos(0.5 * pi * k / to_end);
        const double middle = k < 0 ? low.y : high.y, out = std::abs(k) == to_end ? 0.0 : r * turn.cos;
        if (body.ellipsoid) {
            rings.emplace_back(body.radii.y() * turn.sin, out);
            continue;
        }
        if (k == 0) rings.emplace_back(low.y, r);
        rings.emplace_back(middle + r * turn.sin, out);
    }
    return rings;
}

std::vector<std::pair<double, double>> rings_of(double ball, int to_end) {
    std::vector<std::pair<double, double>> rings;
    for (int k = -to_end; k <= to_end; ++k) {
        const SinCos turn = sincos(0.5 * pi * k / to_end);
        rings.emplace_back(ball * turn.sin, std::abs(k) == to_end ? 0.0 : ball * turn.cos);
    }
    return rings;
}

double area_of(const std::vector<Vec3>& vertices, const std::vector<std::array<std::uint32_t, 3>>& triangles) {
    double sum = 0.0;
    for (const auto& [a, b, c] : triangles)
        sum += 0.5 * (vertices[b] - vertices[a]).cross(vertices[c] - vertices[a]).norm();
    return sum;
}

double volume_of(const HullPart& part) {
    double sum = 0.0;
    for (const auto& [a, b, c] : part.triangles)
        sum += part.vertices[a].dot(part.vertices[b].cross(part.vertices[c])) / 6.0;
    return sum;
}

/// Closes the rings by triangles. `rx`, `rz`: of the radius along these axes.
void wrap(HullPart& part, const std::vector<std::pair<double, double>>& rings, double rx, double rz, int around) {
    const auto sides = std::uint32_t(around);
    for (const auto& [y, r] : rings)
        for (int k = 0; k < around; ++k) {
            const SinCos turn = sincos(2.0 * pi * k / around);
            part.vertices.push_back({rx * r * turn.cos, y, rz * r * turn.sin});
        }
    for (std::uint32_t ring = 0; ring + 1 < rings.size(); ++ring)
        for (std::uint32_t k = 0; k < sides; ++k) {
            const std::uint32_t next = (k + 1) % sides, low = ring * sides, high = low + sides;
            if (rings[ring].second > 0.0) part.triangles.push_back({low + k, high + k, low + next});
            if (rings[ring + 1].second > 0.0) part.triangles.push_back({low + next, high + k, high + next});
        }
}

/// Moves the triangles away from the axis until they enclose the volume.
void fill(HullPart& part, double volume) {
    const double out = std::sqrt(volume / volume_of(part));
    for (Vec3& v : part.vertices) v = Vec3(out * v.x(), v.y(), out * v.z());
}

void add(std::vector<HullPart>& parts, const CollisionShape& shape, const Pose& place, const Facets& facets) {
    if (const auto* compound = std::get_if<std::shared_ptr<const Compound>>(&shape)) {
        for (const Compound::Part& part : (*compound)->parts) add(parts, part.collider, part_pose(place, part), facets);
        return;
    }
    HullPart part;
    part.center = place.position;
    if (const auto* ball = std::get_if<Ball>(&shape)) {
        part.ball = ball->radius;
        if (facets.by_volume) {
            wrap(part, rings_of(part.ball, facets.rings), 1.0, 1.0, facets.sides);
            fill(part, 4.0 / 3.0 * pi * part.ball * part.ball * part.ball);
            part.scale = 4.0 * pi * part.ball * part.ball / area_of(part.vertices, part.triangles);
        }
    } else if (const auto* hull = std::get_if<std::shared_ptr<const Polyhedron>>(&shape)) {
        part.vertices = (*hull)->vertices;
        for (const Polyhedron::Face& face : (*hull)->faces)
            for (std::size_t k = 2; k < face.vertices.size(); ++k)
                part.triangles.push_back({face.vertices[0], face.vertices[k - 1], face.vertices[k]});
    } else if (const auto* curved = std::get_if<std::shared_ptr<const CurvedBody>>(&shape)) {
        const CurvedBody& body = **curved;
        const double rx = body.ellipsoid ? body.radii.x() : 1.0, rz = body.ellipsoid ? body.radii.z() : 1.0;
        if (rx == rz) part.axis = place.rotation * Vec3::UnitY();
        wrap(part, rings_of(body, facets.rings), rx, rz, facets.sides);
        if (facets.by_volume) fill(part, wet_part(shape, {Vec3::UnitY(), 2.0 * body.radius}).volume);
        part.scale = 4.0 * body.mean_projected_area() / area_of(part.vertices, part.triangles);
    } else {
        return;
    }
    for (Vec3& v : part.vertices) v = place.to_world(v);
    parts.push_back(std::move(part));
}

}  // namespace

std::vector<HullPart> hull_parts(const CollisionShape& shape, const Facets& facets) {
    std::vector<HullPart> parts;
    add(parts, shape, {}, facets);
    return parts;
}

}  // namespace tumble
