// Detects damaged files.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

namespace tumble {

/// CRC-64 (ECMA-182, reflected). Any change within 64 neighboring bits gives another sum, and other changes give the
/// same one with a probability of 2^-64.
std::uint64_t crc64(std::span<const std::byte> bytes);

}  // namespace tumble
