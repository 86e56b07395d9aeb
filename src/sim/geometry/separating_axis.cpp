#include "sim/geometry/separating_axis.h"

#include "sim/geometry/settings.h"

#include <algorithm>
#include <limits>

namespace tumble {
namespace {

constexpr double along_face = 0.98;  // cosine of 11 degrees
constexpr double across_face = 0.5;  // cosine of 60 degrees
constexpr double lowest = -std::numeric_limits<double>::infinity();

struct FaceAxis {
    double separation = lowest;
    std::uint32_t face = 0;
};

// Largest separation over the faces of `shape` from `other`, whose pose in shape's frame is given.
FaceAxis best_face(const Polyhedron& shape, const Polyhedron& other, const Pose& other_pose, double margin) {
    FaceAxis best;
    std::uint32_t support = 0;
    const auto try_face = [&](std::uint32_t f, double height) {
        const Vec3 direction = -(other_pose.rotation.transpose() * shape.faces[f].normal);
        if (!other.is_box) support = other.support(direction, support);
        const double reach =
            other.is_box ? other.half_extent.dot(direction.cwiseAbs()) : direction.dot(other.vertices[support]);
        if (height - reach > best.separation) best = {height - reach, f};
    };
    const auto height_over = [&](const Polyhedron::Face& face) {
        return face.normal.dot(other_pose.position) - face.offset;
    };
    // The face with the other's center highest above it comes first. After it, a face can win only if it would still do
    // with the other's extent reduced to its inner radius.
    std::uint32_t first = 0;
    double highest = lowest;
    for (std::uint32_t f = 0; f < shape.faces.size(); ++f) {
        const double height = height_over(shape.faces[f]);
        if (height <= highest) continue;
        highest = height;
        first = f;
    }
    try_face(first, highest);
    for (std::uint32_t f = 0; f < shape.faces.size() && best.separation <= margin; ++f) {
        const double height = height_over(shape.faces[f]);
        if (f != first && height - other.inner_radius > best.separation) try_face(f, height);
    }
    return best;
}

Pose inverse(const Pose& p) { return {-(p.rotation.transpose() * p.position), p.rotation.transpose()}; }

// Region of possible edge contacts: in the other shape's bounds, and where both best faces leave room (normal . p >=
// least).
struct Region {
    Bounds bounds;
    Vec3 normal[2];
    double least[2];
};

// For the shallow overlaps of a simulation this leaves a handful of a thousand edges.
void edges_in(const Polyhedron& shape, const Region& region, std::vector<std::uint32_t>& edges) {
    edges.clear();
    shape.edge_tree.query(region.bounds, [&](std::uint32_t e) {
        const Vec3 &tail = shape.vertices[shape.edges[e].tail], &head = shape.vertices[shape.edges[e].head];
        for (int i = 0; i < 2; ++i)
            if (std::max(region.normal[i].dot(tail), region.normal[i].dot(head)) < region.least[i]) return;
        edges.push_back(e);
    });
    std::sort(edges.begin(), edges.end());  // ties between axes go to the lower edge, independent of the tree
}

// In `shape`'s frame. Its best face f: the other lies above f's plane lowered by the overlap. The other's best face g:
// this shape's part of the contact lies below g's plane. Each within `reach`.
Region contact_region(const Polyhedron& shape, const FaceAxis& f, const Polyhedron& other, const FaceAxis& g,
                      const Pose& other_pose, double reach) {
    const Polyhedron::Face &own = shape.faces[f.face], &theirs = other.faces[g.face];
    const Vec3 into = -(other_pose.rotation * theirs.normal);
    return {posed_bounds(other.bounds, other_pose).grown(reach),
            {own.normal, into},
            {own.offset + std::min(0.0, f.separation) - reach, into.dot(other_pose.position) - theirs.offset - reach}};
}

// True if the two edges form a face of the Minkowski difference: their arcs on the Gauss map cross (Gregorius 2013). a,
// b: A's face normals beside its edge; c, d: B's, negated; all in one frame.
bool arcs_cross(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d) {
    const Vec3 bxa = b.cross(a), dxc = d.cross(c);
    const double cba = c.dot(bxa), dba = d.dot(bxa), adc = a.dot(dxc), bdc = b.dot(dxc);
    return cba * dba < 0.0 && adc * bdc < 0.0 && cba * bdc > 0.0;
}

void search_edges(const AxisQuery& query, const FaceAxis& face_a, const FaceAxis& face_b, CollisionScratch& scratch,
                  double& best, SeparatingAxis& axis) {
    const Polyhedron &a = query.a, &b = query.b;
    const Pose& b_in_a = query.b_in_a;
    const double reach = edge_reach(query.edges, query.margin, axis.separation);
    edges_in(a, contact_region(a, face_a, b, face_b, b_in_a, reach), scratch.edges_a);
    edges_in(b, contact_region(b, face_b, a, face_a, inverse(b_in_a), reach), scratch.edges_b);
    for (const std::uint32_t ib : scratch.edges_b) {
        const Polyhedron::Edge& eb = b.edges[ib];
        const Vec3 tail_b = b_in_a.to_world(b.vertices[eb.tail]);
        const Vec3 along_b = b_in_a.rotation * (b.vertices[eb.head] - b.vertices[eb.tail]);
        const Vec3 c = -(b_in_a.rotation * b.faces[eb.left].normal), d = -(b_in_a.rotation * b.faces[eb.right].normal);
        for (const std::uint32_t ia : scratch.edges_a) {
            const Polyhedron::Edge& ea = a.edges[ia];
            const Vec3 &left = a.faces[ea.left].normal, &right = a.faces[ea.right].normal;
            if (!arcs_cross(left, right, c, d)) continue;
            const Vec3 along_a = a.vertices[ea.head] - a.vertices[ea.tail];
            Vec3 n = along_a.cross(along_b);
            const double square = n.squaredNorm();
            if (square < tuning::parallel_edges * along_a.squaredNorm() * along_b.squaredNorm()) continue;
            n /= std::sqrt(square);
            if (n.dot(left + right) < 0.0) n = -n;
            const double separation = n.dot(tail_b - a.vertices[ea.tail]);
            if (separation <= best) continue;
            best = separation;
            axis = {SeparatingAxis::Kind::edges, separation, ia, ib, n};
            if (separation > query.margin) return;
        }
    }
}

// The face of largest separation that shapes separated along `axis` slide past, if there is one; otherwise `axis`.
SeparatingAxis grazed_face(const AxisQuery& query, const SeparatingAxis& axis, double smaller_radius,
                           AxisChoice choice) {
    const Polyhedron &a = query.a, &b = query.b;
    const Pose& b_in_a = query.b_in_a;
    SeparatingAxis grazed = axis;
    const auto search = [&](const Polyhedron& shape, const Polyhedron& other, const Pose& pose, bool of_b) {
        for (std::uint32_t f = 0; f < shape.faces.size(); ++f) {
            const Polyhedron::Face& face = shape.faces[f];
            const double height = face.normal.dot(pose.position) - face.offset;
            if (height - other.inner_radius < -axis_preference(smaller_radius)) continue;
            const Vec3 down = -(pose.rotation.transpose() * face.normal);
            const double reach = other.is_box ? other.half_extent.dot(down.cwiseAbs())
                                              : down.dot(other.vertices[other.support(down, 0)]);
            SeparatingAxis candidate{.kind = of_b ? SeparatingAxis::Kind::face_b : SeparatingAxis::Kind::face_a,
                                     .separation = height - reach,
                                     .feature_a = of_b ? 0 : f,
                                     .feature_b = of_b ? f : 0,
                                     .normal = of_b ? Vec3(-(b_in_a.rotation * face.normal)) : face.normal,
                                     .grazed = true};
            if (slides_past(axis, candidate, query.displacement, smaller_radius, choice) &&
                (!grazed.grazed || candidate.separation > grazed.separation))
                grazed = candidate;
        }
    };
    search(a, b, b_in_a, false);
    search(b, a, inverse(b_in_a), true);
    return grazed;
}

}  // namespace

double edge_reach(EdgeSearch search, double margin, double best_separation) {
    return search == EdgeSearch::all ? std::numeric_limits<double>::infinity() : std::max(margin, -best_separation);
}

double axis_preference(double smaller_radius, AxisChoice choice) {
    return (choice == AxisChoice::steady ? 1e-3 : tuning::impact_touch) * smaller_radius;
}

double face_over_edges(double smaller_radius) { return 0.03 * smaller_radius; }

bool edges_along_face(const SeparatingAxis& edges, const SeparatingAxis& face, double smaller_radius,
                      AxisChoice choice) {
    return choice == AxisChoice::steady && edges.normal.dot(face.normal) > along_face &&
           edges.separation - face.separation < face_over_edges(smaller_radius);
}

bool misses_edges(std::span<const Manifold> of_face, double edges_separation, double smaller_radius) {
    const double seen = edges_separation + axis_preference(smaller_radius);
    return std::all_of(of_face.begin(), of_face.end(), [&](const Manifold& m) {
        return std::all_of(m.points.begin(), m.points.begin() + m.count,
                           [&](const ContactPoint& p) { return p.separation > seen; });
    });
}

bool slides_past(const SeparatingAxis& apart, const SeparatingAxis& face, const Vec3& displacement,
                 double smaller_radius, AxisChoice choice) {
    const double grazing = axis_preference(smaller_radius);
    if (choice != AxisChoice::steady || apart.separation < -grazing || face.separation <= -grazing) return false;
    if (std::abs(face.normal.dot(apart.normal)) >= across_face) return false;
    if (apart.separation < grazing) {
        const double along_apart = std::abs(displacement.dot(apart.normal)),
                     along_face = std::abs(displacement.dot(face.normal));
        if (along_apart > grazing && along_face < 0.5 * along_apart) return true;
        if (along_face > grazing && along_apart < 0.5 * along_face) return false;
    }
    return apart.separation > 0.0 && face.separation < apart.separation;
}

bool may_slide_past(double separation, const Vec3& displacement, double smaller_radius) {
    const double grazing = axis_preference(smaller_radius);
    return separation > 0.0 || (separation > -grazing && displacement.squaredNorm() > grazing * grazing);
}

SeparatingAxis find_separating_axis(const AxisQuery& query, CollisionScratch& scratch, SeparatingAxis* rejected_edges) {
    const Polyhedron &a = query.a, &b = query.b;
    const Pose& b_in_a = query.b_in_a;
    const double margin = query.margin;
    const auto apart = [&](double separation) {
        if (separation <= margin) return false;
        scratch.gap = separation;
        return true;
    };
    const FaceAxis face_a = best_face(a, b, b_in_a, margin);
    if (apart(face_a.separation)) return {};
    const FaceAxis face_b = best_face(b, a, inverse(b_in_a), margin);
    if (apart(face_b.separation)) return {};

    const double preference = axis_preference(std::min(a.radius, b.radius), scratch.choice);
    SeparatingAxis axis;
    if (face_b.separation > face_a.separation + (scratch.was_on_b() ? -preference : preference)) {
        axis = {SeparatingAxis::Kind::face_b, face_b.separation, 0, face_b.face,
                -(b_in_a.rotation * b.faces[face_b.face].normal)};
    } else {
        axis = {SeparatingAxis::Kind::face_a, face_a.separation, face_a.face, 0, a.faces[face_a.face].normal};
    }
    const SeparatingAxis face = axis;
    double best = axis.separation + preference;
    search_edges(query, face_a, face_b, scratch, best, axis);
    if (apart(axis.separation)) return {};
    const double smaller = std::min(a.radius, b.radius);
    const SeparatingAxis edges = axis;
    const bool prefers_face =
        edges.kind == SeparatingAxis::Kind::edges && edges_along_face(edges, face, smaller, scratch.choice);
    if (prefers_face) axis = face;
    if (may_slide_past(axis.separation, query.displacement, smaller)) {
        const SeparatingAxis grazed = grazed_face(query, axis, smaller, scratch.choice);
        if (grazed.grazed) return grazed;
    }
    if (prefers_face && rejected_edges) *rejected_edges = edges;
    return axis;
}

}  // namespace tumble
