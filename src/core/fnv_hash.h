// FNV-1a of 64 bits: a short name for bytes that nobody forges.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

namespace tumble {

inline constexpr std::uint64_t fnv_start = 0xcbf29ce484222325u;

/// Hash of the bytes after others with the hash `before`.
constexpr std::uint64_t fnv_hash(std::span<const std::byte> bytes, std::uint64_t before = fnv_start) {
    for (const std::byte b : bytes) before = (before ^ std::uint64_t(b)) * 0x100000001b3u;
    return before;
}

}  // namespace tumble
