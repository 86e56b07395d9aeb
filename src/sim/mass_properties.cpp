#include "sim/mass_properties.h"

#include "core/elementary.h"

namespace tumble {

MassProperties box_mass(const Vec3& size, double density) {
    MassProperties p;
    p.mass = density * size.x() * size.y() * size.z();
    const Vec3 s = size.cwiseProduct(size);
    p.inertia.diagonal() = p.mass / 12.0 * Vec3(s.y() + s.z(), s.z() + s.x(), s.x() + s.y());
    return p;
}

MassProperties sphere_mass(double radius, double density) {
    MassProperties p;
    p.mass = density * 4.0 / 3.0 * pi * radius * radius * radius;
    p.inertia.diagonal().setConstant(0.4 * p.mass * radius * radius);
    return p;
}

MassProperties mesh_mass(const TriangleMesh& mesh, double density) {
    // From the middle of the bounds, so that a mesh far from its origin loses no digits.
    const Vec3 apex = mesh.bounds().center();
    double volume = 0.0;
    Vec3 first = Vec3::Zero();                  // integral of x dV
    Mat3 second = Mat3::Zero();                 // integral of x x^T dV
    for (const auto& t : mesh.triangles) {
        const Vec3 a = mesh.vertices[t[0]] - apex, b = mesh.vertices[t[1]] - apex, c = mesh.vertices[t[2]] - apex;
        const double det = a.dot(b.cross(c));   // six times the tetrahedron's signed volume
        const Vec3 sum = a + b + c;
        volume += det / 6.0;
        first += det / 24.0 * sum;
        // Integral of x x^T over the tetrahedron (0, a, b, c): det/120 (aa + bb + cc + (a+b+c)(a+b+c)).
        second += det / 120.0 *
                  (a * a.transpose() + b * b.transpose() + c * c.transpose() + sum * sum.transpose());
    }
    MassProperties p;
    p.mass = density * volume;
    const Vec3 center = first / volume;
    const Mat3 covariance = density * (second - volume * center * center.transpose());
    p.inertia = covariance.trace() * Mat3::Identity() - covariance;
    p.center_of_mass = apex + center;
    return p;
}

MassProperties with_mass(const MassProperties& properties, double mass) {
    MassProperties p = properties;
    p.inertia *= mass / properties.mass;
    p.mass = mass;
    return p;
}

}  // namespace tumble
