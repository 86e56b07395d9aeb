#include "scene/fracture/cut_pattern.h"

#include "core/deterministic_math.h"
#include "core/error.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <iterator>
#include <utility>

namespace tumble {
namespace {

int nearest_whole(double value) { return int(std::floor(value + 0.5)); }

int longest_axis(const Vec3& extent) {
    return extent.x() >= extent.y() && extent.x() >= extent.z() ? 0 : extent.y() >= extent.z() ? 1 : 2;
}

std::vector<CutStrip> slabs(const FractureRequest& request, const CutExtent& extent) {
    const Vec3 axis = request.axis.value_or(Vec3(Vec3::Unit(longest_axis(extent.bounds.extent()))));
    double low = infinity, high = -infinity;
    for (const Vec3& p : extent.corners) {
        low = std::min(low, axis.dot(p));
        high = std::max(high, axis.dot(p));
    }
    CutStrip strip;
    for (int k = 1; k < request.cells; ++k) strip.cuts.push_back({axis, low + (high - low) * k / request.cells});
    return {strip};
}

/// Planes square to an axis that divide the bounds into equal parts, `shift` of a part later.
std::vector<CutPlane> equal_cuts(const Bounds& bounds, int axis, int parts, double shift = 0.0) {
    std::vector<CutPlane> planes;
    const double step = bounds.extent()[axis] / parts;
    for (int k = shift > 0.0 ? 0 : 1; k < parts; ++k)
        planes.push_back({Vec3::Unit(axis), bounds.min[axis] + (k + shift) * step});
    return planes;
}

/// The sides of part number k of those between planes.
void add_sides(const std::vector<CutPlane>& planes, std::size_t k, std::vector<CutPlane>& sides) {
    if (k > 0) sides.push_back(planes[k - 1].flipped());
    if (k < planes.size()) sides.push_back(planes[k]);
}

/// Bricks twice as long as high, and as thick as high in a wall that is thicker than two of them.
std::vector<CutStrip> bricks(const FractureRequest& request, const Bounds& bounds) {
    const Vec3 extent = bounds.extent();
    const int along = extent.x() >= extent.z() ? 0 : 2, across = 2 - along;
    const double length = extent[along], height = extent.y(), depth = extent[across];
    double brick = std::sqrt(0.5 * length * height / request.cells);
    const bool thick = depth > 2.0 * brick;
    if (thick) brick = exponential(logarithm(0.5 * length * height * depth / request.cells) / 3.0);
    const auto parts = [](double whole, double part) { return std::max(1, nearest_whole(whole / part)); };
    const std::vector<CutPlane> rows = equal_cuts(bounds, 1, parts(height, brick)),
                                leaves = equal_cuts(bounds, across, thick ? parts(depth, brick) : 1);
    const int in_row = parts(length, 2.0 * brick);
    std::vector<CutStrip> strips;
    for (std::size_t row = 0; row <= rows.size(); ++row)
        for (std::size_t leaf = 0; leaf <= leaves.size(); ++leaf) {
            CutStrip strip;
            add_sides(rows, row, strip.sides);
            add_sides(leaves, leaf, strip.sides);
            strip.cuts = equal_cuts(bounds, along, in_row, row % 2 == 1 ? 0.5 : 0.0);
            strips.push_back(std::move(strip));
        }
    return strips;
}

/// Spokes through the focus, square to the plane of the two longest extents, and rings of chords between them, whose
/// radii grow in proportion up to the farthest corner.
std::vector<CutStrip> radial(const FractureRequest& request, const CutExtent& extent, Random& random) {
    constexpr double first_ring = 0.1;   // of the radius of the farthest corner
    constexpr double spoke_noise = 0.4;  // of the angle between spokes: three of them stay below half a turn
    constexpr double ring_noise = 0.6;   // of the noise at which two rings could meet
    const Vec3 sizes = extent.bounds.extent();
    const int across = longest_axis(-sizes);
    const Vec3 normal = Vec3::Unit(across), u = Vec3::Unit((across + 1) % 3), v = Vec3::Unit((across + 2) % 3);
    const Vec3 focus = request.focus.value_or(extent.bounds.center());
    double farthest = 0.0;
    for (const Vec3& p : extent.corners) farthest = std::max(farthest, hypotenuse(u.dot(p - focus), v.dot(p - focus)));

    // Cells are about as wide as long: the ratio of two rings is 1 + 2 pi / spokes.
    const double growth = -logarithm(first_ring) / (2.0 * pi);
    const int spokes =
        std::max(3, nearest_whole((std::sqrt(1.0 + 4.0 * growth * request.cells) - 1.0) / (2.0 * growth)));
    const int rings = std::max(1, nearest_whole(double(request.cells) / spokes));
    const double ratio = rings > 1 ? exponential(-logarithm(first_ring) / (rings - 1)) : 1.0;
    const double spread = ring_noise * (ratio - 1.0) / (ratio + 1.0);

    std::vector<Vec3> directions;
    std::vector<CutPlane> planes;
    const double start = 2.0 * pi * random.unit();
    for (int s = 0; s < spokes; ++s) {
        const SinCos angle = sincos(start + 2.0 * pi * (s + spoke_noise * (random.unit() - 0.5)) / spokes);
        directions.push_back(angle.cos * u + angle.sin * v);
        const Vec3 left = normal.cross(directions.back());
        planes.push_back({left, left.dot(focus)});
    }
    std::vector<std::vector<Vec3>> corners(directions.size());  // of the rings, on each spoke
    for (std::size_t s = 0; s < corners.size(); ++s)
        for (int k = 1; k < rings; ++k) {
            const double radius = farthest * exponential(logarithm(first_ring) * (rings - k) / (rings - 1));
            corners[s].push_back(focus + radius * (1.0 + random.between(-spread, spread)) * directions[s]);
        }
    std::vector<CutStrip> strips;
    for (std::size_t s = 0; s < planes.size(); ++s) {
        const std::size_t next = (s + 1) % planes.size();
        CutStrip strip{{planes[s].flipped(), planes[next]}, {}};
        for (std::size_t k = 0; k < corners[s].size(); ++k) {
            const Vec3 outward = (corners[next][k] - corners[s][k]).cross(normal).normalized();
            strip.cuts.push_back({outward, outward.dot(corners[s][k])});
        }
        strips.push_back(std::move(strip));
    }
    return strips;
}

bool is_inside(const ConvexCell& part, const Vec3& p) {
    return std::all_of(part.faces.begin(), part.faces.end(),
                       [&](const ConvexCell::Face& face) { return face.normal.dot(p) < face.offset; });
}

Vec3 draw_inside(const ConvexCell& part, const Bounds& bounds, Random& random) {
    constexpr int attempts = 100'000;  // a needle along the diagonal of its bounds fills a thousandth of them
    for (int i = 0; i < attempts; ++i) {
        const Vec3 p = bounds.center() + random.in_box(0.5 * bounds.extent());
        if (is_inside(part, p)) return p;
    }
    throw InputError("finds no place for a cell: the shape is too thin along a slant");
}

/// The plane half way from one site to the other, the same for both.
CutPlane between(const std::vector<Vec3>& sites, std::size_t from, std::size_t to) {
    const std::size_t low = std::min(from, to), high = std::max(from, to);
    const Vec3 normal = (sites[high] - sites[low]).normalized();
    const CutPlane plane{normal, 0.5 * normal.dot(sites[low] + sites[high])};
    return from == low ? plane : plane.flipped();
}

/// The part of the convex part that is nearest to a site.
ConvexCell voronoi_cell(const ConvexCell& part, const std::vector<Vec3>& sites, std::size_t i, double tolerance) {
    ConvexCell cell = part;
    using Near = std::pair<double, std::size_t>;  // squared distance, site
    std::vector<Near> others;
    for (std::size_t j = 0; j < sites.size(); ++j)
        if (j != i) others.emplace_back((sites[j] - sites[i]).squaredNorm(), j);
    std::make_heap(others.begin(), others.end(), std::greater<>());
    const auto reach = [&] {
        double most = 0.0;
        for (const Vec3& v : cell.vertices) most = std::max(most, (v - sites[i]).squaredNorm());
        return most;
    };
    double most = reach();
    while (!others.empty() && !cell.empty()) {
        std::pop_heap(others.begin(), others.end(), std::greater<>());
        const auto [square, j] = others.back();
        others.pop_back();
        if (square > 4.0 * most) break;  // half way to it lies beyond all vertices
        cell.clip(between(sites, i, j), tolerance);
        most = reach();
    }
    return cell;
}

}  // namespace

std::vector<CutStrip> cut_strips(const FractureRequest& request, const CutExtent& extent, Random& random) {
    switch (request.pattern) {
        case FracturePattern::slabs:
            return slabs(request, extent);
        case FracturePattern::bricks:
            return bricks(request, extent.bounds);
        case FracturePattern::radial:
            return radial(request, extent, random);
        case FracturePattern::voronoi:
            break;
    }
    return {};
}

void cut_by_strips(const ConvexCell& part, const std::vector<CutStrip>& strips, const CutTolerance& tolerance,
                   std::vector<ConvexCell>& cells) {
    for (const CutStrip& strip : strips) {
        ConvexCell rest = part;
        for (const CutPlane& side : strip.sides) rest.clip(side, tolerance.length);
        if (!(rest.volume() > tolerance.no_volume)) continue;
        for (const CutPlane& cut : strip.cuts) {
            ConvexCell inside = rest, beyond = rest;
            inside.clip(cut, tolerance.length);
            beyond.clip(cut.flipped(), tolerance.length);
            if (inside.volume() < tolerance.least_volume) continue;
            if (beyond.volume() < tolerance.least_volume) break;
            cells.push_back(std::move(inside));
            rest = std::move(beyond);
        }
        cells.push_back(std::move(rest));
    }
}

std::vector<Vec3> draw_sites(const ConvexCell& part, std::size_t count, const std::optional<Vec3>& focus,
                             Random& random) {
    constexpr int candidates = 4;  // the one farthest from the other sites is taken (Mitchell 1991): fewer slivers
    const Bounds bounds = part.bounds();
    std::vector<Vec3> sites;
    const auto nearest = [&](const Vec3& p) {
        double least = infinity;
        for (const Vec3& site : sites) least = std::min(least, (site - p).squaredNorm());
        return least;
    };
    while (sites.size() < count) {
        Vec3 best = draw_inside(part, bounds, random);
        if (focus) {
            const Vec3 nearer = *focus + random.unit() * (best - *focus);
            if (is_inside(part, nearer)) best = nearer;
        } else {
            double most = nearest(best);
            for (int k = 1; k < candidates && !sites.empty(); ++k) {
                const Vec3 other = draw_inside(part, bounds, random);
                const double distance = nearest(other);
                if (distance > most) {
                    best = other;
                    most = distance;
                }
            }
        }
        if (nearest(best) > 0.0) sites.push_back(best);
    }
    return sites;
}

void cut_by_sites(const ConvexCell& part, std::vector<Vec3> sites, const CutTolerance& tolerance,
                  std::vector<ConvexCell>& cells) {
    std::sort(sites.begin(), sites.end(), [](const Vec3& a, const Vec3& b) {
        return std::lexicographical_compare(a.data(), a.data() + 3, b.data(), b.data() + 3);
    });
    for (;;) {
        std::vector<ConvexCell> made;
        std::vector<Vec3> kept;
        for (std::size_t i = 0; i < sites.size(); ++i) {
            ConvexCell cell = voronoi_cell(part, sites, i, tolerance.length);
            if (cell.volume() < tolerance.least_volume) continue;
            made.push_back(std::move(cell));
            kept.push_back(sites[i]);
        }
        if (kept.size() == sites.size() || kept.empty()) {
            if (kept.empty()) made.push_back(part);
            std::move(made.begin(), made.end(), std::back_inserter(cells));
            return;
        }
        sites = std::move(kept);  // the others take the place of the small ones
    }
}

}  // namespace tumble
