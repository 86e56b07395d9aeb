#include "page/array_store.h"

#include "core/check.h"

#include <algorithm>
#include <bit>
#include <cmath>

namespace tumble {

double rounded_mantissa(double value, int bits) {
    if (bits >= 52 || !std::isfinite(value)) return value;
    const int dropped = 52 - bits;
    const std::uint64_t half = std::uint64_t(1) << (dropped - 1), mask = ~((std::uint64_t(1) << dropped) - 1);
    return std::bit_cast<double>((std::bit_cast<std::uint64_t>(value) + half) & mask);
}

ArrayStore::Json ArrayStore::add_planes(std::span<const std::uint64_t> values, int planes, int kind) {
    Json reference{bytes_.size(), values.size(), kind};
    std::size_t at = bytes_.size();
    bytes_.resize(at + std::size_t(planes) * values.size());
    for (int plane = 0; plane < planes; ++plane)
        for (const std::uint64_t value : values) bytes_[at++] = std::byte(value >> (8 * plane) & 0xffu);
    return reference;
}

ArrayStore::Json ArrayStore::add(std::span<const double> values, int bits) {
    std::vector<std::uint64_t> words;
    words.reserve(values.size());
    for (const double value : values) words.push_back(std::bit_cast<std::uint64_t>(rounded_mantissa(value, bits)));
    return add_planes(words, 8, 0);
}

ArrayStore::Json ArrayStore::add(std::span<const std::int64_t> values) {
    std::vector<std::uint64_t> codes;
    codes.reserve(values.size());
    std::uint64_t all = 1;
    for (const std::int64_t value : values) {
        codes.push_back(zigzag(value));
        all |= codes.back();
    }
    TUMBLE_CHECK_LE(all, std::uint64_t(1) << 53);  // whole numbers of JavaScript
    const int planes = (std::bit_width(all) + 7) / 8;
    return add_planes(codes, planes, planes);
}

}  // namespace tumble
