// Raw deflate (RFC 1951) by ISA-L, in a third of zlib's time. The output depends on the input only.
#pragma once

#include <cstddef>
#include <initializer_list>
#include <memory>
#include <span>

namespace tumble {

class Deflater {
public:
    /// last: the stream ends. whole_byte: it ends at a byte boundary without a last block, and later data does not
    /// refer to it, so such pieces can be concatenated.
    enum class End { last, whole_byte };

    Deflater();
    ~Deflater();

    /// Compresses the concatenated segments into `room`, whose size must be at least bound() of their total. Returns
    /// the number of bytes.
    std::size_t compress(std::initializer_list<std::span<const std::byte>> segments, End end,
                         std::span<std::byte> room);

    /// A code has at most 15 bits per byte (RFC 1951, 3.2.7), and bytes that are rare in the sample may get such codes;
    /// headers are added.
    static std::size_t bound(std::size_t bytes) { return bytes + bytes / 8 * 7 + 1024; }

private:
    struct Stream;
    void make_code(std::initializer_list<std::span<const std::byte>> segments);

    std::unique_ptr<Stream> stream_;
};

}  // namespace tumble
