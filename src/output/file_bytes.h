// The bytes of a small file, such as a frame.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <span>
#include <string>

namespace tumble {

/// All bytes of a regular file, or the first `most`; empty if it is missing, not a regular file (a pipe would wait) or
/// cannot be read.
std::optional<std::string> bytes_of_file(const std::filesystem::path& path, std::size_t most = std::size_t(-1));

// Detects damaged files.

/// CRC-32, as in zip and PNG files and as Python's zlib.crc32() computes it, of the bytes after others with the
/// checksum `before`; 0 for none.
std::uint32_t crc32_of(std::uint32_t before, std::span<const std::byte> bytes);

/// CRC-64 (ECMA-182, reflected). Any change within 64 neighboring bits gives another sum, and other changes give the
/// same one with a probability of 2^-64.
std::uint64_t crc64(std::span<const std::byte> bytes);

}  // namespace tumble
