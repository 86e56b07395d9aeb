#include "sim/water/drag_surface.h"

#include "core/deterministic_math.h"
#include "sim/water/gauss.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace tumble {
namespace {

/// Error of the area that a ball shows, over its square radius: far below the error of the law of drag.
constexpr double ball_tolerance = 1e-12;

/// Dunavant 1985: six points on a triangle, exact for polynomials of the fourth degree.
struct TrianglePoint {
    double near, far, weight;  // two equal coordinates, the third one, share of the area
};
constexpr std::array<TrianglePoint, 2> triangle_rule{
    TrianglePoint{0.44594849091596488632, 0.10810301816807022736, 0.22338158967801146570},
    TrianglePoint{0.09157621350977074346, 0.81684757298045851308, 0.10995174365532186764}};

struct Element {
    const FlowPast& flow;
    const Vec3 &center, &axis;
    double share;
    DragIntegral sum;

    void add(const Vec3& a, const Vec3& b, const Vec3& c) {
        const Vec3 area = 0.5 * (b - a).cross(c - a);
        if (!(area.squaredNorm() > 0.0)) return;
        for (const TrianglePoint& p : triangle_rule)
            for (const Vec3& at : {Vec3(p.far * a + p.near * (b + c)), Vec3(p.far * b + p.near * (c + a)),
                                   Vec3(p.far * c + p.near * (a + b))}) {
                const Vec3 w = flow.velocity + flow.angular_velocity.cross(at);
                // Turning about its own axis moves no surface of revolution through the water.
                const Vec3 past = w - flow.angular_velocity.dot(axis) * axis.cross(at - center);
                const Vec3 f = element_drag(0.5 * p.weight, area, share, w, past);
                sum.force += f;
                sum.torque += at.cross(f);
            }
    }
};

/// Area that the part of the unit ball below z = h shows along a direction at an angle from z with that cosine.
double shown_area(double h, double cosine) {
    if (h >= 1.0) return pi;
    if (h <= -1.0) return 0.0;
    const double c = std::min(1.0, std::abs(cosine)), s = std::sqrt(std::max(0.0, 1.0 - c * c));
    using One = Eigen::Array<double, 1, 1>;
    const auto ring = [&](double z) -> One {  // integral of |n . d| around it
        const double a = std::abs(z) * c, b = std::sqrt(std::max(0.0, 1.0 - z * z)) * s;
        if (a >= b) return One(2.0 * pi * a);
        const double under = std::sqrt((b - a) * (b + a));
        return One(4.0 * (under + a * atan2_stable(a, under)));
    };
    std::array<double, 5> ends{-1.0, -s, 0.0, s, 1.0};
    double sum = 0.0;
    for (std::size_t k = 0; k + 1 < ends.size() && ends[k] < h; ++k) {
        const double low = ends[k], length = std::min(ends[k + 1], h) - low;
        const auto smooth = [&](double t) -> One {
            return 6.0 * length * t * (1.0 - t) * ring(low + length * t * t * (3.0 - 2.0 * t));
        };
        sum += adaptive_gauss<One>(0.0, 1.0, gauss<One>(0.0, 1.0, smooth), ball_tolerance, 6, smooth)[0];
    }
    return 0.5 * (sum + pi * (1.0 - h * h) * c);
}

constexpr Facets drag_facets{16, 4, false};

}  // namespace

DragSurface::DragSurface(const CollisionShape& shape) : parts_(hull_parts(shape, drag_facets)) {}

DragIntegral DragSurface::drag_of(const HullPart& part, const WaterPlane& plane, const FlowPast& flow) const {
    Element element{flow, part.center, part.axis, drag_share(part), {}};
    if (part.ball > 0.0) {
        const double r = part.ball, height = (plane.offset - plane.normal.dot(part.center)) / r;
        const Vec3 w = flow.velocity + flow.angular_velocity.cross(part.center);
        const double speed = w.norm();
        if (height > -1.0 && height < 1.0) {
            element.sum.plane = pi * r * r * (1.0 - height * height);
            const Vec3 middle = part.center + height * r * plane.normal;
            element.sum.plane_moment = element.sum.plane * middle;
            const double quarter = 0.25 * r * r * (1.0 - height * height);
            const Vec3 across = flow.angular_velocity - plane.normal.dot(flow.angular_velocity) * plane.normal;
            const double sinks = plane.normal.dot(flow.velocity + flow.angular_velocity.cross(middle));
            element.sum.heave = element.sum.plane * sinks * plane.normal;
            element.sum.roll = middle.cross(element.sum.heave) + element.sum.plane * quarter * across;
        }
        if (!(speed > 0.0)) return element.sum;
        element.sum.force = r * r * shown_area(height, plane.normal.dot(w) / speed) * speed * w;
        element.sum.torque = part.center.cross(element.sum.force);
        return element.sum;
    }
    bool cut = false;
    Vec3 first = Vec3::Zero();
    double area = 0.0;
    Vec3 moment = Vec3::Zero(), heave = Vec3::Zero(), roll = Vec3::Zero();
    for (const auto& triangle : part.triangles) {
        std::array<Vec3, 4> kept;
        std::size_t count = 0;
        Vec3 enters = Vec3::Zero(), leaves = Vec3::Zero();
        bool crosses = false;
        for (std::size_t i = 0; i < 3; ++i) {
            const Vec3 &p = part.vertices[triangle[i]], &q = part.vertices[triangle[(i + 1) % 3]];
            const double at_p = plane.normal.dot(p) - plane.offset, at_q = plane.normal.dot(q) - plane.offset;
            if (at_p < 0.0) kept[count++] = p;
            if ((at_p < 0.0) == (at_q < 0.0)) continue;
            crosses = true;
            const Vec3 crossing =
                at_p < 0.0 ? Vec3(p + at_p / (at_p - at_q) * (q - p)) : Vec3(q + at_q / (at_q - at_p) * (p - q));
            (at_p < 0.0 ? leaves : enters) = crossing;
            kept[count++] = crossing;
        }
        for (std::size_t k = 2; k < count; ++k) element.add(kept[0], kept[k - 1], kept[k]);
        if (!crosses) continue;
        if (!cut) first = enters;
        cut = true;
        element.add(first, enters, leaves);  // of the face in the plane of the water
        const double piece = 0.5 * (enters - first).cross(leaves - first).norm();
        area += piece;
        moment += piece / 3.0 * (first + enters + leaves);
        for (const Vec3& at :
             {Vec3(0.5 * (first + enters)), Vec3(0.5 * (enters + leaves)), Vec3(0.5 * (leaves + first))}) {
            const double sinks = plane.normal.dot(flow.velocity + flow.angular_velocity.cross(at));
            heave += piece / 3.0 * sinks * plane.normal;
            roll += piece / 3.0 * sinks * at.cross(plane.normal);
        }
    }
    element.sum.force *= part.scale;
    element.sum.torque *= part.scale;
    element.sum.plane = part.scale * area;
    element.sum.plane_moment = part.scale * moment;
    element.sum.heave = part.scale * heave;
    element.sum.roll = part.scale * roll;
    return element.sum;
}

DragIntegral DragSurface::drag(const WaterPlane& plane, const FlowPast& flow) const {
    DragIntegral sum;
    for (const HullPart& part : parts_) {
        const DragIntegral one = drag_of(part, plane, flow);
        sum.force += one.force;
        sum.torque += one.torque;
        sum.plane += one.plane;
        sum.plane_moment += one.plane_moment;
        sum.heave += one.heave;
        sum.roll += one.roll;
    }
    return sum;
}

}  // namespace tumble
