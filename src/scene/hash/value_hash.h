// Values as bytes for a hash: fixed widths, little-endian, numbers of elements first, so that no two sequences of values
// have the same bytes.
#pragma once

#include "core/color.h"
#include "core/sha256.h"
#include "core/vector.h"

#include <array>
#include <bit>
#include <concepts>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <type_traits>
#include <vector>

namespace tumble {

class ValueHash {
public:
    void add(const void*) = delete;  // an address is no value
    void add(bool value) { add_word(value ? 1 : 0); }
    void add(double value) { add_word(std::bit_cast<std::uint64_t>(value)); }
    void add(std::integral auto value) { add_word(std::uint64_t(std::int64_t(value))); }
    template <class T>
    requires std::is_enum_v<T>
    void add(T value) { add(std::underlying_type_t<T>(value)); }
    void add(std::string_view text) {
        add(text.size());
        add_bytes(std::as_bytes(std::span(text)));
    }
    void add(Color color) {
        const auto [r, g, b] = color;
        add(std::uint32_t(r) << 16 | std::uint32_t(g) << 8 | b);
    }

    std::string finish() {
        flush();
        return hash_.finish();
    }

protected:
    void add_word(std::uint64_t word) {
        static_assert(std::endian::native == std::endian::little);
        add_bytes(std::as_bytes(std::span(&word, 1)));
    }
    void add_bytes(std::span<const std::byte> bytes) {
        if (buffer_.size() + bytes.size() > buffer_size) flush();
        if (bytes.size() >= buffer_size)
            hash_.add(bytes);
        else
            buffer_.insert(buffer_.end(), bytes.begin(), bytes.end());
    }

private:
    static constexpr std::size_t buffer_size = 1 << 14;

    void flush() {
        hash_.add(buffer_);
        buffer_.clear();
    }

    Sha256 hash_;
    std::vector<std::byte> buffer_;
};

}  // namespace tumble
