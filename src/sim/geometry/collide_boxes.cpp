// Box against box: the results of the routine for all polyhedra (separating_axis.cpp, feature_contact.cpp), with the
// same choices and feature labels, from the matrix that rotates one box into the other.
#include "sim/geometry/contact_area.h"
#include "sim/geometry/feature_contact.h"
#include "sim/geometry/separating_axis.h"
#include "sim/geometry/settings.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace tumble {
namespace {

// The fifteen candidate separating axes of two boxes (Gottschalk, Lin and Manocha 1996, "OBBTree", section 5): three
// face normals of each box and the cross products of an edge of A with an edge of B. Three axes are computed side by
// side; each has the arithmetic of one axis alone.
class BoxAxes {
public:
    // Three numbers in two registers that every x86-64 has.
    class Lanes {
    public:
        Lanes() = default;
        Lanes(double x, double y, double z) : low_{x, y}, high_{z, 0.0} {}
        template <class Vector>
        explicit Lanes(const Vector& v) : Lanes(v[0], v[1], v[2]) {}

        double operator[](int k) const { return k < 2 ? low_[k] : high_[0]; }
        friend Lanes operator+(const Lanes& l, const Lanes& r) { return {l.low_ + r.low_, l.high_ + r.high_}; }
        friend Lanes operator-(const Lanes& l, const Lanes& r) { return {l.low_ - r.low_, l.high_ - r.high_}; }
        friend Lanes operator*(const Lanes& l, const Lanes& r) { return {l.low_ * r.low_, l.high_ * r.high_}; }
        friend Lanes operator*(double l, const Lanes& r) { return {l * r.low_, l * r.high_}; }
        Lanes abs() const { return {Two(Bits(low_) & INT64_MAX), Two(Bits(high_) & INT64_MAX)}; }
        // Rotation of the three lanes by one, forwards and backwards.
        Lanes next() const { return {low_[1], high_[0], low_[0]}; }
        Lanes before() const { return {high_[0], low_[0], low_[1]}; }

    private:
        typedef double Two __attribute__((vector_size(16)));
        typedef std::int64_t Bits __attribute__((vector_size(16)));
        Lanes(Two low, Two high) : low_(low), high_(high) {}
        Two low_, high_;
    };

    // Half extents (m) and poses.
    BoxAxes(const Vec3& half_a, const Pose& pose_a, const Vec3& half_b, const Pose& pose_b)
        : r(pose_a.rotation.transpose() * pose_b.rotation), a_(half_a), b_(half_b) {
        const Vec3 between = pose_b.position - pose_a.position;
        t = pose_a.rotation.transpose() * between;
        t_in_b = pose_b.rotation.transpose() * between;
        for (int k = 0; k < 3; ++k) {
            row_[k] = Lanes(r.row(k));
            size_[k] = row_[k].abs();
        }
    }

    Vec3 t, t_in_b;  // m: B's center in A's frame; A's center in B's frame, negated
    Mat3 r;          // rotation from B's frame to A's frame

    // Separations (m) along the face normals.
    Lanes faces_a() const {
        return Lanes(t).abs() - Lanes(a_) -
               (b_[0] * Lanes(r.col(0)).abs() + b_[1] * Lanes(r.col(1)).abs() + b_[2] * Lanes(r.col(2)).abs());
    }
    Lanes faces_b() const {
        return Lanes(t_in_b).abs() - Lanes(b_) - (a_[0] * size_[0] + a_[1] * size_[1] + a_[2] * size_[2]);
    }

    // Along A's axis i x B's axes: separations not yet divided by the lengths of the axes, the squares of these
    // lengths, and the offset of B's center along them.
    struct Edges {
        Lanes separation, square, across;
    };
    Edges edges(int i) const {
        const int i1 = i == 2 ? 0 : i + 1, i2 = i == 0 ? 2 : i - 1;
        const Lanes across = t[i2] * row_[i1] - t[i1] * row_[i2], b(b_);
        const Lanes reach =
            a_[i1] * size_[i2] + a_[i2] * size_[i1] + b.next() * size_[i].before() + b.before() * size_[i].next();
        return {across.abs() - reach, row_[i1] * row_[i1] + row_[i2] * row_[i2], across};
    }

    // Separation along A's edge x B's edge; the lowest number for parallel edges.
    static double separation(const Edges& e, int j) {
        return e.square[j] < tuning::parallel_edges ? lowest : e.separation[j] / std::sqrt(e.square[j]);
    }
    // Axis index: the faces of A, then the faces of B, then the edge pair i, j as 6 + 3 i + j.
    double along(std::uint32_t axis) const {
        if (axis < 3) return faces_a()[int(axis)];
        return axis < 6 ? faces_b()[int(axis) - 3] : separation(edges(int(axis - 6) / 3), int(axis - 6) % 3);
    }

    static constexpr double lowest = -std::numeric_limits<double>::infinity();

private:
    const Vec3 &a_, &b_;
    Lanes row_[3], size_[3];  // rows of r; absolute values of r
};

struct BoxFaceAxis {
    int axis = 0;
    double separation = BoxAxes::lowest;
};

// The face of largest separation. In a tie, the face with the other's center highest above it wins, as in
// separating_axis.cpp.
BoxFaceAxis best_box_face(const Vec3& center, const Vec3& half, const BoxAxes::Lanes& separation) {
    int first = 0;
    for (int k = 1; k < 3; ++k)
        if (std::abs(center[k]) - half[k] > std::abs(center[first]) - half[first]) first = k;
    BoxFaceAxis best{first, separation[first]};
    for (int k = 0; k < 3; ++k)
        if (separation[k] > best.separation) best = {k, separation[k]};
    return best;
}

// Edge of a box along an axis, by the signs of its other two coordinates. The numbering is the same for all boxes.
struct BoxEdges {
    std::array<std::array<std::uint32_t, 4>, 3> index{};
    BoxEdges() {
        const Polyhedron box = make_box(Vec3::Constant(2.0));
        for (std::uint32_t e = 0; e < box.edges.size(); ++e) {
            const Vec3 sum = box.vertices[box.edges[e].tail] + box.vertices[box.edges[e].head];
            for (int k = 0; k < 3; ++k)
                if (sum[k] == 0.0) index[std::size_t(k)][sign_bits(sum, k)] = e;
        }
    }
    static std::size_t sign_bits(const Vec3& direction, int axis) {
        return std::size_t(direction[(axis + 1) % 3] > 0.0) | std::size_t(direction[(axis + 2) % 3] > 0.0) << 1;
    }
};

// Corners of a box's faces, by the signs of their coordinates, and the coordinate whose limit each side from a corner
// to the next lies on. The same for all boxes.
struct BoxFaces {
    struct Side {
        int axis = 0;
        double sign = 1.0;
    };
    struct Face {
        std::array<std::uint32_t, 4> corner{};
        std::array<Side, 4> side{};
    };
    std::array<Face, 6> faces;
    std::array<Vec3, 8> signs;  // corner signs, by vertex
    BoxFaces() {
        const Polyhedron box = make_box(Vec3::Constant(2.0));
        std::copy(box.vertices.begin(), box.vertices.end(), signs.begin());
        for (std::size_t f = 0; f < 6; ++f)
            for (std::size_t s = 0; s < 4; ++s) {
                const std::uint32_t from = box.faces[f].vertices[s], to = box.faces[f].vertices[(s + 1) % 4];
                faces[f].corner[s] = from;
                for (int k = 0; k < 3; ++k)
                    if (k != int(f) / 2 && signs[from][k] == signs[to][k]) faces[f].side[s] = {k, signs[from][k]};
            }
    }
};

// The face of a box that lies against a plane normal to a direction (Polyhedron::face_at_support): at the farthest
// corner, the face with most corners no farther than `depth` behind it, then the face best aligned with the direction.
std::uint32_t face_at_support(const Vec3& half, const Vec3& direction, double depth) {
    std::uint32_t best = 0;
    int best_count = 0;
    double most = 0.0;
    for (int k = 0; k < 3; ++k) {
        const double drop1 = 2.0 * half[(k + 1) % 3] * std::abs(direction[(k + 1) % 3]);
        const double drop2 = 2.0 * half[(k + 2) % 3] * std::abs(direction[(k + 2) % 3]);
        const int count = 1 + (drop1 <= depth) + (drop2 <= depth) + (drop1 + drop2 <= depth);
        const double d = std::abs(direction[k]);
        if (count < best_count || (count == best_count && d <= most)) continue;
        best = std::uint32_t(2 * k + (direction[k] <= 0.0));
        best_count = count;
        most = d;
    }
    return best;
}

struct Corner {
    Vec3 p;  // in the reference box's frame
    std::uint64_t feature;
    std::uint32_t edge;  // label of the edge that starts here
};
struct Polygon {
    static constexpr int capacity = 8;  // a rectangle cut by four lines
    std::array<Corner, capacity> corners;
    int count = 0;
};

// Clips to sign * p[axis] <= limit. Returns whether a point was cut off: otherwise `out` is unchanged.
bool clip(const Polygon& in, int axis, double sign, double limit, std::uint32_t side, Polygon& out) {
    std::array<double, Polygon::capacity> beyond;
    bool cuts = false;
    for (std::size_t i = 0; i < std::size_t(in.count); ++i) {
        beyond[i] = sign * in.corners[i].p[axis] - limit;
        cuts = cuts || beyond[i] > 0.0;
    }
    if (!cuts) return false;
    out.count = 0;
    for (int i = 0; i < in.count; ++i) {
        const int next = i + 1 < in.count ? i + 1 : 0;
        const Corner &p = in.corners[std::size_t(i)], &q = in.corners[std::size_t(next)];
        const double dp = beyond[std::size_t(i)], dq = beyond[std::size_t(next)];
        if (dp <= 0.0 && out.count < Polygon::capacity) out.corners[std::size_t(out.count++)] = p;
        if ((dp <= 0.0) == (dq <= 0.0) || out.count == Polygon::capacity) continue;
        Corner& cut = out.corners[std::size_t(out.count++)];
        cut.p = p.p + dp / (dp - dq) * (q.p - p.p);
        cut.feature = (std::uint64_t(1) << 40) | (std::uint64_t(p.edge) << 20) | side_label(side);
        cut.edge = dp <= 0.0 ? side_label(side) : p.edge;
    }
    return true;
}

// A face of the reference box against the incident box.
struct BoxFacing {
    const Polyhedron &reference, &incident;
    Vec3 center;  // of the incident box, in the reference box's frame
    Mat3 axes;    // axes of the incident box as columns, in the same frame
    int axis;     // of the reference face's outward normal, and its sign
    double sign;
    bool on_b;  // the reference box is B
};

// The sink's frame is that of the reference box.
void add_face(const BoxFacing& facing, bool must_touch, const ManifoldSink& sink) {
    const Polyhedron &reference = facing.reference, &incident = facing.incident;
    const Mat3& r = facing.axes;
    const int axis = facing.axis;
    const double sign = facing.sign;
    CollisionScratch& scratch = sink.scratch;
    const std::uint32_t face = std::uint32_t(2 * axis + (sign < 0.0));
    const double depth = axis_preference(std::min(reference.radius, incident.radius));
    const std::uint32_t opposite = face_at_support(incident.half_extent, -sign * r.row(axis).transpose(), depth);
    static const BoxFaces box;
    const BoxFaces::Face &incident_face = box.faces[opposite], &reference_face = box.faces[face];
    const Mat3 half_axes = r * incident.half_extent.asDiagonal();
    Polygon polygons[2];
    Polygon *polygon = &polygons[0], *spare = &polygons[1];
    polygon->count = 4;
    for (std::size_t i = 0; i < 4; ++i)
        polygon->corners[i] = {facing.center + half_axes * box.signs[incident_face.corner[i]], incident_face.corner[i],
                               std::uint32_t(i)};
    const auto height = [&](const Vec3& p) { return sign * p[axis] - reference.half_extent[axis]; };
    Corner deepest = polygon->corners[0];
    for (std::size_t i = 1; i < 4 && must_touch; ++i)
        if (height(polygon->corners[i].p) < height(deepest.p)) deepest = polygon->corners[i];

    for (std::uint32_t s = 0; s < 4; ++s) {
        const BoxFaces::Side& side = reference_face.side[s];
        if (clip(*polygon, side.axis, side.sign, reference.half_extent[side.axis], s, *spare))
            std::swap(polygon, spare);
    }
    const std::uint64_t base = face_feature(facing.on_b, face);
    scratch.points.clear();
    const auto keep = [&](const Corner& corner) {
        const double separation = height(corner.p);
        if (separation > sink.margin) return;
        Vec3 p = corner.p;
        p[axis] -= 0.5 * sign * separation;
        scratch.points.push_back({sink.frame.to_world(p), separation, base | corner.feature});
    };
    for (int i = 0; i < polygon->count; ++i) keep(polygon->corners[std::size_t(i)]);
    if (scratch.points.empty() && must_touch) keep(deepest);  // rounding clipped a sliver away
    if (scratch.points.empty()) return;
    Manifold& m = sink.out.emplace_back();
    m.normal = (facing.on_b ? -sign : sign) * sink.frame.rotation.col(axis);
    m.corners = facing.on_b ? Corners::of_a : Corners::of_b;
    keep_best_points(scratch.points, m, scratch.reduced);
    spread_pressure(contact_area(scratch.points, m.normal), m);
}

}  // namespace

void collide_boxes(const Polyhedron& a, const Polyhedron& b, const CollisionQuery& query) {
    CollisionScratch& scratch = query.scratch;
    const BoxAxes axes(a.half_extent, query.pose_a, b.half_extent, query.pose_b);
    const Vec3 &t = axes.t, &t_in_b = axes.t_in_b;
    const Mat3& r = axes.r;
    const auto apart = [&](std::uint32_t axis, double separation) {
        if (separation <= query.margin) return false;
        scratch.axis = axis;
        scratch.gap = separation;
        return true;
    };
    if (scratch.axis < 15 && apart(scratch.axis, axes.along(scratch.axis))) return;
    const BoxAxes::Lanes faces_a = axes.faces_a(), faces_b = axes.faces_b();
    const BoxFaceAxis face_a = best_box_face(t, a.half_extent, faces_a);
    if (apart(std::uint32_t(face_a.axis), face_a.separation)) return;
    const BoxFaceAxis face_b = best_box_face(t_in_b, b.half_extent, faces_b);
    if (apart(std::uint32_t(3 + face_b.axis), face_b.separation)) return;

    const double smaller = std::min(a.radius, b.radius);
    const double preference = axis_preference(smaller, scratch.choice);
    bool of_b = face_b.separation > face_a.separation + (scratch.was_on_b() ? -preference : preference);
    double best = (of_b ? face_b.separation : face_a.separation) + preference;
    int edge_i = -1, edge_j = -1;
    bool flip = false;
    for (int i = 0; i < 3; ++i) {
        const BoxAxes::Edges e = axes.edges(i);
        // Most pairs of edges are no better than the best: rejected by their squares, beyond rounding, without root and
        // division.
        const double needed = std::min(best, query.margin),
                     square = needed * needed * (needed < 0.0 ? 1.000001 : 0.999999);
        const BoxAxes::Lanes more = e.separation * e.separation - square * e.square;
        for (int j = 0; j < 3; ++j) {
            if (needed < 0.0 ? e.separation[j] < 0.0 && more[j] > 0.0 : e.separation[j] < 0.0 || more[j] < 0.0)
                continue;
            const double s = BoxAxes::separation(e, j);
            if (apart(std::uint32_t(6 + 3 * i + j), s)) return;
            if (s <= best) continue;
            best = s;
            edge_i = i;
            edge_j = j;
            flip = e.across[j] < 0.0;
        }
    }
    const auto normal_of = [&](bool on_b, int k) {  // in A's frame, away from A
        return on_b ? Vec3((t_in_b[k] < 0.0 ? -1.0 : 1.0) * r.col(k)) : Vec3((t[k] < 0.0 ? -1.0 : 1.0) * Vec3::Unit(k));
    };
    int face = of_b ? face_b.axis : face_a.axis;
    const SeparatingAxis best_of_faces{.separation = of_b ? face_b.separation : face_a.separation,
                                       .normal = normal_of(of_b, face)};
    SeparatingAxis by_edges{.separation = best};
    bool uses_edges = edge_i >= 0,
         rejected_edges = false;  // true if an edge contact is used; true if it was rejected for a face
    if (uses_edges) {
        by_edges.normal = Vec3::Unit(edge_i).cross(r.col(edge_j)).normalized();
        if (flip) by_edges.normal = -by_edges.normal;
        rejected_edges = edges_along_face(by_edges, best_of_faces, smaller, scratch.choice);
        uses_edges = !rejected_edges;
    }
    const SeparatingAxis& axis = uses_edges ? by_edges : best_of_faces;
    bool must_touch = axis.separation < 0.0 && !rejected_edges;
    if (may_slide_past(axis.separation, scratch.displacement, smaller)) {
        Vec3 displacement = Vec3::Zero();  // computed only where both faces graze
        if (axis.separation < preference) displacement = query.pose_a.rotation.transpose() * scratch.displacement;
        double most = -preference;  // lower separations are not grazing
        for (const bool on_b : {false, true})
            for (int k = 0; k < 3; ++k) {
                const double s = (on_b ? faces_b : faces_a)[k];
                if (s <= most || !slides_past(axis, {.separation = s, .normal = normal_of(on_b, k)}, displacement,
                                              smaller, scratch.choice))
                    continue;
                most = s;
                uses_edges = rejected_edges = must_touch = false;
                of_b = on_b;
                face = k;
            }
    }
    if (!uses_edges) {
        const std::size_t first = query.out.size();
        if (of_b) {
            // In B's frame A's center lies at -t_in_b, and A's axes are the rows of r.
            const double sign = t_in_b[face] > 0.0 ? -1.0 : 1.0;
            add_face({b, a, -t_in_b, r.transpose(), face, sign, true}, must_touch,
                     {query.pose_b, query.margin, scratch, query.out});
        } else {
            add_face({a, b, t, r, face, t[face] < 0.0 ? -1.0 : 1.0, false}, must_touch,
                     {query.pose_a, query.margin, scratch, query.out});
        }
        uses_edges = rejected_edges && misses_edges(std::span(query.out).subspan(first), by_edges.separation, smaller);
        if (!uses_edges) return;
        query.out.resize(first);
    }
    static const BoxEdges edges;
    const Vec3& n = by_edges.normal;
    const Vec3 n_in_b = r.transpose() * n;
    const std::uint32_t ea = edges.index[std::size_t(edge_i)][BoxEdges::sign_bits(n, edge_i)];
    const std::uint32_t eb = edges.index[std::size_t(edge_j)][BoxEdges::sign_bits(-n_in_b, edge_j)];
    const Pose b_in_a{t, r};
    const Polyhedron::Edge &edge_a = a.edges[ea], &edge_b = b.edges[eb];
    add_edge_manifold({a.vertices[edge_a.tail], a.vertices[edge_a.head], ea},
                      {b_in_a.to_world(b.vertices[edge_b.tail]), b_in_a.to_world(b.vertices[edge_b.head]), eb}, n,
                      by_edges.separation, {query.pose_a, query.margin, scratch, query.out});
}

}  // namespace tumble
