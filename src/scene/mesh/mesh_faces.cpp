#include "scene/mesh/mesh_faces.h"

#include "core/deterministic_math.h"
#include "core/triangle_mesh.h"

namespace tumble {

namespace {

/// One component, wound like its first triangle.
struct Piece {
    double volume = 0.0;        // m^3
    double flipped_area = 0.0;  // of triangles that are flipped, less that of the others, m^2
    bool disagrees = false, closed = true;
    bool to_flip() const { return closed ? volume < 0.0 : flipped_area > 0.0; }
};

}  // namespace

std::vector<char> triangles_to_flip(const TriangleMesh& mesh) {
    const MeshComponents sheets = find_sheets(mesh.triangles);
    std::vector<Piece> pieces(mesh.triangles.size());  // at the first triangle of each
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
        if (sheets.sheet[t] == MeshComponents::none) continue;
        Piece& piece = pieces[sheets.sheet[t]];
        const auto& v = mesh.triangles[t];
        const Vec3& o = mesh.vertices[mesh.triangles[sheets.sheet[t]][0]];
        const Vec3 a = mesh.vertices[v[0]] - o, b = mesh.vertices[v[1]] - o, c = mesh.vertices[v[2]] - o;
        const double area = 0.5 * (b - a).cross(c - a).norm(), volume = a.dot(b.cross(c)) / 6.0;
        const bool flipped = sheets.flipped[t] != 0;
        piece.volume += flipped ? -volume : volume;
        piece.flipped_area += flipped ? area : -area;
        piece.disagrees = piece.disagrees || flipped;
        piece.closed = piece.closed && !sheets.rim[t];
    }
    std::vector<char> result(mesh.triangles.size(), 0);
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
        if (sheets.sheet[t] == MeshComponents::none) continue;
        const Piece& piece = pieces[sheets.sheet[t]];
        if (piece.disagrees) result[t] = char(sheets.flipped[t] ^ char(piece.to_flip()));
    }
    return result;
}

namespace {

constexpr double crease_angle = 40.0;  // degrees: a tube of 10 sides is smooth, one of 8 has edges

constexpr std::size_t most_faces_at_a_vertex =
    2000;  // a larger fan is drawn flat, because its cost grows with the square

struct Incidence {
    std::uint32_t triangle;
    double angle;  // rad, of the triangle at the vertex
};

double corner_angle(const TriangleMesh& mesh, std::size_t triangle, int corner) {
    const auto& t = mesh.triangles[triangle];
    const Vec3& p = mesh.vertices[t[corner]];
    const Vec3 a = mesh.vertices[t[(corner + 1) % 3]] - p, b = mesh.vertices[t[(corner + 2) % 3]] - p;
    return atan2_stable(a.cross(b).norm(), a.dot(b));
}

}  // namespace

Vec3 face_normal(const TriangleMesh& mesh, std::size_t triangle) {
    const auto& t = mesh.triangles[triangle];
    const Vec3& p = mesh.vertices[t[0]];
    return (mesh.vertices[t[1]] - p).cross(mesh.vertices[t[2]] - p).stableNormalized();
}

std::vector<std::array<Vec3, 3>> crease_normals(const TriangleMesh& mesh) {
    const double crease = sincos(crease_angle * pi / 180.0).cos;
    std::vector<Vec3> normals;
    std::vector<std::vector<Incidence>> around(mesh.vertices.size());
    for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t) {
        normals.push_back(face_normal(mesh, t));
        for (int i = 0; i < 3; ++i) around[mesh.triangles[t][i]].push_back({t, corner_angle(mesh, t, i)});
    }
    std::vector<std::array<Vec3, 3>> result(mesh.triangles.size());
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
        for (int i = 0; i < 3; ++i) {
            const std::vector<Incidence>& neighbors = around[mesh.triangles[t][i]];
            if (neighbors.size() > most_faces_at_a_vertex) {
                result[t][i] = normals[t];
                continue;
            }
            Vec3 sum = Vec3::Zero();
            for (const Incidence& other : neighbors) {
                if (normals[other.triangle].dot(normals[t]) > crease) sum += other.angle * normals[other.triangle];
            }
            // The faces of a crease group differ from this one by less than the crease angle, so the sum cannot vanish.
            result[t][i] = sum.normalized();
        }
    }
    return result;
}

}  // namespace tumble
