#include "scene/keys/arrays.h"

#include "core/deterministic_math.h"
#include "scene/description/shape_bounds.h"
#include "scene/keys/scatter_places.h"
#include "scene/toml/limits.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>

namespace tumble {
namespace {

constexpr Choice<bool> scatter_rotations[] = {{"random", true}, {"none", false}};

// Number of sizes of meshes and compounds between the ends of `scale`: copies of one size share their data.
constexpr int mesh_sizes = 9;

/// A number for all three axes, or one for each.
Vec3 number_or_vector(const TomlValue& value, const Range& range) {
    return value.is_number() ? Vec3(Vec3::Constant(value.number(range))) : value.vector(range);
}

GridRequest read_grid(const TomlValue& value) {
    TomlTable table = value.table();
    table.set_title("a grid");
    table.expect_keys({"count", "spacing", "jitter", "tilt"});
    GridRequest grid;
    const TomlValue count = table.require("count");
    const auto along = count.items(3, "whole numbers");
    std::int64_t product = 1;
    for (int i = 0; i < 3; ++i) {
        grid.count[i] = static_cast<int>(along[i].integer(1, limits::bodies));
        product *= grid.count[i];
        if (product > limits::bodies) count.fail(fmt::format("makes more than {} bodies", limits::bodies));
    }
    grid.spacing = number_or_vector(table.require("spacing"), limits::size);
    if (const auto jitter = table.find("jitter")) grid.jitter = number_or_vector(*jitter, limits::size_or_zero);
    table.read("tilt", grid.tilt, limits::tilt);
    return grid;
}

ScatterRequest read_scatter(const TomlValue& value) {
    TomlTable table = value.table();
    table.set_title("a scatter");
    table.expect_keys({"count", "size", "rotation", "clearance"});
    ScatterRequest scatter;
    scatter.count = static_cast<int>(table.require("count").integer(1, limits::bodies));
    scatter.size = table.require("size").vector(limits::size_or_zero);
    table.read<bool>("rotation", scatter.random_rotation, scatter_rotations);
    table.read("clearance", scatter.clearance, limits::size_or_zero);
    return scatter;
}

void read_scale(const TomlTable& body, const ShapeRequest& shape, CopiesRequest& request) {
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

double draw_scale(const CopiesRequest& request, bool shares, Random& random) {
    const double part = shares ? double(random.index(mesh_sizes)) / (mesh_sizes - 1) : random.unit();
    return request.min_scale + (request.max_scale - request.min_scale) * part;
}

void place_in_grid(const GridRequest& grid, Random& place, Random& turn, std::vector<BodyDescription>& copies) {
    const Vec3 position = copies[0].position;
    const double most = grid.tilt * pi / 180.0;
    std::size_t n = 0;
    for (int y = 0; y < grid.count[1]; ++y)
        for (int z = 0; z < grid.count[2]; ++z)
            for (int x = 0; x < grid.count[0]; ++x, ++n) {
                const Vec3 node(x - 0.5 * (grid.count[0] - 1), y, z - 0.5 * (grid.count[2] - 1));
                copies[n].position = position + node.cwiseProduct(grid.spacing) + place.in_box(grid.jitter);
                const Vec3 axis = turn.direction();
                const SinCos half = sincos(0.5 * most * turn.unit());
                const Vec3 v = half.sin * axis;
                if (most > 0.0) {
                    copies[n].rotation = (Quat(half.cos, v.x(), v.y(), v.z()) * copies[n].rotation).normalized();
                }
            }
}

void place_scattered(const ScatterRequest& scatter, const SourcePosition& origin, Random& place, Random& turn,
                     std::vector<BodyDescription>& copies) {
    std::vector<BoundingSphere> spheres;
    std::map<const void*, BoundingSphere> known;  // computed once for each mesh or compound; only for lookups
    for (BodyDescription& copy : copies) {
        if (scatter.random_rotation) copy.rotation = turn.rotation();
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
    const ScatterPlaces places =
        scatter_places(spheres, scatter.size, scatter.clearance, limits::scatter_attempts, place);
    if (places.offsets.size() < copies.size()) {
        origin.fail(
            fmt::format("is too crowded: only {} of {} copies found a place without touching another (given a box "
                        "of {} x {} x {} m, clearance {} m); make the box larger or the count smaller",
                        places.offsets.size(), copies.size(), number_text(scatter.size.x()),
                        number_text(scatter.size.y()), number_text(scatter.size.z()), number_text(scatter.clearance)));
    }
    for (std::size_t i = 0; i < copies.size(); ++i) copies[i].position += places.offsets[i];
}

}  // namespace

std::optional<CopiesRequest> read_copies(const TomlTable& body, BodyType type, const ShapeRequest& shape) {
    const auto grid = body.find("grid"), scatter = body.find("scatter");
    if (!grid && !scatter) {
        for (const char* key : {"scale", "colors"}) {
            if (const auto value = body.find(key)) value->fail("needs a grid or a scatter, and there is neither");
        }
        return std::nullopt;
    }
    if (grid && scatter) scatter->origin().fail("and grid exclude each other: give one of them");
    const TomlValue& arrangement = grid ? *grid : *scatter;
    if (type == BodyType::kinematic)
        arrangement.origin().fail("is for dynamic and fixed bodies (given a kinematic one)");
    if (std::holds_alternative<PlaneShape>(shape.shape)) {
        arrangement.origin().fail("is for bodies of finite size (given a plane, which is endless)");
    }
    CopiesRequest request{{}, arrangement.origin(), 1.0, 1.0, {}};
    if (grid)
        request.arrangement = read_grid(*grid);
    else
        request.arrangement = read_scatter(*scatter);
    read_scale(body, shape, request);
    if (const auto colors = body.find("colors")) {
        for (const TomlValue& color : colors->items()) request.colors.push_back(color.color());
        if (request.colors.empty()) colors->fail("must name at least one color");
    }
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
    Random place(seed, table, Random::Purpose::place), turn(seed, table, Random::Purpose::turn);
    Random look(seed, table, Random::Purpose::look), size(seed, table, Random::Purpose::size);
    std::vector<BodyDescription> copies(static_cast<std::size_t>(number_of(request)), model);
    const bool shares = shared_data(shape.shape) != nullptr;
    for (BodyDescription& copy : copies) {
        copy.shape = scaled(shape, draw_scale(request, shares, size), meshes);
        if (!request.colors.empty()) copy.surface.color = request.colors[look.index(request.colors.size())];
    }
    if (const auto* grid = std::get_if<GridRequest>(&request.arrangement))
        place_in_grid(*grid, place, turn, copies);
    else
        place_scattered(std::get<ScatterRequest>(request.arrangement), request.origin, place, turn, copies);
    return copies;
}

}  // namespace tumble
