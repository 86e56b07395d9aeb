// grid = { ... } and scatter = { ... }: many bodies from one table.
// A grid is regular and may be ruffled; a scatter is random, with its copies kept from touching.
#pragma once

#include "scene/description/description.h"
#include "scene/keys/shapes.h"
#include "scene/toml/toml_reader.h"

#include <cstdint>
#include <optional>
#include <variant>
#include <vector>

namespace tumble {

struct GridRequest {
    std::array<int, 3> count{1, 1, 1};   // along x, y, z
    Vec3 spacing = Vec3::Zero();         // m between neighbors' origins
    Vec3 jitter = Vec3::Zero();          // m: each copy is moved by up to this either way
    double tilt = 0.0;                   // degrees: each copy is turned by up to this about a random axis
};

struct ScatterRequest {
    int count = 1;
    Vec3 size = Vec3::Zero();      // m, of the box in which the copies' origins lie
    bool random_rotation = true;
    double clearance = 0.0;        // m between the copies' bounding spheres
};

struct CopiesRequest {
    std::variant<GridRequest, ScatterRequest> arrangement;
    SourcePosition origin;                       // of the arrangement, for errors
    double min_scale = 1.0, max_scale = 1.0;
    std::vector<Color> colors;           // empty: all look like the body
};

/// Reads grid, scatter, scale and colors of a body's table; nothing when it is a single body.
std::optional<CopiesRequest> read_copies(const TomlTable& body, BodyType type, const ShapeRequest& shape);

/// The number of bodies that the request makes.
std::int64_t number_of(const CopiesRequest& request);

/// The copies of `model` in a fixed order (grid: x fastest, then z, then y; so layer by layer upwards), unnamed.
/// `table` is the number of the body's table in the file: with the seed it chooses the random numbers.
std::vector<BodyDescription> make_copies(const CopiesRequest& request, const BodyDescription& model,
                                         const ShapeRequest& shape, MeshCache& meshes, std::uint64_t seed,
                                         std::uint64_t table);

}  // namespace tumble
