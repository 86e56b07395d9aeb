// Shared by the fuzz targets that read PNG files.
#pragma once

#include "output/png_reader.h"

#include <zlib.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <span>

namespace tumble {

/// A larger picture takes more time without reaching other code.
inline constexpr std::int64_t fuzzed_pixels = 1 << 18;

inline OpenFile as_file(std::span<const std::uint8_t> bytes) {
    // Not of length 0: fmemopen refuses that.
    static std::uint8_t nothing = 0;
    if (bytes.empty()) bytes = {&nothing, 1};
    return OpenFile(fmemopen(const_cast<std::uint8_t*>(bytes.data()), bytes.size(), "rb"));
}

/// Corrects the checksum of each chunk, because every change would be rejected by it.
inline void mend_checksums(std::span<std::uint8_t> bytes) {
    constexpr std::size_t signature = 8, head = 8, checksum = 4;
    for (std::size_t at = signature; at + head + checksum <= bytes.size();) {
        std::size_t size = 0;
        for (std::size_t i = 0; i < 4; ++i) size = size << 8 | bytes[at + i];
        if (size > bytes.size() - at - head - checksum) return;
        const auto crc = std::uint32_t(crc32(0, &bytes[at + 4], uInt(size + 4)));
        for (std::size_t i = 0; i < checksum; ++i) bytes[at + head + size + i] = std::uint8_t(crc >> (24 - 8 * i));
        at += head + size + checksum;
    }
}

}  // namespace tumble
