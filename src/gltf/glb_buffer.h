// The binary chunk of a GLB file, and the buffer views and accessors that describe it. JSON is an implementation detail
// of this folder.
#pragma once

#include <nlohmann/json.hpp>

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace tumble {

/// Keeps the order of insertion, so that files read well and have the same bytes.
using Json = nlohmann::ordered_json;

class GlbBuffer {
public:
    enum class Use { vertices, animation };

    /// Adds floats with `components` (1 to 4) an element, and their least and largest values where the format asks for
    /// them: positions and times. Returns the accessor's index.
    std::size_t add(std::span<const float> values, int components, Use use, bool with_bounds);
    /// Adds the indices of triangles, with 16 bits if these suffice.
    std::size_t add(std::span<const std::uint32_t> indices);

    /// Adds the bytes of an image file. Returns the index of their buffer view.
    std::size_t add_bytes(std::span<const std::byte> bytes) { return add_view(bytes, 0); }

    /// The file: `root` with buffers, views and accessors, and the bytes.
    std::vector<std::byte> finish(Json root) const;

private:
    std::size_t add_view(std::span<const std::byte> bytes, int target);

    std::vector<std::byte> bytes_;
    Json views_ = Json::array(), accessors_ = Json::array();
};

}  // namespace tumble
