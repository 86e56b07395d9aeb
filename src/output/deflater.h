// Raw deflate (RFC 1951) by ISA-L, which takes a third of zlib's time. The bytes that come out depend only on those that go in.
#pragma once

#include <cstddef>
#include <initializer_list>
#include <memory>
#include <span>

namespace tumble {

class Deflater {
public:
    /// last: the stream is complete. whole_byte: it ends at a whole byte without a last block, and what is compressed next
    /// does not refer to it: such pieces can be joined.
    enum class End { last, whole_byte };

    Deflater();
    ~Deflater();

    /// The parts, one behind the other, into `room`, which must be as large as bound() of all. Returns the bytes used.
    std::size_t compress(std::initializer_list<std::span<const std::byte>> parts, End end, std::span<std::byte> room);

    /// No code has more than 15 bits a byte (RFC 1951, 3.2.7), and bytes unlike the sample may get such; and there are headers.
    static std::size_t bound(std::size_t bytes) { return bytes + bytes / 8 * 7 + 1024; }

private:
    struct Stream;
    void make_code(std::initializer_list<std::span<const std::byte>> parts);

    std::unique_ptr<Stream> stream_;
};

}  // namespace tumble
