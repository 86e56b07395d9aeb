#include "scene/mesh/gltf_buffers.h"

#include "core/html_text.h"
#include "scene/mesh/gltf_compression.h"
#include "scene/mesh/mesh_file.h"
#include "scene/toml/limits.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstring>
#include <limits>
#include <system_error>

namespace tumble {
namespace {

/// Component types of glTF.
enum class Component { int8 = 5120, uint8 = 5121, int16 = 5122, uint16 = 5123, uint32 = 5125, float32 = 5126 };

std::size_t size_of(Component type) {
    switch (type) {
        case Component::int8:
        case Component::uint8:
            return 1;
        case Component::int16:
        case Component::uint16:
            return 2;
        case Component::uint32:
        case Component::float32:
            break;
    }
    return 4;
}

Component component_type(const Json& holder) {
    const std::uint64_t number = require_whole(holder, "componentType");
    for (const Component type : {Component::int8, Component::uint8, Component::int16, Component::uint16,
                                 Component::uint32, Component::float32})
        if (number == std::uint64_t(type)) return type;
    throw MeshError(fmt::format("has an unknown \"componentType\" of {}", number));
}

template <class Number>
Number take(const char* at) {
    Number value;
    std::memcpy(&value, at, sizeof value);  // x86-64 is little-endian, like glTF
    return value;
}

template <class Number>
float whole_as_float(const char* at, bool normalized) {
    const auto value = static_cast<float>(take<Number>(at));
    return normalized ? std::max(value / static_cast<float>(std::numeric_limits<Number>::max()), -1.0f) : value;
}

float component(const char* at, Component type, bool normalized) {
    switch (type) {
        case Component::int8:
            return whole_as_float<std::int8_t>(at, normalized);
        case Component::uint8:
            return whole_as_float<std::uint8_t>(at, normalized);
        case Component::int16:
            return whole_as_float<std::int16_t>(at, normalized);
        case Component::uint16:
            return whole_as_float<std::uint16_t>(at, normalized);
        case Component::uint32:
            return whole_as_float<std::uint32_t>(at, normalized);
        case Component::float32:
            break;
    }
    return take<float>(at);
}

std::uint32_t index_value(const char* at, Component type) {
    switch (type) {
        case Component::uint8:
            return take<std::uint8_t>(at);
        case Component::uint16:
            return take<std::uint16_t>(at);
        case Component::uint32:
            return take<std::uint32_t>(at);
        case Component::int8:
        case Component::int16:
        case Component::float32:
            break;
    }
    throw MeshError("has indices that are not unsigned whole numbers");
}

// Types of accessors, by the number of components.
constexpr const char* kinds[17] = {"", "SCALAR", "VEC2", "VEC3", "VEC4", "", "", "",    "",
                                   "", "",       "",     "",     "",     "", "", "MAT4"};

constexpr std::size_t uri_shown = 60;  // characters of a name in a message

}  // namespace

std::string without_percents(std::string_view uri) {
    std::string result;
    const auto digit = [&](std::size_t at) {
        const char c = at < uri.size() ? uri[at] : '\0', lower = c | 0x20;
        return c >= '0' && c <= '9' ? c - '0' : lower >= 'a' && lower <= 'f' ? lower - 'a' + 10 : -1;
    };
    for (std::size_t i = 0; i < uri.size(); ++i) {
        const int high = uri[i] == '%' ? digit(i + 1) : -1, low = high >= 0 ? digit(i + 2) : -1;
        result += low >= 0 ? static_cast<char>(16 * high + low) : uri[i];
        if (low >= 0) i += 2;
    }
    return result;
}

std::string decode_data_uri(std::string_view uri, const char* what) {
    const std::string_view head = uri.substr(0, uri.find(','));
    if (head.size() == uri.size() || !head.ends_with(";base64"))
        throw MeshError(fmt::format("has {} with a data: URI without base64", what));
    auto bytes = decode_base64(uri.substr(head.size() + 1));
    if (!bytes) throw MeshError(fmt::format("has {} with broken base64", what));
    return std::move(*bytes);
}

struct GltfBuffers::Sparse {
    std::uint64_t count;
    Component index_type;
    std::string_view indices, values;
};

struct GltfBuffers::Elements {
    Component type;
    bool normalized;
    std::uint64_t count;
    std::size_t size, stride;  // bytes
    std::string_view bytes;    // empty: all are zero
    Sparse sparse;             // elements with other values
};

std::string GltfBuffers::load_file(std::string_view uri) {
    try {
        const std::filesystem::path file = file_below(folder_, without_percents(uri));
        std::string bytes = read_mesh_bytes(file);
        files_read_ += static_cast<std::int64_t>(bytes.size());
        if (files_read_ > limits::mesh_bytes)
            throw MeshError(fmt::format("makes more than {} MiB with those before it", limits::mesh_bytes >> 20));
        other_files_.push_back(file);
        return bytes;
    } catch (const MeshError& error) {
        throw MeshError(fmt::format("names the buffer \"{}\", which {}", readable(uri, uri_shown), error.what()));
    }
}

std::string GltfBuffers::load(const Json& buffer) {
    const Json* uri = find_member(buffer, "uri");
    if (!uri || !uri->is_string()) throw MeshError("has a buffer without a \"uri\"");
    const std::string_view text = uri->get_ref<const std::string&>();
    if (!text.starts_with("data:")) return load_file(text);
    return decode_data_uri(text, "a buffer");
}

std::string_view GltfBuffers::buffer(std::uint64_t index) {
    const Json& buffer = require_item(document_, "buffers", index);
    std::string_view bytes = binary_;
    if (index > 0 || binary_.empty() || find_member(buffer, "uri")) {
        auto found = loaded_.find(index);
        if (found == loaded_.end()) {
            found = loaded_.emplace(index, load(buffer)).first;
            bytes_read_ += found->second.size();
        }
        bytes = found->second;
    }
    const std::uint64_t length = require_whole(buffer, "byteLength");
    if (length > bytes.size()) throw MeshError(fmt::format("has a buffer of {} bytes of {}", bytes.size(), length));
    return bytes.substr(0, length);
}

std::string_view GltfBuffers::slice(const Json& view) {
    const std::string_view bytes = buffer(require_whole(view, "buffer"));
    const std::uint64_t first = find_whole(view, "byteOffset").value_or(0), length = require_whole(view, "byteLength");
    if (first > bytes.size() || length > bytes.size() - first)
        throw MeshError(fmt::format("has a buffer view beyond its buffer of {} bytes", bytes.size()));
    return bytes.substr(first, length);
}

std::string_view GltfBuffers::decompressed(std::uint64_t view, const Json& extension) {
    auto found = decompressed_.find(view);
    if (found == decompressed_.end()) {
        found = decompressed_.emplace(view, decode_meshopt(extension, slice(extension))).first;
        bytes_read_ += found->second.size();
        if (bytes_read_ > std::uint64_t(limits::mesh_bytes))
            throw MeshError(fmt::format("holds more than {} MiB, decompressed", limits::mesh_bytes >> 20));
    }
    return found->second;
}

std::string_view GltfBuffers::view(const Json& holder, std::size_t& stride) {
    const std::uint64_t index = require_whole(holder, "bufferView");
    const Json& view = require_item(document_, "bufferViews", index);
    const Json* compressed = nullptr;
    for (const char* name : meshopt_extensions)
        if (!compressed) compressed = find_extension(view, name);
    const std::string_view bytes = compressed ? decompressed(index, *compressed) : slice(view);
    const std::uint64_t skipped = find_whole(holder, "byteOffset").value_or(0);
    stride = find_whole(view, "byteStride").value_or(0);
    constexpr std::uint64_t longest_stride = 252;  // bytes, glTF 2.0's own
    if (stride > longest_stride)
        throw MeshError(fmt::format("has a \"byteStride\" of {} (at most {})", stride, longest_stride));
    if (skipped > bytes.size())
        throw MeshError(fmt::format("has an accessor beyond its buffer view of {} bytes", bytes.size()));
    return bytes.substr(skipped);
}

template <class Value>
void GltfBuffers::keep_given(std::uint64_t accessor, const std::vector<Value>& values) {
    std::string& bytes = given_[accessor];
    bytes.assign(reinterpret_cast<const char*>(values.data()), values.size() * sizeof(Value));
    bytes_read_ += bytes.size();
}

void GltfBuffers::give(std::uint64_t accessor, const std::vector<std::array<float, 4>>& values) {
    keep_given(accessor, values);
}

void GltfBuffers::give(std::uint64_t accessor, const std::vector<std::uint32_t>& indices) {
    keep_given(accessor, indices);
}

namespace {

/// Checks that the elements lie within the bytes. The count is below 2^32 here, so products do not overflow.
void check_extent(std::string_view bytes, std::uint64_t count, std::size_t size, std::size_t stride) {
    if (count > 0 && (bytes.size() < size || (count - 1) * stride > bytes.size() - size))
        throw MeshError(fmt::format("has an accessor of {} elements beyond its buffer view", count));
}

}  // namespace

GltfBuffers::Elements GltfBuffers::elements(std::uint64_t accessor, std::size_t components) {
    const Json& item = require_item(document_, "accessors", accessor);
    const Json* kind = find_member(item, "type");
    const char* wanted = kinds[components];
    if (!kind || *kind != wanted) throw MeshError(fmt::format("has an accessor whose \"type\" is not {}", wanted));
    const Json* normalized = find_member(item, "normalized");
    Elements result{};
    result.type = component_type(item);
    result.normalized = normalized && *normalized == true;
    result.count = require_whole(item, "count");
    result.stride = result.size = components * size_of(result.type);
    if (const auto given = given_.find(accessor); given != given_.end()) {  // indices, or vectors of four numbers
        result.type = components == 1 ? Component::uint32 : Component::float32;
        result.normalized = false;
        result.stride = components == 1 ? sizeof(std::uint32_t) : 4 * sizeof(float);
        result.size = components * sizeof(float);
        result.bytes = given->second;
        result.count = result.bytes.size() / result.stride;
        return result;
    }
    const bool has_view = find_member(item, "bufferView") != nullptr;
    if (has_view) {
        std::size_t stride = 0;
        result.bytes = view(item, stride);
        if (stride > 0) result.stride = stride;
    }
    if (const Json* sparse = find_member(item, "sparse")) result.sparse = sparse_of(*sparse, result);
    if (result.count > bytes_read_)  // elements without a buffer view are zeros, which need no bytes
        throw MeshError(fmt::format("has an accessor of {} elements in {} bytes", result.count, bytes_read_));
    if (has_view) check_extent(result.bytes, result.count, result.size, result.stride);
    return result;
}

GltfBuffers::Sparse GltfBuffers::sparse_of(const Json& sparse, const Elements& elements) {
    const Json *indices = find_member(sparse, "indices"), *values = find_member(sparse, "values");
    if (!indices || !values) throw MeshError("has a sparse accessor without indices and values");
    Sparse result{};
    result.count = require_whole(sparse, "count");
    if (result.count > elements.count) throw MeshError("has a sparse accessor that changes more elements than it has");
    result.index_type = component_type(*indices);
    std::size_t stride = 0;  // sparse data are packed
    result.indices = view(*indices, stride);
    result.values = view(*values, stride);
    if (result.count > bytes_read_) throw MeshError(fmt::format("has a sparse accessor of {} elements", result.count));
    check_extent(result.indices, result.count, size_of(result.index_type), size_of(result.index_type));
    check_extent(result.values, result.count, elements.size, elements.size);
    return result;
}

template <class Element, class Convert>
std::vector<Element> GltfBuffers::read(std::uint64_t accessor, std::size_t components, const Convert& convert) {
    const Elements all = elements(accessor, components);
    std::vector<Element> result(all.count);
    if (!all.bytes.empty())
        for (std::uint64_t i = 0; i < all.count; ++i) result[i] = convert(all.bytes.data() + i * all.stride, all);
    for (std::uint64_t i = 0; i < all.sparse.count; ++i) {
        const Sparse& sparse = all.sparse;
        const std::uint32_t changed =
            index_value(sparse.indices.data() + i * size_of(sparse.index_type), sparse.index_type);
        if (changed >= all.count)
            throw MeshError(fmt::format("has a sparse index of {} of {} elements", changed, all.count));
        result[changed] = convert(sparse.values.data() + i * all.size, all);
    }
    return result;
}

std::uint64_t GltfBuffers::count_vectors(std::uint64_t accessor) { return elements(accessor, 3).count; }

std::uint64_t GltfBuffers::count_indices(std::uint64_t accessor) { return elements(accessor, 1).count; }

std::vector<std::array<float, 3>> GltfBuffers::vectors(std::uint64_t accessor) {
    return read<std::array<float, 3>>(accessor, 3, [](const char* at, const Elements& all) {
        std::array<float, 3> vector{};
        for (std::size_t i = 0; i < 3; ++i) vector[i] = component(at + i * size_of(all.type), all.type, all.normalized);
        return vector;
    });
}

std::vector<std::array<float, 4>> GltfBuffers::values(std::uint64_t accessor, std::size_t components) {
    return read<std::array<float, 4>>(accessor, components, [&](const char* at, const Elements& all) {
        std::array<float, 4> vector{1.0f, 1.0f, 1.0f, 1.0f};
        for (std::size_t i = 0; i < components; ++i)
            vector[i] = component(at + i * size_of(all.type), all.type, all.normalized);
        return vector;
    });
}

std::vector<std::array<float, 16>> GltfBuffers::matrices(std::uint64_t accessor) {
    return read<std::array<float, 16>>(accessor, 16, [](const char* at, const Elements& all) {
        std::array<float, 16> matrix{};
        for (std::size_t i = 0; i < 16; ++i)
            matrix[i] = component(at + i * size_of(all.type), all.type, all.normalized);
        return matrix;
    });
}

std::size_t GltfBuffers::components(std::uint64_t accessor) const {
    const Json* kind = find_member(require_item(document_, "accessors", accessor), "type");
    for (std::size_t i = 1; i < std::size(kinds); ++i)
        if (kind && *kinds[i] != 0 && *kind == kinds[i]) return i;
    return 0;
}

std::string_view GltfBuffers::whole_view(const Json& image) {
    std::size_t stride = 0;
    return view(image, stride);
}

std::vector<std::uint32_t> GltfBuffers::indices(std::uint64_t accessor) {
    return read<std::uint32_t>(accessor, 1,
                               [](const char* at, const Elements& all) { return index_value(at, all.type); });
}

}  // namespace tumble
