// Polyhedron against polyhedron: the separating axis names the features, the features make the manifold.
#include "sim/collision/feature_contact.h"
#include "sim/collision/separating_axis.h"

namespace tumble {
namespace {

void corners(const Polyhedron& shape, std::uint32_t face, const Pose& pose, std::vector<Vec3>& out) {
    out.clear();
    for (const std::uint32_t v : shape.faces[face].vertices) out.push_back(pose.to_world(shape.vertices[v]));
}

}  // namespace

void collide_polyhedra(const Polyhedron& a, const Pose& pose_a, const Polyhedron& b, const Pose& pose_b, double margin,
                       CollisionScratch& scratch, std::vector<Manifold>& out) {
    const double reach = a.radius + b.radius + margin;
    if ((pose_b.position - pose_a.position).squaredNorm() > reach * reach) return;
    // In A's frame, which keeps the digits of scenes far from the origin.
    const Pose b_in_a{pose_a.to_body(pose_b.position), pose_a.rotation.transpose() * pose_b.rotation};
    const SeparatingAxis axis = find_separating_axis(a, b, b_in_a, margin, scratch);
    const Pose identity;
    const bool overlapping = axis.separation < 0.0;
    switch (axis.kind) {
        case SeparatingAxis::Kind::none: return;
        case SeparatingAxis::Kind::face_a: {
            const std::uint32_t incident = b.face_towards(-(b_in_a.rotation.transpose() * axis.normal));
            corners(a, axis.feature_a, identity, scratch.reference);
            corners(b, incident, b_in_a, scratch.incident);
            scratch.labels = b.faces[incident].vertices;
            add_face_manifold(axis.normal, axis.feature_a, false, pose_a, margin, overlapping, scratch, out);
            return;
        }
        case SeparatingAxis::Kind::face_b: {
            const std::uint32_t incident = a.face_towards(axis.normal);
            corners(b, axis.feature_b, b_in_a, scratch.reference);
            corners(a, incident, identity, scratch.incident);
            scratch.labels = a.faces[incident].vertices;
            add_face_manifold(-axis.normal, axis.feature_b, true, pose_a, margin, overlapping, scratch, out);
            return;
        }
        case SeparatingAxis::Kind::edges: {
            const Polyhedron::Edge &ea = a.edges[axis.feature_a], &eb = b.edges[axis.feature_b];
            add_edge_manifold(a.vertices[ea.tail], a.vertices[ea.head], b_in_a.to_world(b.vertices[eb.tail]),
                              b_in_a.to_world(b.vertices[eb.head]), axis.normal, axis.separation, axis.feature_a,
                              axis.feature_b, pose_a, out);
            return;
        }
    }
}

}  // namespace tumble
