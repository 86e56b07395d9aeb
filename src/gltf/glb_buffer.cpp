#include "gltf/glb_buffer.h"

#include "core/error.h"

#include <algorithm>
#include <bit>
#include <string>
#include <utility>

namespace tumble {
namespace {

static_assert(std::endian::native == std::endian::little, "glTF is little-endian");

// Numbers of the format.
constexpr int array_buffer = 34962, element_array_buffer = 34963;
constexpr int unsigned_short = 5123, unsigned_int = 5125, float_type = 5126;
constexpr std::uint32_t magic = 0x46546c67, version = 2, json_chunk = 0x4e4f534a, binary_chunk = 0x004e4942;

std::size_t padded(std::size_t size) { return (size + 3) / 4 * 4; }

/// Fills a file of known size from its start.
class FileBytes {
public:
    explicit FileBytes(std::size_t size) : bytes_(size) {}

    void put(std::span<const std::byte> bytes) {
        std::ranges::copy(bytes, bytes_.begin() + std::ptrdiff_t(filled_));
        filled_ += bytes.size();
    }
    void put(std::uint32_t number) { put(std::as_bytes(std::span(&number, 1))); }
    std::vector<std::byte> take() { return std::move(bytes_); }

private:
    std::vector<std::byte> bytes_;
    std::size_t filled_ = 0;
};

}  // namespace

std::size_t GlbBuffer::add_view(std::span<const std::byte> bytes, int target) {
    Json view{{"buffer", 0}, {"byteOffset", bytes_.size()}, {"byteLength", bytes.size()}};
    if (target != 0) view["target"] = target;
    bytes_.insert(bytes_.end(), bytes.begin(), bytes.end());
    bytes_.resize(padded(bytes_.size()));
    views_.push_back(std::move(view));
    return views_.size() - 1;
}

std::size_t GlbBuffer::add(std::span<const float> values, int components, Use use, bool with_bounds) {
    const std::size_t n = std::size_t(components);
    const std::size_t view = add_view(std::as_bytes(values), use == Use::vertices ? array_buffer : 0);
    Json accessor{{"bufferView", view},
                  {"componentType", float_type},
                  {"count", values.size() / n},
                  {"type", components == 1 ? "SCALAR" : "VEC" + std::to_string(components)}};
    if (with_bounds) {
        Json least = Json::array(), most = Json::array();
        for (std::size_t c = 0; c < n; ++c) {
            float low = values[c], high = values[c];
            for (std::size_t i = c; i < values.size(); i += n) {
                low = std::min(low, values[i]);
                high = std::max(high, values[i]);
            }
            least.push_back(double(low));  // in double: the digits then give the same float
            most.push_back(double(high));
        }
        accessor["min"] = std::move(least);
        accessor["max"] = std::move(most);
    }
    accessors_.push_back(std::move(accessor));
    return accessors_.size() - 1;
}

std::size_t GlbBuffer::add(std::span<const std::uint32_t> indices) {
    const bool small = std::ranges::all_of(indices, [](std::uint32_t i) { return i < 0xffff; });  // 0xffff is reserved
    std::size_t view = 0;
    if (small) {
        const std::vector<std::uint16_t> shorts(indices.begin(), indices.end());
        view = add_view(std::as_bytes(std::span(shorts)), element_array_buffer);
    } else {
        view = add_view(std::as_bytes(indices), element_array_buffer);
    }
    accessors_.push_back({{"bufferView", view},
                          {"componentType", small ? unsigned_short : unsigned_int},
                          {"count", indices.size()},
                          {"type", "SCALAR"}});
    return accessors_.size() - 1;
}

std::vector<std::byte> GlbBuffer::finish(Json root) const {
    if (!bytes_.empty()) {
        root["buffers"] = Json::array({{{"byteLength", bytes_.size()}}});
        root["bufferViews"] = views_;
        root["accessors"] = accessors_;
    }
    std::string text = root.dump(-1, ' ', false, Json::error_handler_t::replace);
    text.resize(padded(text.size()), ' ');
    const std::uint64_t size = 12 + 8 + text.size() + (bytes_.empty() ? 0 : 8 + bytes_.size());
    if (size > UINT32_MAX) throw RunError("the glTF file would exceed 4 GiB, the limit of the format");
    FileBytes file(size);
    for (const std::uint32_t number : {magic, version, std::uint32_t(size), std::uint32_t(text.size()), json_chunk})
        file.put(number);
    file.put(std::as_bytes(std::span(text)));
    if (!bytes_.empty()) {
        file.put(std::uint32_t(bytes_.size()));
        file.put(binary_chunk);
        file.put(bytes_);
    }
    return file.take();
}

}  // namespace tumble
