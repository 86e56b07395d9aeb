#include "scene/fracture/cut_body.h"

#include "core/deterministic_math.h"
#include "core/disjoint_sets.h"
#include "core/error.h"
#include "scene/description/looks.h"
#include "scene/fracture/bonds.h"
#include "scene/fracture/convex_parts.h"
#include "scene/fracture/cut_pattern.h"
#include "scene/toml/error_text.h"
#include "scene/toml/limits.h"
#include "sim/geometry/shapes/mesh.h"
#include "sim/geometry/shapes/shape.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <utility>

namespace tumble {
namespace {

// Lengths over the largest extent of the body.
constexpr double cut_rounding = 1e-13;
constexpr double weld_length = 1e-9;      // as of mesh files
constexpr double touch_length = 1e-9;     // of faces that make a bond
constexpr double least_bond_area = 1e-6;  // of the volume to 2/3: slivers of Voronoi cells hold nothing
constexpr double no_volume = 1e-12;       // of the volume: a cell of less is rounding
constexpr double usual_smallest = 1e-3;   // of the cube root of the volume

double cube_root(double value) { return value > 0.0 ? exponential(logarithm(value) / 3.0) : 0.0; }

Color paler(Color color) {
    const auto pale = [](std::uint8_t c) { return std::uint8_t((255 * 9 + c * 11) / 20); };
    return {pale(color.r), pale(color.g), pale(color.b)};
}

struct Cut {
    std::vector<ConvexCell> cells;
    std::vector<const ConvexPart*> part_of;
};

/// Numbers of cells of the parts by their volumes; one of each at least.
std::vector<std::size_t> shares(const std::vector<ConvexPart>& parts, int cells, double volume) {
    std::vector<std::size_t> counts;
    double before = 0.0;
    std::size_t given = 0;
    for (const ConvexPart& part : parts) {
        before += part.cell.volume();
        const auto up_to = std::size_t(std::floor(before / volume * cells + 0.5));
        counts.push_back(std::max<std::size_t>(1, up_to > given ? up_to - given : 0));
        given += counts.back();
    }
    return counts;
}

Cut cut_parts(const std::vector<ConvexPart>& parts, const FractureDescription& fracture, const CutExtent& extent,
              std::uint64_t seed, double volume) {
    Random random(seed, fracture.seed, Random::Purpose::cut);
    const double smallest = fracture.smallest.value_or(usual_smallest * cube_root(volume));
    const CutTolerance tolerance{cut_rounding * extent.bounds.extent().maxCoeff(), smallest * smallest * smallest,
                                 no_volume * volume};
    const std::vector<CutStrip> strips = cut_strips(fracture, extent, random);
    const std::vector<std::size_t> counts = shares(parts, fracture.cells, volume);
    Cut cut;
    for (std::size_t i = 0; i < parts.size(); ++i) {
        const ConvexCell& part = parts[i].cell;
        if (fracture.pattern == FracturePattern::voronoi)
            cut_by_sites(part, draw_sites(part, counts[i], fracture.focus, random), tolerance, cut.cells);
        else
            cut_by_strips(part, strips, tolerance, cut.cells);
        cut.part_of.resize(cut.cells.size(), &parts[i]);
    }
    return cut;
}

/// The cell with the surface that is drawn.
ConvexCell drawn_of(const ConvexCell& cell, const ConvexPart& part, double tolerance) {
    if (part.drawn.empty()) return cell;
    ConvexCell drawn = part.drawn;
    for (const ConvexCell::Face& face : cell.faces)
        if (!face.outer) drawn.clip({face.normal, face.offset}, tolerance);
    return drawn.empty() ? cell : drawn;
}

/// Normals at the corners of faces: of outer faces the mean of those that meet there at small angles.
std::vector<std::vector<Vec3>> corner_normals(const ConvexCell& cell) {
    constexpr double smooth = 0.9;  // cosine: 26 degrees, more than between sides of drawn curved shapes
    std::vector<std::vector<Vec3>> normals(cell.faces.size());
    std::vector<std::vector<std::size_t>> faces_at(cell.vertices.size());
    for (std::size_t f = 0; f < cell.faces.size(); ++f)
        for (const std::uint32_t v : cell.faces[f].vertices)
            if (cell.faces[f].outer) faces_at[v].push_back(f);
    for (std::size_t f = 0; f < cell.faces.size(); ++f)
        for (const std::uint32_t v : cell.faces[f].vertices) {
            Vec3 sum = cell.faces[f].normal;
            if (cell.faces[f].outer)
                for (const std::size_t other : faces_at[v])
                    if (other != f && cell.faces[other].normal.dot(cell.faces[f].normal) > smooth)
                        sum += cell.faces[other].normal;
            normals[f].push_back(sum.normalized());
        }
    return normals;
}

/// The triangles of a flat face. Ambient light is found at vertices: shade at a corner spreads over `rim` m at most.
struct FlatFace {
    std::vector<Vec3> points;
    std::vector<std::array<std::uint32_t, 3>> triangles;
};

FlatFace flat_face(const ConvexCell& cell, const ConvexCell::Face& face, double rim) {
    FlatFace made;
    std::vector<Vec3> corners;
    std::vector<std::uint32_t> first;  // of each corner on the border
    Vec3 center = Vec3::Zero();
    for (const std::uint32_t v : face.vertices) corners.push_back(cell.vertices[v]);
    const std::size_t count = corners.size();
    double nearest = infinity;
    for (std::size_t i = 0; i < count; ++i) {
        const Vec3 &a = corners[i], &b = corners[(i + 1) % count];
        const double length = (b - a).norm();
        first.push_back(std::uint32_t(made.points.size()));
        made.points.push_back(a);
        if (length > 4.0 * rim) {  // the face beyond the edge has the same points
            made.points.push_back(a + rim / length * (b - a));
            made.points.push_back(b + rim / length * (a - b));
        }
        center += a / double(count);
    }
    for (std::size_t i = 0; i < count; ++i) {
        const Vec3 edge = corners[(i + 1) % count] - corners[i];
        nearest = std::min(nearest, face.normal.cross(edge.normalized()).dot(center - corners[i]));
    }
    const auto border = std::uint32_t(made.points.size());
    if (nearest > 2.0 * rim) {
        for (const Vec3& p : corners) made.points.push_back(p + rim / nearest * (center - p));
        for (std::uint32_t i = 0; i < count; ++i) {
            const std::uint32_t next = (i + 1) % std::uint32_t(count), end = next == 0 ? border : first[next];
            const std::uint32_t half = first[i] + (end - first[i]) / 2;
            for (std::uint32_t k = first[i]; k < end; ++k)
                made.triangles.push_back({k, (k + 1) % border, border + (k < half ? i : next)});
            made.triangles.push_back({half, border + next, border + i});
        }
        for (std::uint32_t i = 2; i < count; ++i) made.triangles.push_back({border, border + i - 1, border + i});
    } else if (border > count) {
        made.points.push_back(center);
        for (std::uint32_t k = 0; k < border; ++k) made.triangles.push_back({k, (k + 1) % border, border});
    } else {
        for (std::uint32_t i = 2; i < count; ++i) made.triangles.push_back({0, i - 1, i});
    }
    return made;
}

/// The mesh of a piece. Outer faces look as the part, inner ones have their own color.
std::shared_ptr<const MeshAsset> piece_mesh(const ConvexCell& cell, const ConvexPart& part, const Appearance& look,
                                            Color inner, double tolerance) {
    auto asset = std::make_shared<MeshAsset>();
    asset->mesh = cell.mesh();
    asset->convex = true;
    const ConvexCell drawn = drawn_of(cell, part, tolerance);
    const bool curved = !part.drawn.empty();
    const auto normals = corner_normals(drawn);
    std::vector<MeshAsset::Vertex> own;  // in the frame of the part, where textures have their places
    std::vector<bool> outer;             // of each triangle
    const Quat to_part = part.rotation.conjugate();
    Bounds extent;
    for (const Vec3& p : drawn.vertices) extent.add(to_part * p);
    const double thickness = extent.extent().minCoeff();
    const auto vertex = [](const Vec3& p, const Vec3& n) {
        return MeshAsset::Vertex{{float(p.x()), float(p.y()), float(p.z())},
                                 {float(n.x()), float(n.y()), float(n.z())}};
    };
    for (std::size_t f = 0; f < drawn.faces.size(); ++f) {
        const ConvexCell::Face& face = drawn.faces[f];
        const auto first = std::uint32_t(asset->vertices.size());
        // Curved surfaces have small faces.
        const FlatFace made = flat_face(drawn, face, curved ? infinity : thickness);
        for (std::size_t i = 0; i < made.points.size(); ++i) {
            const Vec3 &p = made.points[i], &n = curved ? normals[f][i] : face.normal;
            asset->vertices.push_back(vertex(p, n));
            own.push_back(vertex(to_part * (p - part.position), to_part * n));
        }
        for (const auto& [a, b, c] : made.triangles) {
            asset->indices.insert(asset->indices.end(), {first + a, first + b, first + c});
            outer.push_back(face.outer);
        }
    }
    const auto paint = std::make_shared<MeshPaint>(*texture_paint(*part.shape, look, own, asset->indices));
    MeshMaterial of_cut;
    const std::array<double, 3> linear = to_linear(inner);
    for (std::size_t c = 0; c < 3; ++c) of_cut.color[c] = float(linear[c]);
    paint->materials.push_back(of_cut);
    for (std::size_t t = 0; t < outer.size(); ++t)
        if (!outer[t]) paint->material_of_triangle[t] = 1;
    asset->paint = paint;
    return asset;
}

BodyDescription piece_of(const BodyDescription& whole, const ConvexCell& cell, const ConvexPart& part,
                         double tolerance) {
    BodyDescription piece = whole;
    piece.type = BodyType::dynamic;
    piece.fracture = nullptr;
    piece.keyframes.clear();
    Appearance look = whole.appearance;
    look.color = part.color.value_or(mean_color(look));
    if (look.texture) look.color = part.color.value_or(whole.appearance.color);
    if (const auto* mesh = std::get_if<MeshShape>(part.shape); mesh != nullptr && mesh->painted && !look.has_image())
        look.color = mesh->asset->paint->mean;
    const Color inner = whole.fracture->inner_color.value_or(paler(look.color));
    MeshShape shape{piece_mesh(cell, part, look, inner, tolerance)};
    shape.painted = true;
    piece.shape = std::move(shape);
    piece.appearance.color = look.color;
    piece.appearance.visible = whole.appearance.visible && part.visible;
    piece.appearance.pattern = Pattern::panel;  // the paint has the texture
    piece.appearance.pattern_color.reset();
    piece.appearance.texture = piece.appearance.normal_map = piece.appearance.roughness_map = nullptr;
    return piece;
}

/// Masses by volumes, in each part; the last piece takes the rest of the whole's, so that they add up to it.
void share_mass(const BodyDescription& whole, const Cut& cut, std::vector<BodyDescription>& pieces) {
    const double mass = mass_properties(whole).mass;
    std::map<const ConvexPart*, double> volumes;  // looked up only
    for (std::size_t i = 0; i < cut.cells.size(); ++i) volumes[cut.part_of[i]] += cut.cells[i].volume();
    std::vector<double> weights;
    double sum = 0.0;
    for (std::size_t i = 0; i < cut.cells.size(); ++i) {
        const ConvexPart& part = *cut.part_of[i];
        weights.push_back(mass_properties(*part.shape, part.density).mass / volumes[&part] * cut.cells[i].volume());
        sum += weights.back();
    }
    double before = 0.0;
    for (std::size_t i = 0; i < pieces.size(); ++i) {
        // A multiple of the last bit of the whole's mass: sums are exact.
        const double share = (weights[i] / sum * mass + mass) - mass,
                     own = i + 1 < pieces.size() ? share : mass - before;
        before += own;
        pieces[i].mass = own;
        pieces[i].density = own / cut.cells[i].volume();
    }
}

/// Polyhedra of curved shapes lack matter at the surface: its moments are shared by mass, so that a body that comes
/// apart keeps its angular momentum.
void share_inertia(const BodyDescription& whole, std::vector<BodyDescription>& pieces) {
    std::vector<MassProperties> parts;
    for (const BodyDescription& piece : pieces) parts.push_back(mass_properties(piece));
    const MassProperties sum = sum_of_masses(parts);
    const Mat3 missing = mass_properties(whole).inertia - sum.inertia;
    for (std::size_t i = 0; i < pieces.size(); ++i) {
        const Mat3 own = parts[i].inertia + parts[i].mass / sum.mass * missing;
        pieces[i].inertia = {own(0, 0), own(1, 1), own(2, 2), own(0, 1), own(0, 2), own(1, 2)};
    }
}

/// Fails where the bonds leave more than one body.
void check_joined(const std::vector<Bond>& bonds, std::size_t cells) {
    DisjointSets groups(cells + 1);  // the last one is the world
    for (const Bond& bond : bonds) groups.join(bond.a, bond.b == Bond::world ? cells : bond.b);
    const bool held = groups.root(cells) != cells;
    for (std::size_t i = 0; i < cells; ++i)
        if (groups.root(i) != groups.root(held ? cells : 0))
            throw InputError(
                "needs a body of one piece, and some of its cells share no face with the others, or nothing holds "
                "them: "
                "let parts of compounds touch by flat faces");
}

void check(const BodyDescription& whole, const Bounds& bounds, double volume) {
    const FractureDescription& fracture = *whole.fracture;
    const double longest = bounds.extent().maxCoeff();
    if (fracture.smallest && *fracture.smallest < limits::least_cell * longest)
        throw InputError(
            fmt::format("has a smallest cell of {} m, and must have at least {} of the longest extent, {} m",
                        number_text(*fracture.smallest), number_text(limits::least_cell), number_text(longest)));
    if (const double s = fracture.smallest.value_or(0.0); 2.0 * s * s * s > volume)
        throw InputError(fmt::format("leaves one cell of at least {} m: give a smaller `smallest`, or a larger body",
                                     number_text(s)));
    if (whole.center_of_mass || whole.inertia)
        throw InputError("is for bodies whose mass follows from their shape: give neither center_of_mass nor inertia");
}

}  // namespace

CutBody cut_body(const BodyDescription& whole, std::uint64_t seed) {
    const FractureDescription& fracture = *whole.fracture;
    const std::vector<ConvexPart> parts = convex_parts(whole);
    CutExtent extent;
    double volume = 0.0;
    for (const ConvexPart& part : parts) {
        volume += part.cell.volume();
        extent.corners.insert(extent.corners.end(), part.cell.vertices.begin(), part.cell.vertices.end());
        extent.bounds.add(part.cell.bounds());
    }
    check(whole, extent.bounds, volume);
    const double longest = extent.bounds.extent().maxCoeff();
    Cut cut = cut_parts(parts, fracture, extent, seed, volume);
    if (cut.cells.size() < 2) throw InputError("leaves one cell: give more `cells`, or a smaller `smallest`");

    CutBody made;
    std::vector<Vec3> centers;
    for (std::size_t i = 0; i < cut.cells.size(); ++i) {
        cut.cells[i].weld(weld_length * longest);
        centers.push_back(mesh_mass(cut.cells[i].mesh(), 1.0).center_of_mass);
        made.pieces.push_back(piece_of(whole, cut.cells[i], *cut.part_of[i], cut_rounding * longest));
    }
    share_mass(whole, cut, made.pieces);
    if (std::ranges::any_of(parts, [](const ConvexPart& part) { return !part.drawn.empty(); }))
        share_inertia(whole, made.pieces);
    const double root = cube_root(volume);
    const BondRequest request{cut.cells, centers, touch_length * longest, least_bond_area * root * root};
    made.bonds = find_bonds(request);
    if (whole.type != BodyType::dynamic) {
        const std::size_t inner = made.bonds.size();
        hold_to_world(request, extent.bounds, fracture.held, made.bonds);
        if (made.bonds.size() == inner)
            throw InputError(
                "has no face in the held sides of its bounds: give `held` with the sides that hold it to the world");
    }
    check_joined(made.bonds, cut.cells.size());
    return made;
}

}  // namespace tumble
