#include "sim/fields/explosions.h"

#include "core/deterministic_math.h"
#include "sim/geometry/shapes/compound.h"
#include "sim/geometry/shapes/curved.h"
#include "sim/geometry/shapes/hull.h"
#include "sim/geometry/shapes/sphere.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <span>

namespace tumble {
namespace {

/// Planes around a body that is no polyhedron: the polygon that they bound is larger by the share 3e-4.
constexpr int outline_planes = 128;

/// Halvings of the angle of such a plane: to rounding.
constexpr int halvings = 60;

/// Steps of the search for a plane between the center and a body: a body so near that it has no such plane counts as
/// one that the center is in.
constexpr int most_steps = 200;

/// Integral of the unit directions over the solid angle of a polygon, counterclockwise about these directions.
Vec3 integral_over(std::span<const Vec3> corners) {
    Vec3 sum = Vec3::Zero();
    for (std::size_t k = 0; k < corners.size(); ++k) {
        const Vec3 &a = corners[k], &b = corners[(k + 1) % corners.size()], normal = a.cross(b);
        const double sine = normal.norm();
        if (sine > 0.0) sum += 0.5 * atan2_stable(sine, a.dot(b)) / sine * normal;
    }
    return sum;
}

/// The farthest point along a direction, less the center; m, world axes.
Vec3 farthest(const CollisionShape& shape, const Pose& pose, const Vec3& direction) {
    if (const auto* hull = std::get_if<std::shared_ptr<const Polyhedron>>(&shape))
        return pose.to_world((*hull)->vertices[(*hull)->support(pose.rotation.transpose() * direction)]);
    if (const auto* curved = std::get_if<std::shared_ptr<const CurvedBody>>(&shape))
        return pose.to_world((*curved)->support(pose.rotation.transpose() * direction)) +
               (*curved)->rounding * direction;
    if (const auto* compound = std::get_if<std::shared_ptr<const Compound>>(&shape)) {
        Vec3 best = Vec3::Zero();
        double most = -infinity;
        for (const Compound::Part& part : (*compound)->parts) {
            const Vec3 point = farthest(part.collider, part_pose(pose, part), direction);
            if (direction.dot(point) <= most) continue;
            most = direction.dot(point);
            best = point;
        }
        return best;
    }
    const auto* ball = std::get_if<Ball>(&shape);
    return ball ? Vec3(pose.position + ball->radius * direction) : pose.position;
}

/// A direction along which all of the body lies ahead of the origin (Gilbert 1966); none where the origin is inside.
std::optional<Vec3> axis_to(const CollisionShape& shape, const Pose& pose) {
    Vec3 nearest = pose.position;
    for (int step = 0; step < most_steps; ++step) {
        const double length = nearest.norm();
        if (!(length > 0.0)) return std::nullopt;
        const Vec3 point = farthest(shape, pose, -nearest / length);
        if (nearest.dot(point) > 0.0) return nearest / length;
        // The nearest point of the segment from `nearest` to `point`.
        const Vec3 along = point - nearest;
        nearest += std::clamp(-nearest.dot(along) / along.squaredNorm(), 0.0, 1.0) * along;
    }
    return std::nullopt;
}

/// Over the faces that the origin sees.
Vec3 seen(const Polyhedron& hull, const Pose& pose) {
    const Vec3 eye = pose.to_body(Vec3::Zero());
    Vec3 sum = Vec3::Zero();
    std::vector<Vec3> corners;
    for (const Polyhedron::Face& face : hull.faces) {
        if (!(face.normal.dot(eye) > face.offset)) continue;
        corners.clear();
        for (const std::uint32_t vertex : face.vertices) corners.push_back(pose.to_world(hull.vertices[vertex]));
        sum += integral_over(corners);
    }
    return -sum;  // the corners of a face are clockwise about the directions to it
}

/// Over the cone between planes through the origin that touch the body.
Vec3 seen(const CollisionShape& shape, const Pose& pose) {
    const std::optional<Vec3> axis = axis_to(shape, pose);
    if (!axis) return Vec3::Zero();
    const Vec3 u = axis->unitOrthogonal(), v = axis->cross(u);
    std::array<Vec3, outline_planes> normals, corners;
    for (int k = 0; k < outline_planes; ++k) {
        const SinCos around = sincos(2.0 * pi * k / outline_planes);
        const Vec3 outwards = around.cos * u + around.sin * v;
        // The normal turns from the axis, where the body is ahead, to its opposite.
        double low = -0.5 * pi, high = 0.5 * pi;
        for (int n = 0; n < halvings; ++n) {
            const double middle = 0.5 * (low + high);
            const SinCos tilt = sincos(middle);
            const Vec3 normal = tilt.cos * outwards - tilt.sin * *axis;
            (normal.dot(farthest(shape, pose, normal)) > 0.0 ? low : high) = middle;
        }
        const SinCos tilt = sincos(low);
        normals[std::size_t(k)] = tilt.cos * outwards - tilt.sin * *axis;
    }
    for (std::size_t k = 0; k < outline_planes; ++k)
        corners[k] = normals[k].cross(normals[(k + 1) % outline_planes]).normalized();
    return integral_over(corners);
}

}  // namespace

Explosions::Explosions(const std::vector<ExplosionDescription>& explosions, const Vec3& origin)
    : explosions_(explosions) {
    for (ExplosionDescription& explosion : explosions_) explosion.center -= origin;
}

std::vector<ExplosionDescription> Explosions::within(double from, double to) const {
    std::vector<ExplosionDescription> found;
    for (const ExplosionDescription& explosion : explosions_)
        if (explosion.time >= from && explosion.time < to) found.push_back(explosion);
    return found;
}

Vec3 impulse_of(const ExplosionDescription& explosion, const CollisionShape& shape, const Pose& pose) {
    const Pose from_center{pose.position - explosion.center, pose.rotation};
    const double distance = from_center.position.norm();
    if (!(distance < explosion.radius)) return Vec3::Zero();
    const double left = 1.0 - distance / explosion.radius * (distance / explosion.radius);
    Vec3 integral = Vec3::Zero();
    if (const auto* ball = std::get_if<Ball>(&shape)) {
        const double sine = ball->radius / distance;
        if (sine < 1.0) integral = pi * sine * sine / distance * from_center.position;
    } else if (const auto* hull = std::get_if<std::shared_ptr<const Polyhedron>>(&shape)) {
        integral = seen(**hull, from_center);
    } else {
        integral = seen(shape, from_center);
    }
    return explosion.impulse * left * left / (4.0 * pi) * integral;
}

}  // namespace tumble
