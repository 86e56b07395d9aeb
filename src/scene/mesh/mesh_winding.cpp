#include "scene/mesh/mesh_winding.h"

#include "core/mesh_components.h"

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

}  // namespace tumble
