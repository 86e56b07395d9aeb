#include "sim/geometry/curved_manifold.h"

#include "core/deterministic_math.h"
#include "sim/geometry/contact_area.h"

#include <algorithm>
#include <cmath>

namespace tumble {
namespace {

using FeatureKind = ContactFeature::Kind;

/// A disc faces the other body where its normal is within 30 degrees of the contact's; beyond, its rim does.
constexpr double facing = 0.5;

/// Angles of points on a rim: their number in a turn, and in a quarter_turn.
constexpr std::uint64_t turn_steps = std::uint64_t(1) << 20, quarter_turn = turn_steps / 4,
                        eighth_turn = quarter_turn / 2;

/// Points of a resting disc keep their places while the deepest of them lies at most this share of the radius above the
/// deepest point of the rim: far above rounding, far below the tolerance of resting contact.
constexpr double rim_tolerance = 1e-6;

/// Lines nearer to parallel than this (sine of their angle) meet along their overlap in place of their crossing.
constexpr double parallel_lines = 0.02;

/// Sides of the polygon that stands for a disc where the area of a contact is a part of it.
constexpr int area_sides = 48;

// Kinds of feature ids, in the upper bits.
constexpr std::uint64_t rim_id = 1, corner_id = 2, crossing_id = 3, end_id = 4, meeting_id = 5;
std::uint64_t feature_id(std::uint64_t kind, bool of_b, std::uint64_t index) {
    return kind << 56 | std::uint64_t(of_b) << 55 | index;
}

struct Candidate {
    Vec3 place;  // on a line along the normal
    std::uint64_t feature;
};

// Candidates of a manifold: at most four points of each rim, the crossings of a circle and a polygon of any size.
class Candidates {
public:
    Candidates(const ContactFeature& a, const ContactFeature& b, const Vec3& normal, const ManifoldSink& sink)
        : a_(a), b_(b), n_(normal), sink_(sink) {}

    void find();
    bool whole_disc() const { return rim_points_ == 4 && crossings_ == 0; }

private:
    void put(const Vec3& place, std::uint64_t feature);
    void put(const Vec3& on_a, const Vec3& on_b, std::uint64_t feature);
    bool within(const ContactFeature& f, const Vec3& place) const;
    void add_rim(const ContactFeature& disc, const ContactFeature& other, bool of_b);
    void add_corners(const ContactFeature& polygon, const ContactFeature& other, bool of_b);
    void add_crossings(const ContactFeature& disc, const ContactFeature& polygon, bool disc_of_b);
    void add_circle_crossings();
    void add_line(const ContactFeature& line, const ContactFeature& flat, bool of_b);
    void add_lines();

    const ContactFeature &a_, &b_;
    const Vec3& n_;
    const ManifoldSink& sink_;
    int rim_points_ = 0, crossings_ = 0;
};

void Candidates::put(const Vec3& on_a, const Vec3& on_b, std::uint64_t feature) {
    const double separation = n_.dot(on_b - on_a);
    if (separation > sink_.margin) return;
    sink_.scratch.points.push_back({sink_.frame.to_world(0.5 * (on_a + on_b)), separation, feature});
}

void Candidates::put(const Vec3& place, std::uint64_t feature) { put(a_.lift(place), b_.lift(place), feature); }

bool Candidates::within(const ContactFeature& f, const Vec3& place) const {
    constexpr double slack = 1e-9;
    if (f.kind == FeatureKind::plane) return true;
    if (f.kind == FeatureKind::disc)
        return (f.lift(place) - f.origin).squaredNorm() <= f.radius * f.radius * (1.0 + slack);
    const std::vector<ClipVertex>& corners = *f.corners;
    for (std::size_t i = 0; i < corners.size(); ++i) {
        const Vec3 &from = corners[i].position, edge = corners[(i + 1) % corners.size()].position - from;
        const Vec3 out = edge.cross(f.outward);
        if (out.dot(place - from) > slack * out.norm() * edge.norm()) return false;
    }
    return true;
}

// The angle (in steps) of the deepest point of the rim, or of a point of the last manifold that is as good.
std::uint64_t rim_angle(const ContactFeature& disc, bool of_b, const CollisionScratch& scratch) {
    const Vec3 down = disc.shape->pose.rotation.transpose() * disc.outward;
    const double out = hypotenuse(down.x(), down.z());
    const double turn = atan2_stable(down.z(), down.x()) / (2.0 * pi);
    const auto deepest =
        std::uint64_t(std::int64_t(std::floor(turn * double(turn_steps) + 0.5)) + std::int64_t(turn_steps)) %
        turn_steps;
    if (scratch.choice == AxisChoice::nearest) return deepest;
    const std::uint64_t base = feature_id(rim_id, of_b, std::uint64_t(disc.end) << 54);
    for (const bool same_part : {true, false})
        for (const Manifold& m : scratch.before) {
            if ((m.part == scratch.part) != same_part) continue;
            for (int i = 0; i < m.count; ++i) {
                const std::uint64_t feature = m.points[std::size_t(i)].feature;
                if ((feature & ~(turn_steps - 1) & ~face_feature(true, 0)) != base) continue;
                const std::uint64_t off =
                    (deepest + turn_steps - (feature & (turn_steps - 1)) + eighth_turn) % quarter_turn;
                const double angle = 2.0 * pi * (double(off) - double(eighth_turn)) / double(turn_steps);
                if (out * (1.0 - sincos(angle).cos) <= rim_tolerance)
                    return (deepest + turn_steps + eighth_turn - off) % turn_steps;
            }
        }
    return out <= rim_tolerance ? 0 : deepest;
}

// Four points of the rim of a disc.
void Candidates::add_rim(const ContactFeature& disc, const ContactFeature& other, bool of_b) {
    const std::uint64_t first = rim_angle(disc, of_b, sink_.scratch);
    const Mat3& turn = disc.shape->pose.rotation;
    for (std::uint64_t k = 0; k < 4; ++k) {
        const std::uint64_t step = (first + k * quarter_turn) % turn_steps;
        const SinCos angle = sincos(2.0 * pi * double(step) / double(turn_steps));
        Vec3 p = disc.origin + disc.radius * (angle.cos * turn.col(0) + angle.sin * turn.col(2));
        if (k == 0 && sink_.scratch.choice == AxisChoice::nearest)
            p = disc.shape->pose.to_world(disc.shape->curved->rim_point(disc.end, turn.transpose() * disc.outward));
        if (!within(other, p)) continue;
        ++rim_points_;
        put(p, feature_id(rim_id, of_b, std::uint64_t(disc.end) << 54 | step));
    }
}

void Candidates::add_corners(const ContactFeature& polygon, const ContactFeature& other, bool of_b) {
    for (const ClipVertex& corner : *polygon.corners)
        if (within(other, corner.position)) {
            ++crossings_;
            put(corner.position, feature_id(corner_id, of_b, corner.feature));
        }
}

// Where the sides of a polygon cross a circle.
void Candidates::add_crossings(const ContactFeature& disc, const ContactFeature& polygon, bool disc_of_b) {
    const std::vector<ClipVertex>& corners = *polygon.corners;
    for (std::size_t i = 0; i < corners.size(); ++i) {
        const Vec3 from = disc.lift(corners[i].position) - disc.origin,
                   edge = disc.lift(corners[(i + 1) % corners.size()].position) - disc.origin - from;
        const double a = edge.squaredNorm(), b = from.dot(edge), c = from.squaredNorm() - disc.radius * disc.radius;
        const double square = b * b - a * c;
        if (!(square > 0.0)) continue;
        for (const double sign : {-1.0, 1.0}) {
            const double t = (-b + sign * std::sqrt(square)) / a;
            if (!(t > 0.0 && t < 1.0)) continue;
            ++crossings_;
            put(disc.origin + from + t * edge,
                feature_id(crossing_id, disc_of_b, 2 * std::uint64_t(corners[i].edge) + (sign > 0.0)));
        }
    }
}

void Candidates::add_circle_crossings() {
    const Vec3 d = a_.lift(b_.origin) - a_.origin;
    const double distance = d.norm();
    if (!(distance > std::fabs(a_.radius - b_.radius) && distance < a_.radius + b_.radius)) return;
    const double along = 0.5 * (distance + (a_.radius - b_.radius) * (a_.radius + b_.radius) / distance);
    const Vec3 u = d / distance, v = a_.normal.cross(u);
    const double across = std::sqrt(std::max(0.0, a_.radius * a_.radius - along * along));
    for (const double sign : {-1.0, 1.0}) {
        ++crossings_;
        put(a_.origin + along * u + sign * across * v, feature_id(crossing_id, false, sign > 0.0));
    }
}

// The part of a line, or the point, that lies over a flat feature.
void Candidates::add_line(const ContactFeature& line, const ContactFeature& flat, bool of_b) {
    double from = 0.0, to = line.kind == FeatureKind::line ? 1.0 : 0.0;
    std::uint64_t from_id = feature_id(end_id, of_b, 0), to_id = feature_id(end_id, of_b, 1);
    const Vec3 way = line.ends[1] - line.ends[0];
    if (flat.kind == FeatureKind::polygon) {
        const std::vector<ClipVertex>& corners = *flat.corners;
        for (std::size_t i = 0; i < corners.size(); ++i) {
            const Vec3& corner = corners[i].position;
            const Vec3 out = (corners[(i + 1) % corners.size()].position - corner).cross(flat.outward);
            const double height = out.dot(line.ends[0] - corner), rate = to > 0.0 ? out.dot(way) : 0.0;
            const double slack = 1e-9 * out.norm() * flat.shape->size;
            if (std::fabs(rate) <= slack * 1e-3) {
                if (height > slack) return;
                continue;
            }
            const double t = -height / rate;
            const std::uint64_t id = feature_id(crossing_id, of_b, 2 * std::uint64_t(corners[i].edge));
            if (rate > 0.0 && t < to) to = t, to_id = id + 1;
            if (rate < 0.0 && t > from) from = t, from_id = id;
        }
    } else if (flat.kind == FeatureKind::disc) {
        const Vec3 start = flat.lift(line.ends[0]) - flat.origin,
                   flat_way = flat.lift(line.ends[1]) - flat.origin - start;
        const double a = flat_way.squaredNorm(), b = start.dot(flat_way),
                     c = start.squaredNorm() - flat.radius * flat.radius;
        if (line.kind == FeatureKind::point || !(a > 0.0)) {
            if (c > 1e-9 * flat.radius * flat.radius) return;
        } else {
            const double square = b * b - a * c;
            if (!(square >= 0.0)) return;
            const double root = std::sqrt(square), enter = (-b - root) / a, leave = (-b + root) / a;
            if (enter > from) from = enter, from_id = feature_id(crossing_id, of_b, 0);
            if (leave < to) to = leave, to_id = feature_id(crossing_id, of_b, 1);
        }
    }
    if (from > to) return;
    const auto add = [&](double t, std::uint64_t id) {
        const Vec3 p = line.ends[0] + t * way, other = flat.lift(p);
        of_b ? put(other, p, id) : put(p, other, id);
    };
    add(from, from_id);
    if (to > from) add(to, to_id);
}

// Two lines, or a point and any of them.
void Candidates::add_lines() {
    const Vec3 u = a_.ends[1] - a_.ends[0], v = b_.ends[1] - b_.ends[0];
    if (a_.kind == FeatureKind::point || b_.kind == FeatureKind::point) {
        const bool point_of_a = a_.kind == FeatureKind::point;
        const ContactFeature &point = point_of_a ? a_ : b_, &line = point_of_a ? b_ : a_;
        Vec3 other = line.ends[0];
        if (line.kind == FeatureKind::line) {
            const Vec3 way = line.ends[1] - line.ends[0];
            other += std::clamp(way.dot(point.ends[0] - other) / way.squaredNorm(), 0.0, 1.0) * way;
        }
        const std::uint64_t id = feature_id(meeting_id, !point_of_a, 0);
        return point_of_a ? put(point.ends[0], other, id) : put(other, point.ends[0], id);
    }
    const Vec3 cross = u.cross(v), r = a_.ends[0] - b_.ends[0];
    const double uu = u.squaredNorm(), vv = v.squaredNorm(), uv = u.dot(v);
    if (cross.squaredNorm() > parallel_lines * parallel_lines * uu * vv) {
        const double determinant = uu * vv - uv * uv;
        const double s = std::clamp((uv * v.dot(r) - vv * u.dot(r)) / determinant, 0.0, 1.0);
        const double t = std::clamp((uv * s + v.dot(r)) / vv, 0.0, 1.0);
        return put(a_.ends[0] + s * u, b_.ends[0] + t * v, feature_id(meeting_id, false, 1));
    }
    // The overlap of the lines along A's.
    const double at_0 = -u.dot(r) / uu, at_1 = at_0 + uv / uu;
    const double low = std::max(0.0, std::min(at_0, at_1)), high = std::min(1.0, std::max(at_0, at_1));
    if (low > high)
        return put(a_.ends[0] + std::clamp(low, 0.0, 1.0) * u,
                   b_.ends[at_0 < at_1 ? (low > 1.0 ? 0 : 1) : (low > 1.0 ? 1 : 0)], feature_id(meeting_id, false, 2));
    for (const bool last : {false, true}) {
        const double s = last ? high : low;
        const Vec3 on_a = a_.ends[0] + s * u;
        const double t = std::clamp(v.dot(on_a - b_.ends[0]) / vv, 0.0, 1.0);
        put(on_a, b_.ends[0] + t * v, feature_id(end_id, false, 2 + last));
        if (!(high > low)) break;
    }
}

void Candidates::find() {
    sink_.scratch.points.clear();
    if (a_.flat() && b_.flat()) {
        if (a_.kind == FeatureKind::disc) add_rim(a_, b_, false);
        if (b_.kind == FeatureKind::disc) add_rim(b_, a_, true);
        if (a_.kind == FeatureKind::polygon) add_corners(a_, b_, false);
        if (b_.kind == FeatureKind::polygon) add_corners(b_, a_, true);
        if (a_.kind == FeatureKind::disc && b_.kind == FeatureKind::polygon) add_crossings(a_, b_, false);
        if (b_.kind == FeatureKind::disc && a_.kind == FeatureKind::polygon) add_crossings(b_, a_, true);
        if (a_.kind == FeatureKind::disc && b_.kind == FeatureKind::disc) add_circle_crossings();
    } else if (a_.flat()) {
        add_line(b_, a_, true);
    } else if (b_.flat()) {
        add_line(a_, b_, false);
    } else {
        add_lines();
    }
}

// A polygon for the area of a disc, counter-clockwise about the normal.
template <class Put>
void outline(const ContactFeature& disc, const Vec3& normal, Put&& put) {
    const Vec3 u = disc.normal.unitOrthogonal(), v = normal.cross(u).normalized();
    for (int i = 0; i < area_sides; ++i) {
        const SinCos angle = sincos(2.0 * pi * i / area_sides);
        put(disc.origin + disc.radius * (angle.cos * u + angle.sin * v));
    }
}

ContactArea area_of(const ContactFeature& a, const ContactFeature& b, const Vec3& normal, bool whole_disc,
                    const ManifoldSink& sink) {
    CollisionScratch& scratch = sink.scratch;
    if (a.flat() && b.flat() && whole_disc) {
        const bool of_a = a.kind == FeatureKind::disc && (b.kind != FeatureKind::disc || a.radius <= b.radius);
        const ContactFeature& disc = of_a ? a : b;
        return {sink.frame.to_world(disc.origin), 2.0 / 3.0 * disc.radius, pi * disc.radius * disc.radius};
    }
    if (a.flat() && b.flat() && a.kind != FeatureKind::plane && b.kind != FeatureKind::plane) {
        // The polygon of a face is in place.
        const bool polygon_of_a = a.kind == FeatureKind::polygon,
                   discs = !polygon_of_a && b.kind != FeatureKind::polygon;
        // The outline is clipped to the polygon, which has few sides.
        scratch.reference.clear();
        if (discs) outline(b, normal, [&](const Vec3& p) { scratch.reference.push_back(p); });
        if (!discs)
            for (const ClipVertex& v : scratch.polygon) scratch.reference.push_back(v.position);
        if (!discs && !polygon_of_a) std::reverse(scratch.reference.begin(), scratch.reference.end());
        scratch.polygon.clear();
        outline(polygon_of_a ? b : a, normal, [&](const Vec3& p) { scratch.polygon.push_back({p, 0, 0}); });
        clip_to_prism(scratch.reference, normal, scratch.polygon, scratch.spare);
        scratch.incident.clear();
        for (const ClipVertex& v : scratch.polygon) scratch.incident.push_back(sink.frame.to_world(v.position));
        return contact_area(scratch.incident, sink.frame.rotation * normal);
    }
    return contact_area(scratch.points, sink.frame.rotation * normal);
}

// The balls of a point or a line on a flat feature, or the corners.
void set_curve(const ContactFeature& round, bool of_a, const Vec3& outward, Manifold& m, const Pose& frame) {
    if (!(std::max(round.bend_radius[0], round.bend_radius[1]) > 0.0)) {
        m.corners = of_a ? Corners::of_a : Corners::of_b;
        return;
    }
    const Vec3 way = frame.rotation * (round.ends[1] - round.ends[0]), start = frame.to_world(round.ends[0]);
    const auto center = [&](const ContactPoint& p) {
        double t = 0.0;
        if (round.kind == FeatureKind::line) t = std::clamp(way.dot(p.position - start) / way.squaredNorm(), 0.0, 1.0);
        const double radius = round.bend_radius[0] + t * (round.bend_radius[1] - round.bend_radius[0]);
        // The point on this body's surface: the position lies halfway between the surfaces.
        return Vec3(p.position - (0.5 * p.separation + radius) * outward);
    };
    const Vec3 second = m.count == 2 ? center(m.points[1]) : Vec3(Vec3::Zero());
    m.set_geometry(BallOverFace{of_a, center(m.points[0])});
    if (m.count == 2) m.set_second_ball(second);
}

}  // namespace

ContactFeature face_feature_of(const ConvexShape& shape, std::uint32_t index, const Vec3& outward,
                               std::vector<ClipVertex>& corners) {
    ContactFeature f;
    f.outward = outward;
    f.label = index;
    f.shape = &shape;
    if (shape.curved) {
        f.kind = FeatureKind::disc;
        f.end = int(index);
        f.origin = shape.pose.to_world(shape.curved->ends[index]);
        f.normal = (index == 0 ? -1.0 : 1.0) * shape.axis();
        f.radius = shape.curved->discs[index].radius;
        return f;
    }
    f.kind = FeatureKind::polygon;
    f.corners = &corners;
    corners.clear();
    if (shape.hull) {
        const Polyhedron::Face& face = shape.hull->faces[index];
        for (const std::uint32_t v : face.vertices)
            corners.push_back({shape.pose.to_world(shape.hull->vertices[v]), v, std::uint32_t(corners.size())});
        f.normal = shape.pose.rotation * face.normal;
    } else {
        for (std::uint32_t i = 0; i < 3; ++i) corners.push_back({shape.corners[i], i, i});
        f.normal = shape.facing;
        const Vec3 wound = (shape.corners[1] - shape.corners[0]).cross(shape.corners[2] - shape.corners[0]);
        if (f.normal.dot(wound) < 0.0) {  // counter-clockwise about the normal; edge i starts at corner i
            std::swap(corners[0], corners[1]);
            corners[0].edge = 0, corners[1].edge = 2, corners[2].edge = 1;
        }
    }
    f.origin = corners[0].position;
    return f;
}

ContactFeature feature_along(const ConvexShape& shape, const Vec3& outward, double level,
                             std::vector<ClipVertex>& corners) {
    ContactFeature f;
    f.outward = outward;
    f.shape = &shape;
    if (shape.curved) {
        const CurvedBody& body = *shape.curved;
        const Vec3 down = shape.pose.rotation.transpose() * outward;
        const double out = hypotenuse(down.x(), down.z());
        const int end = body.ellipsoid ? 0 : body.end_along(down);
        if (body.has_disc(end) && std::fabs(down.y()) > 0.0 && (end == 1) == (down.y() > 0.0) && out < facing)
            return face_feature_of(shape, std::uint32_t(end), outward, corners);
        const auto surface = [&](const Vec3& p) { return Vec3(shape.pose.to_world(p) + body.rounding * outward); };
        if (body.ellipsoid) {
            f.ends[0] = surface(body.support(down));
            // The mean radius of curvature.
            f.bend_radius[0] = 0.5 * body.bend(down).trace();
            return f;
        }
        const auto radius_at = [&](int k) {
            const double r = body.discs[std::size_t(k)].radius;
            return body.rounding + (r > 0.0 ? r / out : 0.0);
        };
        const Vec3 first = body.rim_point(0, down), second = body.rim_point(1, down);
        if (std::fabs(down.dot(second - first)) <= level) {
            f.kind = FeatureKind::line;
            f.ends = {surface(first), surface(second)};
            f.bend_radius = {radius_at(0), radius_at(1)};
            return f;
        }
        f.ends[0] = surface(body.rim_point(end, down));
        f.bend_radius[0] = radius_at(end);
        return f;
    }
    const auto edge_of = [&](std::size_t count, const auto& at) {
        double most = -infinity;
        for (std::size_t i = 0; i < count; ++i) most = std::max(most, outward.dot(at(i)));
        std::size_t found = 0;
        for (std::size_t i = 0; i < count && found < 2; ++i)
            if (outward.dot(at(i)) >= most - level) f.ends[found++] = at(i);
        f.kind = found == 2 ? FeatureKind::line : FeatureKind::point;
    };
    if (shape.hull)
        edge_of(shape.hull->vertices.size(),
                [&](std::size_t i) { return shape.pose.to_world(shape.hull->vertices[i]); });
    else
        edge_of(std::size_t(shape.corner_count), [&](std::size_t i) { return shape.corners[i]; });
    for (Vec3& end : f.ends) end += shape.rounding * outward;
    f.bend_radius = {shape.rounding, shape.rounding};
    return f;
}

void add_curved_manifold(const ContactFeature& a, const ContactFeature& b, const Vec3& normal, bool reference_on_b,
                         const ManifoldSink& sink) {
    Candidates candidates(a, b, normal, sink);
    candidates.find();
    CollisionScratch& scratch = sink.scratch;
    if (scratch.points.empty()) return;
    Manifold m;
    m.normal = sink.frame.rotation * normal;
    keep_best_points(scratch.points, m, scratch.reduced);
    if (a.flat() && b.flat()) {
        m.corners = reference_on_b ? Corners::of_a : Corners::of_b;
        for (int i = 0; i < m.count; ++i) m.points[std::size_t(i)].feature |= face_feature(reference_on_b, 0);
        spread_pressure(area_of(a, b, normal, candidates.whole_disc(), sink), m);
    } else {
        if (m.count > 1) spread_pressure(contact_area(scratch.points, m.normal), m);
        if (a.flat()) set_curve(b, false, -m.normal, m, sink.frame);
        if (b.flat()) set_curve(a, true, m.normal, m, sink.frame);
    }
    // Only points that lie flat, or corners on flat ground, stay where they are on both bodies.
    scratch.on_ball = scratch.on_ball || !(a.flat() && b.flat()) || m.count < 3;
    sink.out.push_back(m);
}

}  // namespace tumble
