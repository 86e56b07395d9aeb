#include "scene/mesh/mesh_loader.h"
#include "scene/mesh/curved_mesh.h"
#include "scene/mesh/mesh_file.h"

#include "scene/mesh/mesh_faces.h"
#include "scene/toml/limits.h"
#include "sim/geometry/shapes/shape.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <unordered_map>

namespace tumble {
namespace {

constexpr double weld_tolerance = 1e-9;  // of the mesh's size: rounding of a transform, far below any modeled detail
constexpr double flat = 1e-14;           // of longest edge squared: a smaller area of a triangle is only rounding

using Corners = std::array<MeshFile::Corner, 3>;

/// Cells of a cubic grid with the vertices in them; only for lookups, never iterated over.
class Lattice {
public:
    Lattice(const Vec3& origin, double cell) : origin_(origin), cell_(cell) {}

    std::array<std::int64_t, 3> cell_of(const Vec3& p) const {
        const Vec3 c = (p - origin_) / cell_;
        return {std::int64_t(std::floor(c.x())), std::int64_t(std::floor(c.y())), std::int64_t(std::floor(c.z()))};
    }
    std::vector<std::uint32_t>& operator[](const std::array<std::int64_t, 3>& cell) {
        std::uint64_t key = 0;  // two cells with one key are harmless, because distances are tested
        for (const std::int64_t c : cell) key = (key ^ std::uint64_t(c)) * 0x9e3779b97f4a7c15u + (key >> 29);
        return cells_[key];
    }

private:
    Vec3 origin_;
    double cell_;
    std::unordered_map<std::uint64_t, std::vector<std::uint32_t>> cells_;
};

bool has_area(const TriangleMesh& mesh, const std::array<std::uint32_t, 3>& t) {
    const Vec3 a = mesh.vertices[t[1]] - mesh.vertices[t[0]], b = mesh.vertices[t[2]] - mesh.vertices[t[0]];
    const double longest = std::max({a.squaredNorm(), b.squaredNorm(), (a - b).squaredNorm()});
    return a.cross(b).norm() > flat * longest;
}

/// The vertices that triangles use, in file order, and the triangles with new indices.
TriangleMesh compact(const std::vector<Vec3>& positions, const std::vector<std::array<std::uint32_t, 3>>& triangles) {
    constexpr std::uint32_t unused = ~std::uint32_t(0);
    std::vector<std::uint32_t> number(positions.size(), unused);
    for (const auto& t : triangles)
        for (const std::uint32_t v : t) number[v] = 0;
    TriangleMesh mesh;
    for (std::size_t v = 0; v < positions.size(); ++v) {
        if (number[v] == unused) continue;
        number[v] = static_cast<std::uint32_t>(mesh.vertices.size());
        mesh.vertices.push_back(positions[v]);
    }
    for (const auto& t : triangles) mesh.triangles.push_back({number[t[0]], number[t[1]], number[t[2]]});
    return mesh;
}

/// Drawn vertices: one for every different (position, normal) among the corners of the surface.
void fill_drawing(const std::vector<Corners>& corners, MeshAsset& asset) {
    const TriangleMesh& mesh = asset.mesh;
    const auto made = crease_normals(mesh);
    std::map<std::pair<std::uint32_t, std::array<float, 3>>, std::uint32_t> drawn;  // (vertex, normal) -> drawn vertex
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
        const Vec3 face = face_normal(mesh, t);
        for (int i = 0; i < 3; ++i) {
            // A normal that points into the body is a fault of the file; a missing one is zero.
            const Vec3& own = corners[t][i].normal;
            const Vec3& n = own.dot(face) > 0.0 ? own : made[t][i];
            const std::uint32_t v = mesh.triangles[t][i];
            const std::array<float, 3> normal{float(n.x()), float(n.y()), float(n.z())};
            const auto [entry, is_new] =
                drawn.try_emplace({v, normal}, static_cast<std::uint32_t>(asset.vertices.size()));
            asset.indices.push_back(entry->second);
            if (!is_new) continue;
            const Vec3& p = mesh.vertices[v];
            asset.vertices.push_back({{float(p.x()), float(p.y()), float(p.z())}, {normal[0], normal[1], normal[2]}});
        }
    }
}

LoadedMesh scaled(const LoadedMesh& mesh, double scale) {
    auto asset = std::make_shared<MeshAsset>(*mesh.asset);
    for (Vec3& v : asset->mesh.vertices) v *= scale;
    for (MeshAsset::Vertex& v : asset->vertices)
        for (float& x : v.position) x = float(x * scale);
    Closedness closedness = mesh.closedness;
    closedness.signed_volume *= scale * scale * scale;
    return {std::move(asset), closedness, mesh.in_meters};
}

}  // namespace

bool LoadedMesh::encloses() const {
    const double extent = asset->mesh.bounds().extent().norm();
    constexpr double rounding =
        1e-12;  // of the diagonal cubed; a closed surface without volume has less, a hair has more
    return closedness.has_volume() && closedness.signed_volume > rounding * extent * extent * extent;
}

std::vector<std::uint32_t> weld(const std::vector<Vec3>& positions) {
    Bounds bounds;
    for (const Vec3& p : positions) bounds.add(p);
    std::vector<std::uint32_t> result(positions.size());
    if (positions.empty()) return result;
    const double tolerance = std::max(weld_tolerance * bounds.extent().norm(), 1e-300);
    Lattice lattice(bounds.min, 4.0 * tolerance);  // mostly one cell per search
    for (std::uint32_t v = 0; v < positions.size(); ++v) {
        const Vec3& p = positions[v];
        const auto low = lattice.cell_of(p.array() - tolerance), high = lattice.cell_of(p.array() + tolerance);
        result[v] = v;
        for (std::int64_t x = low[0]; x <= high[0]; ++x)
            for (std::int64_t y = low[1]; y <= high[1]; ++y)
                for (std::int64_t z = low[2]; z <= high[2]; ++z)
                    for (const std::uint32_t other : lattice[{x, y, z}])
                        if (other < result[v] && (positions[other] - p).norm() <= tolerance) result[v] = other;
        if (result[v] == v) lattice[lattice.cell_of(p)].push_back(v);
    }
    return result;
}

namespace {

/// The triangles that repeat the corners of an earlier one: in the same order, or with `both_sides` in any.
std::vector<char> repeated(const std::vector<std::array<std::uint32_t, 3>>& triangles, bool both_sides) {
    std::vector<std::pair<std::array<std::uint32_t, 3>, std::size_t>> sorted;
    for (std::size_t t = 0; t < triangles.size(); ++t) {
        std::array<std::uint32_t, 3> corners = triangles[t];
        if (both_sides)
            std::sort(corners.begin(), corners.end());
        else
            std::rotate(corners.begin(), std::min_element(corners.begin(), corners.end()), corners.end());
        sorted.push_back({corners, t});
    }
    std::sort(sorted.begin(), sorted.end());
    std::vector<char> result(triangles.size(), 0);
    for (std::size_t i = 1; i < sorted.size(); ++i)
        if (sorted[i].first == sorted[i - 1].first) result[sorted[i].second] = 1;
    return result;
}

/// Drops the marked ones; returns their number.
template <class T>
std::size_t drop(std::vector<T>& values, const std::vector<char>& marked) {
    std::size_t kept = 0;
    for (std::size_t i = 0; i < values.size(); ++i)
        if (!marked[i]) values[kept++] = values[i];
    const std::size_t dropped = values.size() - kept;
    values.resize(kept);
    return dropped;
}

LoadedMesh loaded(const MeshFile& read, const std::filesystem::path& file) {
    const std::vector<std::uint32_t> same = weld(read.positions);

    std::vector<std::array<std::uint32_t, 3>> triangles;
    std::vector<Corners> corners;
    for (const Corners& t : read.triangles) {
        const std::array<std::uint32_t, 3> welded{same[t[0].position], same[t[1].position], same[t[2].position]};
        if (welded[0] == welded[1] || welded[1] == welded[2] || welded[2] == welded[0]) continue;  // collapsed
        triangles.push_back(welded);
        corners.push_back(t);
    }
    // A face that is listed twice counts twice in a volume. One that is listed for each side encloses none, but two
    // solids may share a face.
    const std::vector<char> again = repeated(triangles, false);
    std::size_t doubled = drop(triangles, again);
    drop(corners, again);
    TriangleMesh whole = compact(read.positions, triangles);
    LoadedMesh result{nullptr, closedness(whole), read.in_meters};
    if (!result.closedness.closed()) {
        const std::vector<char> backs = repeated(triangles, true);
        std::vector<std::array<std::uint32_t, 3>> fronts = triangles;
        if (const std::size_t more = drop(fronts, backs); more > 0) {
            TriangleMesh single = compact(read.positions, fronts);
            const std::vector<char> to_flip = triangles_to_flip(single);
            for (std::size_t t = 0; t < fronts.size(); ++t)
                if (to_flip[t]) std::swap(single.triangles[t][1], single.triangles[t][2]);
            if (closedness(single).has_volume()) {
                whole = compact(read.positions, fronts);
                result.closedness = closedness(whole);
                drop(corners, backs);
                doubled += more;
            }
        }
    }

    const auto flip = [&](std::size_t t) {
        std::swap(whole.triangles[t][1], whole.triangles[t][2]);
        std::swap(corners[t][1], corners[t][2]);
    };
    if (result.closedness.crowded_edges > 0) {
        // Normals are not changed: those with the wrong direction are detected when drawn vertices are made.
        const std::vector<char> to_flip = triangles_to_flip(whole);
        for (std::size_t t = 0; t < corners.size(); ++t)
            if (to_flip[t]) flip(t);
        result.closedness = closedness(whole);
    }
    if (result.closedness.closed() && result.closedness.signed_volume < 0.0) {
        for (std::size_t t = 0; t < corners.size(); ++t) {
            flip(t);
            for (auto& corner : corners[t]) corner.normal = -corner.normal;
        }
        result.closedness.signed_volume = -result.closedness.signed_volume;
    }

    // A sliver without area may close a gap, so it counts for closedness; it has no normal, so it is dropped after
    // that.
    std::vector<std::array<std::uint32_t, 3>> kept;
    std::vector<Corners> kept_corners;
    for (std::size_t t = 0; t < corners.size(); ++t) {
        if (!has_area(whole, whole.triangles[t])) continue;
        kept.push_back(whole.triangles[t]);
        kept_corners.push_back(corners[t]);
    }
    if (kept.empty()) throw MeshError("has no triangle with any area");

    auto asset = std::make_shared<MeshAsset>();
    asset->file = file.string();
    asset->doubled_faces = doubled;
    asset->mesh = compact(whole.vertices, kept);
    fill_drawing(kept_corners, *asset);
    asset->paint = make_paint(read, asset->mesh, kept_corners);
    result.asset = std::move(asset);
    return result;
}

/// The triangles of one object, with the positions that they use.
MeshFile object_of(const MeshFile& whole, std::size_t number) {
    const std::size_t first = whole.objects[number];
    const std::size_t last = number + 1 < whole.objects.size() ? whole.objects[number + 1] : whole.triangles.size();
    MeshFile object;
    object.in_meters = whole.in_meters;
    object.colored = whole.colored;
    object.materials = whole.materials;
    object.missing_images = whole.missing_images;
    std::map<std::uint32_t, std::uint32_t> renumbered;
    for (std::size_t t = first; t < last; ++t) {
        Corners corners = whole.triangles[t];
        for (MeshFile::Corner& corner : corners) {
            const auto [entry, is_new] =
                renumbered.try_emplace(corner.position, std::uint32_t(object.positions.size()));
            if (is_new) object.positions.push_back(whole.positions[corner.position]);
            corner.position = entry->second;
        }
        object.triangles.push_back(corners);
    }
    return object;
}

/// A rotation that maps the axis to y, without rounding.
Vec3 upright(const Vec3& v, UpAxis up) {
    switch (up) {
        case UpAxis::x:
            return {-v.y(), v.x(), v.z()};
        case UpAxis::z:
            return {v.x(), v.z(), -v.y()};
        case UpAxis::y:
            break;
    }
    return v;
}

MeshFile read_and_note(const MeshSource& source, std::vector<std::filesystem::path>* read, MeshImports imports) {
    MeshFile mesh = read_mesh_file(source.file, imports);
    if (source.up != UpAxis::y) {
        for (Vec3& position : mesh.positions) position = upright(position, source.up);
        for (Corners& corners : mesh.triangles)
            for (MeshFile::Corner& corner : corners) corner.normal = upright(corner.normal, source.up);
    }
    if (read != nullptr) {
        read->push_back(source.file);
        read->insert(read->end(), mesh.other_files.begin(), mesh.other_files.end());
    }
    return mesh;
}

}  // namespace

LoadedMesh load_mesh(const MeshSource& source, std::vector<std::filesystem::path>* read, MeshImports imports) {
    return loaded(read_and_note(source, read, imports), source.file);
}

LoadedMesh load_made_mesh(const MeshFile& mesh, const std::string& name) { return loaded(mesh, name); }

std::vector<LoadedMesh> load_mesh_objects(const MeshSource& source, std::vector<std::filesystem::path>* read,
                                          MeshImports imports) {
    const MeshFile whole = read_and_note(source, read, imports);
    if (whole.objects.size() > std::size_t(limits::parts))
        throw MeshError(
            fmt::format("holds {} objects (a body has {} parts at most)", whole.objects.size(), limits::parts));
    std::vector<LoadedMesh> result;
    for (std::size_t i = 0; i < whole.objects.size(); ++i) result.push_back(loaded(object_of(whole, i), source.file));
    return result;
}

const LoadedMesh& MeshCache::load(const MeshSource& source, double scale) {
    auto found = loaded_.find(source);
    if (found == loaded_.end()) {
        LoadedMesh made = source.file.empty() ? loaded(supplier_(source.index), "a mesh in memory")
                                              : load_mesh(source, &read_, imports_);
        found = loaded_.emplace(source, std::move(made)).first;
    }
    if (scale == 1.0) return found->second;
    const auto key = std::pair(source, scale);
    auto made = scaled_.find(key);
    if (made == scaled_.end()) made = scaled_.emplace(key, scaled(found->second, scale)).first;
    return made->second;
}

const std::vector<LoadedMesh>& MeshCache::load_objects(const MeshSource& source, double scale) {
    const auto find = [&](double at) { return objects_.find(std::pair(source, at)); };
    if (find(1.0) == objects_.end())
        objects_.emplace(std::pair(source, 1.0), load_mesh_objects(source, &read_, imports_));
    if (find(scale) == objects_.end()) {
        std::vector<LoadedMesh> made;
        for (const LoadedMesh& mesh : find(1.0)->second) made.push_back(scaled(mesh, scale));
        objects_.emplace(std::pair(source, scale), std::move(made));
    }
    return find(scale)->second;
}

Shape MeshCache::enlarged(const Shape& shape, double factor) {
    return std::visit([&](const auto& one) { return Shape(larger(one, factor)); }, shape);
}

template <class Simple>
Simple MeshCache::larger(const Simple& shape, double factor) {
    return tumble::enlarged(shape, factor);
}

MeshShape MeshCache::larger(const MeshShape& shape, double factor) {
    auto& larger = larger_meshes_[{shape.asset.get(), factor}];
    if (!larger.made) larger = {shape.asset, scaled(LoadedMesh{shape.asset, {}}, factor).asset};
    MeshShape result = shape;
    result.asset = larger.made;
    result.thickness *= factor;
    return result;
}

CurvedShape MeshCache::drawn(const CurvedShape& shape) {
    auto& made = curved_[{double(shape.kind), shape.radius, shape.top_radius, shape.height, shape.radii.x(),
                          shape.radii.y(), shape.radii.z()}];
    if (!made) made = curved_mesh(shape);
    CurvedShape result = shape;
    result.drawn = made;
    return result;
}

CurvedShape MeshCache::larger(const CurvedShape& shape, double factor) {
    return drawn(tumble::enlarged(shape, factor));
}

CompoundShape MeshCache::larger(const CompoundShape& shape, double factor) {
    auto& known = larger_compounds_[{shape.parts.get(), factor}];
    if (!known.made) {
        std::vector<CompoundPart> parts = *shape.parts;
        for (CompoundPart& part : parts) {
            part.position *= factor;
            part.shape = enlarged(part.shape, factor);
        }
        known = {shape.parts, std::make_shared<const std::vector<CompoundPart>>(std::move(parts))};
    }
    return {known.made};
}

}  // namespace tumble
