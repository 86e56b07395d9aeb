// Kinds of values that checkpoints tell apart (archive.h).
#pragma once

#include <bit>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <type_traits>
#include <vector>

namespace tumble {

static_assert(std::endian::native == std::endian::little, "checkpoints copy numbers as they lie in memory");

/// Bodies that fell asleep together share a list of their indices.
using SharedIndices = std::shared_ptr<const std::vector<std::uint32_t>>;

template <class T>
concept PlainNumber = std::is_arithmetic_v<T> || std::is_enum_v<T>;

/// Numbers with a bound that only their owner knows.
template <class T>
concept BoundedNumber = (std::is_integral_v<T> && !std::is_same_v<T, bool> && !std::is_same_v<T, char>) ||
                        (std::is_enum_v<T> && !std::is_same_v<T, std::byte>);

/// Lists of numbers that are copied in one piece.
template <class List>
concept contiguous_numbers =
    PlainNumber<typename List::value_type> && !std::is_same_v<typename List::value_type, bool> && requires(List list) {
    list.data();
};

}  // namespace tumble
