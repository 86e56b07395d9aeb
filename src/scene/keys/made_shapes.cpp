#include "scene/keys/shapes.h"

#include "core/input_file.h"
#include "core/safe_text.h"
#include "scene/mesh/height_grid.h"
#include "scene/toml/limits.h"
#include "sim/geometry/shapes/hull.h"

#include <fmt/format.h>

#include <algorithm>
#include <string>
#include <vector>

namespace tumble {
namespace {

/// Thickness below the lowest height, over the longer side, without the key `base`.
constexpr double usual_base = 0.05;

ShapeRequest request_of(const MeshFile& mesh, const std::string& name) {
    ShapeRequest request;
    request.shape = MeshShape{load_made_mesh(mesh, name).asset};
    request.made = true;
    return request;
}

MeshFile mesh_of(const Polyhedron& hull) {
    MeshFile mesh;
    for (const Vec3& vertex : hull.vertices) mesh.add_position(vertex);
    for (const Polyhedron::Face& face : hull.faces) {
        std::vector<MeshFile::Corner> corners(face.vertices.size());
        for (std::size_t i = 0; i < corners.size(); ++i) {
            corners[i].position = face.vertices[i];
            corners[i].normal = face.normal;
        }
        for (std::size_t i = 2; i < corners.size(); ++i) mesh.add_triangle({corners[0], corners[i - 1], corners[i]});
    }
    return mesh;
}

void check_extent(const Bounds& bounds, const TomlValue& origin) {
    const double extent = bounds.extent().maxCoeff();
    if (!limits::size.contains(extent))
        origin.origin().fail(fmt::format("span an unusable size of {} m (a length {})", number_text(extent),
                                         limits::size.requirement()));
}

}  // namespace

ShapeRequest read_hull(const TomlTable& table) {
    table.expect_keys({"type", "points"});
    const TomlValue list = table.require("points");
    std::vector<Vec3> points;
    Bounds bounds;
    const std::vector<TomlValue> items = list.items();
    if (items.size() < 4) list.origin().fail(fmt::format("must be 4 points at least (given {})", items.size()));
    if (items.size() > std::size_t(limits::hull_points))
        list.origin().fail(fmt::format("are too many: the limit is {} (given {})", limits::hull_points, items.size()));
    for (const TomlValue& item : items) {
        points.push_back(item.vector(limits::coordinate));
        bounds.add(points.back());
    }
    check_extent(bounds, list);
    try {
        return request_of(mesh_of(make_hull(points, Vec3::Zero())), "points");
    } catch (const InputError&) {
        list.origin().fail("must not lie in one plane: their convex hull needs a volume");
    } catch (const MeshError& error) {
        list.origin().fail(fmt::format("make a hull that {}", error.what()));
    }
}

ShapeRequest read_height_field(const TomlTable& table, const std::filesystem::path& folder, MeshCache& meshes) {
    table.expect_keys({"type", "file", "size", "height", "base"});
    const TomlValue name = table.require("file");
    if (name.text().empty()) name.fail("must not be empty");
    const auto size = table.require("size").items(2, "numbers, along x and along z");
    const double size_x = size[0].number(limits::size), size_z = size[1].number(limits::size);
    const TomlValue scale = table.require("height");
    const double height = scale.number(limits::coordinate);
    const std::filesystem::path file = (folder / std::filesystem::path(name.text())).lexically_normal();
    HeightGrid grid;
    try {
        grid = read_height_grid(file);
    } catch (const UnreadableFile& error) {
        name.origin().fail(fmt::format("\"{}\" {} (looked at {})", safe_text(name.text(), path_text_bytes),
                                       error.what(), safe_path(file)));
    }
    for (double& one : grid.heights) one *= height;
    const auto [lowest, highest] = std::minmax_element(grid.heights.begin(), grid.heights.end());
    if (!limits::coordinate.contains(*lowest) || !limits::coordinate.contains(*highest))
        scale.fail(fmt::format("makes heights from {} to {} m, outside of ±1e9 m", number_text(*lowest),
                               number_text(*highest)));
    double base = usual_base * std::max(size_x, size_z);
    table.read("base", base, limits::size);
    try {
        ShapeRequest request = request_of(height_field_mesh(grid, size_x, size_z, *lowest - base), file.string());
        meshes.add_file(file);
        return request;
    } catch (const MeshError& error) {
        name.origin().fail(
            fmt::format("\"{}\" makes a mesh that {}", safe_text(name.text(), path_text_bytes), error.what()));
    }
}

}  // namespace tumble
