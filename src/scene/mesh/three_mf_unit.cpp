#include "scene/mesh/three_mf_unit.h"

#include <zlib.h>

#include <cstdint>
#include <cstring>
#include <string>
#include <utility>

namespace tumble {
namespace {

constexpr double millimeter = 0.001;
constexpr std::size_t head_bytes = 64 << 10;  // of the model; its first element has the unit

constexpr std::pair<std::string_view, double> units[] = {
    {"micron", 1e-6}, {"millimeter", millimeter}, {"centimeter", 0.01},
    {"inch", 0.0254}, {"foot", 0.3048},           {"meter", 1.0},
};

template <class Number>
Number number_at(std::string_view bytes, std::size_t at) {
    Number value = 0;
    if (at + sizeof value <= bytes.size()) std::memcpy(&value, bytes.data() + at, sizeof value);
    return value;
}

std::string inflated_head(std::string_view packed) {
    std::string head(head_bytes, '\0');
    z_stream stream{};
    if (inflateInit2(&stream, -MAX_WBITS) != Z_OK) return {};
    stream.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(packed.data()));
    stream.avail_in = uInt(packed.size());
    stream.next_out = reinterpret_cast<Bytef*>(head.data());
    stream.avail_out = uInt(head.size());
    inflate(&stream, Z_SYNC_FLUSH);
    head.resize(head.size() - stream.avail_out);
    inflateEnd(&stream);
    return head;
}

/// The first bytes of the first model in the archive, found by its directory (PKWARE, .ZIP File Format Specification).
std::string model_head(std::string_view bytes) {
    for (std::size_t at = 0; (at = bytes.find("PK\1\2", at)) != bytes.npos; at += 4) {
        const std::string_view name = bytes.substr(at).substr(0, 46 + number_at<std::uint16_t>(bytes, at + 28));
        if (!name.ends_with(".model")) continue;
        const std::size_t local = number_at<std::uint32_t>(bytes, at + 42);
        const std::size_t data =
            local + 30 + number_at<std::uint16_t>(bytes, local + 26) + number_at<std::uint16_t>(bytes, local + 28);
        if (data >= bytes.size()) return {};
        const std::string_view packed = bytes.substr(data, number_at<std::uint32_t>(bytes, at + 20));
        const bool deflated = number_at<std::uint16_t>(bytes, at + 10) != 0;
        return deflated ? inflated_head(packed) : std::string(packed.substr(0, head_bytes));
    }
    return {};
}

}  // namespace

double three_mf_unit(std::string_view bytes) {
    const std::string head = model_head(bytes);
    const std::size_t begin = head.find("<model");
    if (begin == head.npos) return millimeter;
    const std::string_view element = std::string_view(head).substr(begin, head.find('>', begin) - begin);
    for (const auto& [name, meters] : units)
        for (const char quote : {'"', '\''}) {
            const std::string text = std::string("unit=") + quote + std::string(name) + quote;
            if (element.find(text) != element.npos) return meters;
        }
    return millimeter;
}

}  // namespace tumble
