#include "sim/geometry/nearest_simplex.h"

namespace tumble {
namespace {

Vec3 nearest_on_segment(Simplex& s) {
    const Vec3 a = s.points[0], b = s.points[1], ab = b - a;
    const double t = -a.dot(ab);
    if (t <= 0.0) return s.size = 1, a;
    const double square = ab.squaredNorm();
    if (t >= square) return s.points[0] = b, s.size = 1, b;
    return a + (t / square) * ab;
}

Vec3 nearest_of_edges(Simplex& s) {
    const Simplex triangle = s;
    Vec3 best = Vec3::Zero();
    double distance = infinity;
    for (int i = 0; i < 3; ++i) {
        Simplex edge;
        edge.points[0] = triangle.points[std::size_t(i)];
        edge.points[1] = triangle.points[std::size_t((i + 1) % 3)];
        edge.size = 2;
        const Vec3 p = nearest_on_segment(edge);
        if (p.squaredNorm() >= distance) continue;
        distance = p.squaredNorm();
        best = p;
        s = edge;
    }
    return best;
}

Vec3 nearest_on_triangle(Simplex& s) {
    const Vec3 a = s.points[0], ab = s.points[1] - a, ac = s.points[2] - a, n = ab.cross(ac);
    const double square = n.squaredNorm();
    if (square == 0.0) return nearest_of_edges(s);
    // Barycentric coordinates of the origin's projection.
    const double v = n.dot(ac.cross(a)) / square, w = n.dot(a.cross(ab)) / square;
    if (v < 0.0 || w < 0.0 || v + w > 1.0) return nearest_of_edges(s);
    return (n.dot(a) / square) * n;
}

Vec3 nearest_on_tetrahedron(Simplex& s) {
    const Simplex whole = s;
    Vec3 best = Vec3::Zero();
    double distance = infinity;
    bool inside = true;
    for (std::size_t skip = 0; skip < 4; ++skip) {
        Simplex face;
        for (std::size_t i = 0; i < 4; ++i)
            if (i != skip) face.points[std::size_t(face.size++)] = whole.points[i];
        const Vec3 n = (face.points[1] - face.points[0]).cross(face.points[2] - face.points[0]);
        const double origin = -n.dot(face.points[0]), opposite = n.dot(whole.points[skip] - face.points[0]);
        if (origin * opposite > 0.0) continue;  // the origin is on the inner side of this face
        inside = false;
        const Vec3 p = nearest_on_triangle(face);
        if (p.squaredNorm() >= distance) continue;
        distance = p.squaredNorm();
        best = p;
        s = face;
    }
    return inside ? Vec3(Vec3::Zero()) : best;
}

}  // namespace

Vec3 nearest(Simplex& s) {
    switch (s.size) {
        case 1:
            return s.points[0];
        case 2:
            return nearest_on_segment(s);
        case 3:
            return nearest_on_triangle(s);
        default:
            return nearest_on_tetrahedron(s);
    }
}

}  // namespace tumble
