#include "scene/description/shape_mass.h"

#include "core/deterministic_math.h"

namespace tumble {
namespace {

/// Relative to the middle of the bounds, so that a mesh far from its origin loses no digits.
MassCenter mass_of_mesh(const TriangleMesh& mesh, double density) {
    const Vec3 apex = mesh.bounds().center();
    double volume = 0.0;
    Vec3 first = Vec3::Zero();  // integral of x dV
    for (const auto& t : mesh.triangles) {
        const Vec3 a = mesh.vertices[t[0]] - apex, b = mesh.vertices[t[1]] - apex, c = mesh.vertices[t[2]] - apex;
        const double det = a.dot(b.cross(c));  // six times the tetrahedron's signed volume
        volume += det / 6.0;
        first += det / 24.0 * (a + b + c);
    }
    if (!(volume > 0.0)) return {};
    return {density * volume, apex + first / volume};
}

MassCenter mass_of_described_shape(const Shape& shape, double density) {
    if (const auto* box = std::get_if<BoxShape>(&shape)) return {density * box->size.prod(), Vec3::Zero()};
    if (const auto* ball = std::get_if<SphereShape>(&shape))
        return {density * 4.0 / 3.0 * pi * ball->radius * ball->radius * ball->radius, Vec3::Zero()};
    if (const auto* mesh = std::get_if<MeshShape>(&shape)) return mass_of_mesh(mesh->asset->mesh, density);
    MassCenter whole;
    if (const auto* compound = std::get_if<CompoundShape>(&shape)) {
        Vec3 first = Vec3::Zero();
        for (const CompoundPart& part : *compound->parts) {
            const MassCenter one = mass_of_described_shape(part.shape, part.density.value_or(density));
            whole.mass += one.mass;
            first += one.mass * (part.position + part.rotation * one.center);
        }
        if (whole.mass > 0.0) whole.center = first / whole.mass;
    }
    return whole;
}

}  // namespace

MassCenter mass_center(const BodyDescription& body) {
    MassCenter result = mass_of_described_shape(body.shape, body.density);
    if (body.mass) result.mass = *body.mass;
    return result;
}

}  // namespace tumble
