// Numbers as bytes, least significant first, for the base64 parts of a motion record.
#pragma once

#include <bit>
#include <cstddef>
#include <cstdint>
#include <stdexcept>
#include <string_view>
#include <type_traits>
#include <vector>

namespace tumble {

class RecordWriter {
public:
    template <class Number>
    void add(Number number) {
        if constexpr (std::is_same_v<Number, float>)
            add(std::bit_cast<std::uint32_t>(number));
        else
            for (std::size_t i = 0; i < sizeof(Number); ++i)
                bytes_.push_back(std::byte(std::make_unsigned_t<Number>(number) >> (8 * i) & 0xff));
    }
    const std::vector<std::byte>& bytes() const { return bytes_; }

private:
    std::vector<std::byte> bytes_;
};

/// Throws std::out_of_range beyond the end.
class RecordReader {
public:
    explicit RecordReader(std::string_view bytes) : bytes_(bytes) {}

    bool at_end() const { return bytes_.empty(); }

    template <class Number>
    Number next() {
        if constexpr (std::is_same_v<Number, float>) {
            return std::bit_cast<float>(next<std::uint32_t>());
        } else {
            if (bytes_.size() < sizeof(Number)) throw std::out_of_range("numbers are missing");
            std::make_unsigned_t<Number> number = 0;
            for (std::size_t i = 0; i < sizeof(Number); ++i)
                number = std::make_unsigned_t<Number>(
                    number | std::make_unsigned_t<Number>(static_cast<unsigned char>(bytes_[i])) << (8 * i));
            bytes_.remove_prefix(sizeof(Number));
            return Number(number);
        }
    }

private:
    std::string_view bytes_;
};

}  // namespace tumble
