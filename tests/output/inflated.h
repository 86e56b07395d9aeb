// Raw deflate unpacked by zlib, independently of the compressor.
#pragma once

#include <gtest/gtest.h>
#include <zlib.h>

#include <cstddef>
#include <span>
#include <vector>

namespace tumble {

/// `stream` must be complete and end with its last block. `most`: expected number of bytes; one more would be detected.
inline std::vector<std::byte> inflated(std::span<const std::byte> stream, std::size_t most) {
    std::vector<std::byte> bytes(most + 1);
    z_stream z{};
    inflateInit2(&z, -15);
    z.next_in = const_cast<Bytef*>(reinterpret_cast<const Bytef*>(stream.data()));
    z.avail_in = static_cast<uInt>(stream.size());
    z.next_out = reinterpret_cast<Bytef*>(bytes.data());
    z.avail_out = static_cast<uInt>(bytes.size());
    EXPECT_EQ(inflate(&z, Z_FINISH), Z_STREAM_END);
    EXPECT_EQ(z.avail_in, 0u);
    bytes.resize(z.total_out);
    inflateEnd(&z);
    return bytes;
}

}  // namespace tumble
