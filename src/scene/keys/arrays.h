// grid = { ... } and scatter = { ... }: many bodies from one table. A grid is regular, with optional jitter; a scatter
// is random, without contact between its copies.
#pragma once

#include "scene/fields/many_bodies_fields.h"
#include "scene/keys/shapes.h"
#include "scene/toml/toml_reader.h"

#include <cstdint>
#include <optional>
#include <variant>
#include <vector>

namespace tumble {

struct CopiesRequest {
    std::variant<GridRequest, ScatterRequest> arrangement;
    SourcePosition origin;  // of the grid or scatter, for errors
    CopyLooks looks;
};

/// Sizes of copies: each its own, or one for all. The copies of an instance have one size, whose key is for the whole.
enum class CopyScales { drawn, one };

/// Reads grid, scatter, scale and colors of a body's table; empty for a single body.
std::optional<CopiesRequest> read_copies(const TomlTable& body, BodyType type, const ShapeRequest& shape,
                                         CopyScales scales = CopyScales::drawn);

/// Number of bodies of the request.
std::int64_t number_of(const CopiesRequest& request);

/// The copies of `model` in a fixed order (grid: x fastest, then z, then y, so layer by layer upward), without names.
/// `table`: index of the body's table in the file, which selects the random numbers together with the seed.
std::vector<BodyDescription> make_copies(const CopiesRequest& request, const BodyDescription& model,
                                         const ShapeRequest& shape, MeshCache& meshes, std::uint64_t seed,
                                         std::uint64_t table);

}  // namespace tumble
