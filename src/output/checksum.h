// CRC-32, as in zip and PNG files and as Python's zlib.crc32() computes it.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

namespace tumble {

/// Of the bytes after others with the checksum `before`; 0 for none.
std::uint32_t crc32_of(std::uint32_t before, std::span<const std::byte> bytes);

}  // namespace tumble
