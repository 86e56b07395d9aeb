#include "render/shapes/ray_depths.h"

#include "core/cpu_dispatch.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace tumble {
namespace {

constexpr double none = std::numeric_limits<double>::infinity();

// Compile to single instructions, unlike std::min and std::max, which take references.
inline double smaller(double a, double b) { return a < b ? a : b; }
inline double larger(double a, double b) { return a > b ? a : b; }

/// One pair of parallel faces of a box.
struct Slab {
    double along_x, along_row;  // the ray's component across the slab: along_x x + along_row
    double first, last;         // distances of the faces from the eye
};

TUMBLE_WIDE void slab_depths(const std::array<Slab, 3>& slabs, const double* x, std::size_t count, double* depths) {
    const Slab a = slabs[0], b = slabs[1], c = slabs[2];
    for (std::size_t i = 0; i < count; ++i) {
        // Kay and Kajiya 1986, Ray Tracing Complex Scenes: a ray hits if it enters the last slab before it leaves the
        // first. For a ray parallel to a slab, division by zero gives infinities that compare correctly.
        const double to_a = 1.0 / (a.along_x * x[i] + a.along_row);
        const double to_b = 1.0 / (b.along_x * x[i] + b.along_row);
        const double to_c = 1.0 / (c.along_x * x[i] + c.along_row);
        const double a1 = a.first * to_a, a2 = a.last * to_a;
        const double b1 = b.first * to_b, b2 = b.last * to_b;
        const double c1 = c.first * to_c, c2 = c.last * to_c;
        const double in = larger(larger(smaller(a1, a2), smaller(b1, b2)), smaller(c1, c2));
        const double out = smaller(smaller(larger(a1, a2), larger(b1, b2)), larger(c1, c2));
        const double depth = in <= out ? in : none;
        depths[i] = depth > 0.0 ? depth : none;  // behind the eye, or the eye is inside
    }
}

/// A ball; or an infinite cylinder, after removal of the ray's component along its axis.
struct Round {
    Vec3 center;  // of the cylinder: the point of its axis nearest to the eye
    Vec3 axis;    // unit; zero: a ball
    double radius_squared;
    double outside;  // squared distance of the center, less the squared radius
};

TUMBLE_WIDE void round_depths(const Round& shape, const double* xs, double ray_y, std::size_t count, double* depths) {
    const double cx = shape.center.x(), cy = shape.center.y(), cz = shape.center.z();
    const double ax = shape.axis.x(), ay = shape.axis.y(), az = shape.axis.z();
    const double radius_squared = shape.radius_squared, outside = shape.outside;
    for (std::size_t i = 0; i < count; ++i) {
        const double along = ax * xs[i] + ay * ray_y + az;
        const double x = xs[i] - along * ax, y = ray_y - along * ay, z = 1.0 - along * az;
        // Haines et al. 2019, Precision Improvements for Ray/Sphere Intersection: the distance of the center from the
        // ray instead of a difference of large squares, and the quotient without cancellation.
        const double squared = x * x + y * y + z * z;
        const double towards = cx * x + cy * y + cz * z;
        const double nearest = towards / squared;
        const double qx = cx - nearest * x, qy = cy - nearest * y, qz = cz - nearest * z;
        const double inside = radius_squared - (qx * qx + qy * qy + qz * qz);
        const double depth = outside / (towards + std::sqrt(squared * larger(inside, 0.0)));
        const double hit = inside >= 0.0 ? depth : none;
        depths[i] = towards > 0.0 ? hit : none;
    }
}

TUMBLE_WIDE void plane_row(double along_x, double along_row, double height, const double* x, std::size_t count,
                           double* depths) {
    for (std::size_t i = 0; i < count; ++i) {
        const double fall = -(along_x * x[i] + along_row);
        const double depth = height / fall;
        depths[i] = fall > 0.0 ? depth : none;
    }
}

void fill_none(const RayRow& rays, double* depths) { std::fill_n(depths, rays.count, none); }

}  // namespace

std::array<Vec3, 8> corners_of(const PartPlace& place, const Vec3& half_size) {
    std::array<Vec3, 8> corners;
    for (std::size_t i = 0; i < 8; ++i) {
        const Vec3 sides((i & 1) != 0 ? 1.0 : -1.0, (i & 2) != 0 ? 1.0 : -1.0, (i & 4) != 0 ? 1.0 : -1.0);
        corners[i] = place.origin + place.axes * half_size.cwiseProduct(sides);
    }
    return corners;
}

void box_depths(const PartPlace& place, const Vec3& half_size, const RayRow& rays, double* depths) {
    std::array<Slab, 3> slabs;
    for (int k = 0; k < 3; ++k) {
        const Vec3 axis = place.axes.col(k);
        const double middle = axis.dot(place.origin);
        slabs[std::size_t(k)] = {axis.x(), axis.y() * rays.y + axis.z(), middle - half_size[k], middle + half_size[k]};
    }
    slab_depths(slabs, rays.x, rays.count, depths);
}

void ball_depths(const Vec3& center, double radius, const RayRow& rays, double* depths) {
    const double distance = center.norm();
    if (!(distance > radius)) return fill_none(rays, depths);
    round_depths({center, Vec3::Zero(), radius * radius, (distance - radius) * (distance + radius)}, rays.x, rays.y,
                 rays.count, depths);
}

void plane_depths(const Vec3& normal, double height, const RayRow& rays, double* depths) {
    if (!(height > 0.0)) return fill_none(rays, depths);
    plane_row(normal.x(), normal.y() * rays.y + normal.z(), height, rays.x, rays.count, depths);
}

void cord_depths(const CordPlace& place, double radius, const RayRow& rays, double* depths) {
    const double length = (place.to - place.from).norm();
    if (!(length > 0.0)) return fill_none(rays, depths);
    const Vec3 axis = (place.to - place.from) / length;
    const double start = axis.dot(place.from);
    const Vec3 center = place.from - start * axis;
    const double distance = center.norm();
    if (distance > radius) {
        round_depths({center, axis, radius * radius, (distance - radius) * (distance + radius)}, rays.x, rays.y,
                     rays.count, depths);
    } else {
        fill_none(rays, depths);
    }
    for (std::size_t i = 0; i < rays.count; ++i) {
        if (depths[i] == none) continue;
        const double along = depths[i] * (axis.x() * rays.x[i] + axis.y() * rays.y + axis.z()) - start;
        if (!(along >= 0.0 && along <= length)) depths[i] = none;
    }
    // The end that faces the camera.
    if (start <= 0.0 && start + length >= 0.0) return;
    const Vec3& end = start > 0.0 ? place.from : place.to;
    for (std::size_t i = 0; i < rays.count; ++i) {
        const Vec3 ray(rays.x[i], rays.y, 1.0);
        const double depth = axis.dot(end) / axis.dot(ray);
        if (depth > 0.0 && (depth * ray - end).squaredNorm() <= radius * radius) depths[i] = std::min(depths[i], depth);
    }
}

Vec3 cord_normal(const CordPlace& place, const Vec3& point) {
    const Vec3 axis = (place.to - place.from).normalized();
    const Vec3 out = point - place.from;
    const double length = (place.to - place.from).norm(), along = axis.dot(out), near = 1e-9 * length;
    if (along <= near || along >= length - near) return along <= near ? Vec3(-axis) : axis;
    return (out - axis.dot(out) * axis).normalized();
}

}  // namespace tumble
