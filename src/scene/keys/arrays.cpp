#include "scene/keys/arrays.h"

#include "core/deterministic_math.h"
#include "core/random.h"
#include "scene/keys/fracture.h"
#include "scene/keys/read_fields.h"
#include "scene/toml/limits.h"
#include "sim/geometry/shapes/shape.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <optional>
#include <unordered_map>
#include <utility>

namespace tumble {
namespace {

// Number of sizes of meshes and compounds between the ends of `scale`: copies of one size share their data.
constexpr int mesh_sizes = 9;

GridRequest read_grid(const TomlValue& value) {
    TomlTable table = value.table();
    table.set_title("a grid");
    GridRequest grid = read_all_fields<GridRequest>(table);
    const TomlValue count = table.require("count");
    const auto along = count.items(3, "whole numbers");
    std::int64_t product = 1;
    for (int i = 0; i < 3; ++i) {
        grid.count[i] = static_cast<int>(along[i].integer(1, limits::bodies));
        product *= grid.count[i];
        if (product > limits::bodies) count.fail(fmt::format("makes more than {} bodies", limits::bodies));
    }
    return grid;
}

ScatterRequest read_scatter(const TomlValue& value) {
    TomlTable table = value.table();
    table.set_title("a scatter");
    return read_all_fields<ScatterRequest>(table);
}

void read_scale(const TomlTable& body, const ShapeRequest& shape, CopyLooks& request) {
    const auto value = body.find("scale");
    if (!value) return;
    const auto end = value->items(2, "numbers, the smallest and the largest factor");
    request.min_scale = end[0].number(limits::copy_scale);
    request.max_scale = end[1].number(limits::copy_scale);
    if (request.min_scale > request.max_scale) value->fail("must have the smaller factor first");
    const Vec3 extent = local_bounds(shape.shape).extent();
    if (!limits::size.contains(request.max_scale * extent.maxCoeff()) ||
        (!shared_data(shape.shape) && !limits::size.contains(request.min_scale * extent.minCoeff()))) {
        value->fail(fmt::format("makes copies of unusable size (a length {})", limits::size.requirement()));
    }
}

double draw_scale(const CopyLooks& request, bool shares, Random& random) {
    const double part = shares ? double(random.index(mesh_sizes)) / (mesh_sizes - 1) : random.unit();
    return request.min_scale + (request.max_scale - request.min_scale) * part;
}

void place_in_grid(const GridRequest& grid, Random& position_random, Random& rotation_random,
                   std::vector<BodyDescription>& copies) {
    const Vec3 position = copies[0].position;
    const double most = grid.tilt * pi / 180.0;
    std::size_t n = 0;
    for (int y = 0; y < grid.count[1]; ++y)
        for (int z = 0; z < grid.count[2]; ++z)
            for (int x = 0; x < grid.count[0]; ++x, ++n) {
                const Vec3 node(x - 0.5 * (grid.count[0] - 1), y, z - 0.5 * (grid.count[2] - 1));
                copies[n].position = position + node.cwiseProduct(grid.spacing) + position_random.in_box(grid.jitter);
                const Vec3 axis = rotation_random.direction();
                const SinCos half = sincos(0.5 * most * rotation_random.unit());
                const Vec3 v = half.sin * axis;
                if (most > 0.0) {
                    copies[n].rotation = (Quat(half.cos, v.x(), v.y(), v.z()) * copies[n].rotation).normalized();
                }
            }
}

/// The placed spheres in a grid with cells as wide as the largest diameter, so that only the 27 cells around a place
/// can contain neighbors. Only for lookups, never iterated over.
class NeighborBoxes {
public:
    NeighborBoxes(const std::vector<BoundingSphere>& spheres, double clearance)
        : spheres_(spheres), clearance_(clearance) {
        double largest = 0.0;
        for (const BoundingSphere& sphere : spheres) largest = std::max(largest, sphere.radius);
        cell_ = 2.0 * largest + clearance;
    }

    bool is_free(std::size_t sphere, const Vec3& center) const {
        const auto [x, y, z] = cell_of(center);
        for (std::int64_t i = x - 1; i <= x + 1; ++i)
            for (std::int64_t j = y - 1; j <= y + 1; ++j)
                for (std::int64_t k = z - 1; k <= z + 1; ++k)
                    if (touches(key(i, j, k), sphere, center)) return false;
        return true;
    }

    void add(std::size_t sphere, const Vec3& center) {
        const auto [x, y, z] = cell_of(center);
        cells_[key(x, y, z)].push_back({sphere, center});
    }

private:
    struct Placed {
        std::size_t sphere;
        Vec3 center;
    };

    std::array<std::int64_t, 3> cell_of(const Vec3& p) const {
        const Vec3 c = p / cell_;
        return {std::int64_t(std::floor(c.x())), std::int64_t(std::floor(c.y())), std::int64_t(std::floor(c.z()))};
    }

    /// Two cells with one key are harmless, because distances are tested.
    static std::uint64_t key(std::int64_t x, std::int64_t y, std::int64_t z) {
        return std::uint64_t(x) * 0x9e3779b97f4a7c15u ^ std::uint64_t(y) * 0xc2b2ae3d27d4eb4fu ^
               std::uint64_t(z) * 0x165667b19e3779f9u;
    }

    bool touches(std::uint64_t cell, std::size_t sphere, const Vec3& center) const {
        const auto found = cells_.find(cell);
        if (found == cells_.end()) return false;
        return std::any_of(found->second.begin(), found->second.end(), [&](const Placed& other) {
            const double reach = spheres_[sphere].radius + spheres_[other.sphere].radius + clearance_;
            return (center - other.center).squaredNorm() <= reach * reach;
        });
    }

    const std::vector<BoundingSphere>& spheres_;
    double clearance_;
    double cell_;  // m
    std::unordered_map<std::uint64_t, std::vector<Placed>> cells_;
};

// Random sequential addition (Renyi 1958).
struct ScatterPlaces {
    std::vector<Vec3> offsets;  // from the center of the box, in the order of the spheres; fewer if they do not fit
};

/// An offset for each sphere, uniform in the box of that full size. It is redrawn (up to `attempts` times per sphere)
/// while the sphere, whose center is relative to its offset, is nearer than `clearance` to an earlier one.
ScatterPlaces scatter_places(const std::vector<BoundingSphere>& spheres, const Vec3& size, double clearance,
                             std::int64_t attempts, Random& random) {
    NeighborBoxes neighbors(spheres, clearance);
    ScatterPlaces places;
    for (std::size_t sphere = 0; sphere < spheres.size(); ++sphere) {
        for (std::int64_t attempt = 0; attempt < attempts; ++attempt) {
            const Vec3 offset = random.in_box(0.5 * size);
            const Vec3 center = offset + spheres[sphere].center;
            if (!neighbors.is_free(sphere, center)) continue;
            neighbors.add(sphere, center);
            places.offsets.push_back(offset);
            break;
        }
        if (places.offsets.size() <= sphere) break;
    }
    return places;
}

/// The length rounded up to two digits, so that a message is short.
double short_length(double length) {
    if (length <= 0.0) return 0.0;
    double whole = 1.0, part = 1.0;  // powers of ten: the unit of the second digit is whole / part
    while (length / whole >= 100.0) whole *= 10.0;
    while (length * part < 10.0) part *= 10.0;
    return std::ceil(length / whole * part) * whole / part;
}

/// A box with the proportions of `size` that has room for all spheres with these random numbers; nothing if none of a
/// usable size has. A box without extent becomes a cube.
std::optional<Vec3> large_enough_box(const std::vector<BoundingSphere>& spheres, const ScatterRequest& scatter,
                                     const Random& start) {
    constexpr double growth = 1.1;  // a third more volume each time
    Vec3 size = scatter.size;
    if (size.isZero(0.0)) size = Vec3::Constant(2.0 * spheres.front().radius + scatter.clearance);
    for (;;) {
        size *= growth;
        if (!limits::size_or_zero.contains(size.maxCoeff())) return std::nullopt;
        const Vec3 box(short_length(size.x()), short_length(size.y()), short_length(size.z()));
        Random random = start;
        const ScatterPlaces places = scatter_places(spheres, box, scatter.clearance, limits::scatter_attempts, random);
        if (places.offsets.size() == spheres.size()) return box;
    }
}

std::string box_text(const Vec3& box) {
    return fmt::format("{} x {} x {} m", number_text(box.x()), number_text(box.y()), number_text(box.z()));
}

void place_scattered(const ScatterRequest& scatter, const SourcePosition& origin, Random& position_random,
                     Random& rotation_random, std::vector<BodyDescription>& copies) {
    std::vector<BoundingSphere> spheres;
    std::map<const void*, BoundingSphere> known;  // computed once for each mesh or compound; only for lookups
    for (BodyDescription& copy : copies) {
        if (scatter.random_rotation) copy.rotation = rotation_random.rotation();
        BoundingSphere sphere;
        if (const void* shared = shared_data(copy.shape)) {
            const auto [entry, is_new] = known.try_emplace(shared);
            if (is_new) entry->second = bounding_sphere(copy.shape);
            sphere = entry->second;
        } else {
            sphere = bounding_sphere(copy.shape);
        }
        sphere.center = copy.rotation * sphere.center;
        spheres.push_back(sphere);
    }
    const Random start = position_random;
    const ScatterPlaces places =
        scatter_places(spheres, scatter.size, scatter.clearance, limits::scatter_attempts, position_random);
    if (places.offsets.size() < copies.size()) {
        const auto room = large_enough_box(spheres, scatter, start);
        origin.fail(
            fmt::format("is too crowded: only {} of {} copies found a place without touching another (given a box "
                        "of {}, clearance {} m); make the box larger{} or the count smaller",
                        places.offsets.size(), copies.size(), box_text(scatter.size), number_text(scatter.clearance),
                        room ? fmt::format(" ({} is enough)", box_text(*room)) : ""));
    }
    for (std::size_t i = 0; i < copies.size(); ++i) copies[i].position += places.offsets[i];
}

}  // namespace

std::optional<CopiesRequest> read_copies(const TomlTable& body, BodyType type, const ShapeRequest& shape,
                                         CopyScales scales) {
    const auto grid = body.find("grid"), scatter = body.find("scatter");
    if (!grid && !scatter) {
        for (const char* key : {"scale", "colors"}) {
            const bool has_other_meaning = scales == CopyScales::one && std::string_view(key) == "scale";
            if (const auto value = body.find(key); value && !has_other_meaning)
                value->fail("needs a grid or a scatter, and there is neither");
        }
        return std::nullopt;
    }
    if (grid && scatter) scatter->origin().fail("and grid exclude each other: give one of them");
    const TomlValue& arrangement = grid ? *grid : *scatter;
    if (type == BodyType::kinematic)
        arrangement.origin().fail("is for dynamic and fixed bodies (given a kinematic one)");
    if (endless(shape.shape)) {
        arrangement.origin().fail("is for bodies of finite size (given a plane, which is endless)");
    }
    CopiesRequest request{{}, arrangement.origin(), {}};
    if (grid)
        request.arrangement = read_grid(*grid);
    else
        request.arrangement = read_scatter(*scatter);
    read_fields(body, request.looks);
    if (scales == CopyScales::drawn) read_scale(body, shape, request.looks);
    return request;
}

std::int64_t number_of(const CopiesRequest& request) {
    if (const auto* grid = std::get_if<GridRequest>(&request.arrangement)) {
        return std::int64_t(grid->count[0]) * grid->count[1] * grid->count[2];
    }
    return std::get<ScatterRequest>(request.arrangement).count;
}

std::vector<BodyDescription> make_copies(const CopiesRequest& request, const BodyDescription& model,
                                         const ShapeRequest& shape, MeshCache& meshes, std::uint64_t seed,
                                         std::uint64_t table) {
    Random position_random(seed, table, Random::Purpose::position),
        rotation_random(seed, table, Random::Purpose::rotation);
    Random color_random(seed, table, Random::Purpose::color), size_random(seed, table, Random::Purpose::size);
    std::vector<BodyDescription> copies(static_cast<std::size_t>(number_of(request)), model);
    const bool shares = shared_data(shape.shape) != nullptr;
    const std::vector<Color>& colors = request.looks.colors;
    for (BodyDescription& copy : copies) {
        const double factor = draw_scale(request.looks, shares, size_random);
        copy.shape = scaled(shape, factor, meshes);
        if (factor != 1.0) enlarge_fracture(copy, factor);
        // A given mass stays, and so do the other moments per mass and squared length.
        if (copy.center_of_mass) *copy.center_of_mass *= factor;
        if (copy.inertia)
            for (double& moment : *copy.inertia)
                moment *= factor * factor * (copy.mass ? 1.0 : factor * factor * factor);
        if (!colors.empty()) copy.appearance.color = colors[color_random.index(colors.size())];
    }
    if (const auto* grid = std::get_if<GridRequest>(&request.arrangement))
        place_in_grid(*grid, position_random, rotation_random, copies);
    else
        place_scattered(std::get<ScatterRequest>(request.arrangement), request.origin, position_random, rotation_random,
                        copies);
    return copies;
}

}  // namespace tumble
