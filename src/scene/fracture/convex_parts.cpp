#include "scene/fracture/convex_parts.h"

#include "core/error.h"
#include "scene/mesh/curved_mesh.h"
#include "sim/geometry/shapes/hull.h"
#include "sim/geometry/shapes/mesh.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace tumble {
namespace {

// Pieces of curved shapes collide with a quarter of the sides that are drawn, up to 2 % of a radius inside of the
// surface: the cost of a contact between polyhedra grows as the product of their edges.
constexpr int collision_coarseness = 4;

ConvexCell box_cell(const Vec3& size) {
    ConvexCell cell;
    const Vec3 half = 0.5 * size;
    for (unsigned corner = 0; corner < 8; ++corner)
        cell.vertices.emplace_back(corner & 1 ? half.x() : -half.x(), corner & 2 ? half.y() : -half.y(),
                                   corner & 4 ? half.z() : -half.z());
    const std::vector<std::uint32_t> loops[] = {{0, 4, 6, 2}, {1, 3, 7, 5}, {0, 1, 5, 4},
                                                {2, 6, 7, 3}, {0, 2, 3, 1}, {4, 5, 7, 6}};
    for (int side = 0; side < 6; ++side)
        cell.faces.push_back({Vec3::Unit(side / 2) * (side % 2 == 0 ? -1.0 : 1.0), half[side / 2], loops[side], true});
    return cell;
}

ConvexCell cell_of(const Polyhedron& hull) {
    ConvexCell cell;
    cell.vertices = hull.vertices;
    for (const Polyhedron::Face& face : hull.faces)
        cell.faces.push_back({face.normal, face.offset, face.vertices, true});
    return cell;
}

/// The mesh itself where its faces are flat to rounding, otherwise its hull.
ConvexCell mesh_cell(const TriangleMesh& mesh) {
    if (const auto hull = convex_polyhedron(mesh, Vec3::Zero())) return cell_of(*hull);
    return cell_of(make_hull(mesh.vertices, Vec3::Zero()));
}

CurvedShape as_curved(const SphereShape& ball) {
    CurvedShape round;
    round.kind = CurvedKind::ellipsoid;
    round.radii = Vec3::Constant(ball.radius);
    return round;
}

/// The surface that is drawn of a curved shape; empty for others.
ConvexCell drawn_cell(const Shape& shape) {
    if (const auto* ball = std::get_if<SphereShape>(&shape)) return mesh_cell(curved_mesh(as_curved(*ball))->mesh);
    if (const auto* curved = std::get_if<CurvedShape>(&shape)) return mesh_cell(curved_mesh(*curved)->mesh);
    return {};
}

struct PartCell {
    ConvexCell operator()(const BoxShape& box) const { return box_cell(box.size); }
    ConvexCell operator()(const SphereShape& ball) const { return (*this)(as_curved(ball)); }
    ConvexCell operator()(const CurvedShape& curved) const {
        return mesh_cell(curved_mesh(curved, 1, collision_coarseness)->mesh);
    }
    ConvexCell operator()(const MeshShape& mesh) const {
        constexpr double rounding = 1e-6;  // of the volume: a dent of less is of the file's digits
        if (mesh.mass_from == MassFrom::shell)
            throw InputError("is for solid bodies (given the shell of a mesh): give mass_from = \"solid\"");
        ConvexCell cell = mesh_cell(mesh.asset->mesh);
        const double whole = cell.volume(), solid = mesh_mass(mesh.asset->mesh, 1.0).mass;
        if (!(std::abs(solid - whole) <= rounding * whole))
            throw InputError(
                "needs convex parts, and the mesh is concave or open: divide it into convex objects and give parts = "
                "\"objects\", or a compound of convex shapes");
        return cell;
    }
    ConvexCell operator()(const PlaneShape&) const {
        throw InputError("is for bodies of finite size (given a plane, which is endless)");
    }
    ConvexCell operator()(const CompoundShape&) const { return {}; }  // read as its parts
};

void place(ConvexCell& cell, const Vec3& position, const Quat& rotation) {
    for (Vec3& v : cell.vertices) v = position + rotation * v;
    for (ConvexCell::Face& face : cell.faces) {
        face.normal = rotation * face.normal;
        face.offset += face.normal.dot(position);
    }
}

void check_apart(const std::vector<ConvexPart>& parts) {
    constexpr double rounding = 1e-6;  // of the smaller part
    for (std::size_t i = 0; i < parts.size(); ++i)
        for (std::size_t j = 0; j < i; ++j) {
            ConvexCell shared = parts[i].cell;
            const Bounds bounds = shared.bounds(), other = parts[j].cell.bounds();
            if (!bounds.overlaps(other)) continue;
            for (const ConvexCell::Face& face : parts[j].cell.faces)
                shared.clip({face.normal, face.offset}, 1e-12 * bounds.extent().norm());
            if (shared.volume() > rounding * std::min(parts[i].cell.volume(), parts[j].cell.volume()))
                throw InputError("needs parts beside each other, and two parts of the compound overlap");
        }
}

}  // namespace

std::vector<ConvexPart> convex_parts(const BodyDescription& body) {
    std::vector<ConvexPart> parts;
    const auto* compound = std::get_if<CompoundShape>(&body.shape);
    if (compound == nullptr) {
        parts.push_back({std::visit(PartCell(), body.shape), drawn_cell(body.shape), &body.shape, Vec3::Zero(),
                         Quat::Identity(), body.density, std::nullopt, true});
        return parts;
    }
    for (const CompoundPart& part : *compound->parts) {
        if (!part.collide) throw InputError("needs parts that collide, and a part of the compound does not");
        ConvexCell cell = std::visit(PartCell(), part.shape), drawn = drawn_cell(part.shape);
        place(cell, part.position, part.rotation);
        place(drawn, part.position, part.rotation);
        parts.push_back({std::move(cell), std::move(drawn), &part.shape, part.position, part.rotation,
                         part.density.value_or(body.density), part.color, part.visible});
    }
    check_apart(parts);
    return parts;
}

}  // namespace tumble
