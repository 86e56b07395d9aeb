#include "harness/penetration.h"

#include <algorithm>
#include <array>
#include <limits>
#include <utility>

namespace tumble::bench {
namespace {

constexpr double never = std::numeric_limits<double>::infinity();
// Edges whose directions differ by less (sine, squared) define no axis of their own: a face's normal is equivalent.
constexpr double parallel = 1e-10;

// A box or hexahedron in the world.
struct Solid {
    Corners corners;
    std::array<Vector, 6> normals;
    std::array<Vector, 12> edges;
    std::size_t normal_count = 0, edge_count = 0;
};

Solid placed(const Body& body, const Motion& motion) {
    Solid s;
    const Corners local = body.outline();
    for (std::size_t i = 0; i < 8; ++i) s.corners[i] = motion.position + rotate(motion.orientation, local[i]);
    const auto direction = [&](int from, int to) {
        const Vector d = s.corners[std::size_t(to)] - s.corners[std::size_t(from)];
        return 1.0 / norm(d) * d;
    };
    if (body.kind == Kind::box) {
        s.normal_count = s.edge_count = 3;
        for (std::size_t i = 0; i < 3; ++i) s.normals[i] = s.edges[i] = direction(0, 1 << i);
        return s;
    }
    s.normal_count = 6;
    s.edge_count = 12;
    for (std::size_t i = 0; i < 6; ++i) {
        const Vector n = cross(direction(sides[i][0], sides[i][1]), direction(sides[i][0], sides[i][3]));
        s.normals[i] = 1.0 / norm(n) * n;
    }
    for (std::size_t i = 0; i < 12; ++i) s.edges[i] = direction(edges[i][0], edges[i][1]);
    return s;
}

double overlap(const Solid& a, const Solid& b, const Vector& axis) {
    double a_low = never, a_high = -never, b_low = never, b_high = -never;
    for (const Vector& c : a.corners) {
        const double x = dot(axis, c - a.corners[0]);  // relative to one corner, which keeps digits far from the origin
        a_low = std::min(a_low, x);
        a_high = std::max(a_high, x);
    }
    for (const Vector& c : b.corners) {
        const double x = dot(axis, c - a.corners[0]);
        b_low = std::min(b_low, x);
        b_high = std::max(b_high, x);
    }
    return std::min(a_high - b_low, b_high - a_low);
}

double solid_depth(const Solid& a, const Solid& b, double near) {
    double least = never;
    const auto apart = [&](const Vector& axis) {
        least = std::min(least, overlap(a, b, axis));
        return least < -near;
    };
    for (std::size_t i = 0; i < a.normal_count; ++i)
        if (apart(a.normals[i])) return least;
    for (std::size_t i = 0; i < b.normal_count; ++i)
        if (apart(b.normals[i])) return least;
    for (std::size_t i = 0; i < a.edge_count; ++i)
        for (std::size_t j = 0; j < b.edge_count; ++j) {
            const Vector axis = cross(a.edges[i], b.edges[j]);
            const double square = dot(axis, axis);
            if (square > parallel && apart(1.0 / std::sqrt(square) * axis)) return least;
        }
    return least;
}

double sphere_box_depth(double radius, const Motion& sphere, const Body& box, const Motion& bt) {
    const Vector p = rotate_back(bt.orientation, sphere.position - bt.position), half = 0.5 * box.size;
    const Vector nearest{std::clamp(p.x, -half.x, half.x), std::clamp(p.y, -half.y, half.y),
                         std::clamp(p.z, -half.z, half.z)};
    const double distance = norm(p - nearest);
    if (distance > 0.0) return radius - distance;
    return radius + std::min({half.x - std::abs(p.x), half.y - std::abs(p.y), half.z - std::abs(p.z)});
}

double plane_depth(const Body& plane, const Body& body, const Motion& motion) {
    if (body.kind == Kind::sphere) return body.radius + plane.offset - dot(plane.normal, motion.position);
    double lowest = never;
    for (const Vector& c : body.outline())
        lowest = std::min(lowest, dot(plane.normal, motion.position + rotate(motion.orientation, c)));
    return plane.offset - lowest;
}

// A pair that needs the exact test.
bool close(const Body& a, const Motion& at, const Body& b, const Motion& bt, double near) {
    const double reach = a.reach() + b.reach() + near;
    const Vector d = at.position - bt.position;
    return dot(d, d) <= reach * reach;
}

// A part of a compound as a body of its own.
std::pair<Body, Motion> apart(const BoxPart& part, const Motion& whole) {
    Body box;
    box.kind = Kind::box;
    box.size = part.size;
    Motion motion = whole;
    motion.position = whole.position + rotate(whole.orientation, part.position);
    motion.orientation = whole.orientation * part.orientation;
    return {box, motion};
}

Motion pose(const Body& body, const Motion& motion) {
    return body.moves() ? motion : Motion{body.position, body.orientation, {}, {}};
}

}  // namespace

bool finite(const Motion& m) {
    const double sum = norm(m.position) + norm(m.velocity) + norm(m.angular_velocity) + m.orientation.w +
                       m.orientation.x + m.orientation.y + m.orientation.z;
    return std::isfinite(sum);
}

double depth(const Body& a, const Motion& at, const Body& b, const Motion& bt, double near) {
    if (a.kind == Kind::compound) {
        double deepest = -never;
        for (const BoxPart& part : a.parts) {
            const auto [box, motion] = apart(part, at);
            deepest = std::max(deepest, depth(box, motion, b, bt, near));
        }
        return deepest;
    }
    if (b.kind == Kind::compound) return depth(b, bt, a, at, near);
    if (a.kind == Kind::plane) return b.kind == Kind::plane ? -never : plane_depth(a, b, bt);
    if (b.kind == Kind::plane) return plane_depth(b, a, at);
    if (!close(a, at, b, bt, near)) return -never;
    if (a.kind == Kind::sphere && b.kind == Kind::sphere) return a.radius + b.radius - norm(at.position - bt.position);
    if (a.kind == Kind::sphere) return sphere_box_depth(a.radius, at, b, bt);
    if (b.kind == Kind::sphere) return sphere_box_depth(b.radius, bt, a, at);
    return solid_depth(placed(a, at), placed(b, bt), near);
}

Penetration penetration(const Scene& scene, const std::vector<Motion>& motions, double near) {
    struct Span {
        double low, high;
        std::size_t body;
    };
    std::vector<Span> spans;  // along x: swept in order
    std::vector<Motion> poses;
    for (std::size_t i = 0; i < scene.bodies.size(); ++i) {
        const Body& body = scene.bodies[i];
        poses.push_back(pose(body, motions[i]));
        if (!finite(poses.back())) continue;
        const double x = body.kind == Kind::plane ? 0.0 : poses.back().position.x, reach = body.reach() + near;
        spans.push_back({x - reach, x + reach, i});
    }
    std::sort(spans.begin(), spans.end(), [](const Span& a, const Span& b) { return a.low < b.low; });
    Penetration found;
    std::vector<Span> open;
    for (const Span& s : spans) {
        std::erase_if(open, [&](const Span& o) { return o.high < s.low; });
        for (const Span& o : open) {
            const Body &a = scene.bodies[s.body], &b = scene.bodies[o.body];
            if (!a.moves() && !b.moves()) continue;
            const double d = depth(a, poses[s.body], b, poses[o.body], near);
            if (!(d > -near)) continue;
            ++found.pairs;
            if (d <= 0.0) continue;
            found.mean += d;
            found.squares += d * d;
            found.largest = std::max(found.largest, d);
        }
        open.push_back(s);
    }
    if (found.pairs > 0) found.mean /= double(found.pairs);
    return found;
}

}  // namespace tumble::bench
