// Writes the state of a simulation as bytes: archive.h.
#pragma once

#include "core/vector.h"
#include "sim/checkpoint/checkpoint_values.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <deque>
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <unordered_map>
#include <utility>
#include <variant>
#include <vector>

namespace tumble {

class CheckpointWriter {
public:
    template <class... T>
    void keep(const T&... values) {
        (put(values), ...);
    }
    template <class... T>
    void unbounded(const T&... values) {
        (put(values), ...);
    }
    template <class... T>
    void any(const T&... values) {
        (put(values), ...);
    }
    template <class Low, class T, class High>
    void between(const Low&, const T& value, const High&) {
        put(value);
    }
    template <class... T>
    void count(const T&... values) {
        (put(values), ...);
    }
    template <class T>
    void enumeration(const T& value, T) {
        put(value);
    }
    template <class... T>
    void body(const T&... indices) {
        (put(indices), ...);
    }
    template <class T>
    void body_or(T, const T& index) {
        put(index);
    }
    void bodies(const std::vector<std::uint32_t>& list) { put(list); }
    void bodies(const SharedIndices& list) { put(list); }
    template <class T>
    void by_body(const std::vector<T>& values) {
        put(values);
    }
    template <class T>
    void by_body_or_none(const std::vector<T>& values) {
        put(values);
    }
    template <class T>
    void within_bodies(const std::vector<T>& values) {
        put(values);
    }
    void bodies_by_body(const std::vector<std::vector<std::uint32_t>>& lists) { put(lists); }
    void expect_bodies(std::size_t) {}
    template <class Holds>
    void require(Holds&&) {}
    template <class... T>
    void rebuilt(const T&...) {}
    template <class... T>
    void scratch(const T&...) {}
    /// Elements that exist in the world that reads them, and have rebuilt fields: keep() would make them anew.
    template <class T>
    void keep_each(const std::vector<T>& values) {
        put(values);
    }
    /// The first elements of an array, by pointer: g++ 12 -O2 -fipa-icf merges functions that index arrays of different
    /// lengths, and ends the loop of the longer one early.
    template <class Array>
    void keep_first(std::size_t count, const Array& values) {
        for (const auto& value : std::span(values).first(count)) put(value);
    }

    std::span<const std::byte> bytes() const { return {bytes_.data(), size_}; }

private:
    void raw(const void* from, std::size_t count) {
        if (count == 0) return;  // an empty list may have no address
        if (size_ + count > bytes_.size()) bytes_.resize(std::max(2 * bytes_.size(), size_ + count + 4096));
        std::memcpy(bytes_.data() + size_, from, count);
        size_ += count;
    }
    template <PlainNumber T>
    void put(const T& value) {
        raw(&value, sizeof value);
    }
    template <class T>
    requires requires(CheckpointWriter& archive, const T& value) { T::visit(archive, value); }
    void put(const T& value) { T::visit(*this, value); }
    template <class T, int rows, int columns>
    void put(const Eigen::Matrix<T, rows, columns>& value) {
        static_assert(rows > 0 && columns > 0);
        raw(value.data(), sizeof(T) * std::size_t(rows * columns));
    }
    void put(const Quat& value) { put(value.coeffs()); }
    void put(const Bounds& value) { keep(value.min, value.max); }
    void put(const std::string& value) { put_list(value); }
    template <class T>
    void put(const std::vector<T>& values) {
        put_list(values);
    }
    template <class T>
    void put(const std::deque<T>& values) {
        put_list(values);
    }
    template <class Key, class T>
    void put(const std::map<Key, T>& values) {
        put_list(values);
    }
    template <class T, std::size_t count>
    void put(const std::array<T, count>& values) {
        keep_first(count, values);
    }
    template <class T, std::size_t count>
    void put(const T (&values)[count]) {
        keep_first(count, values);
    }
    template <class A, class B>
    void put(const std::pair<A, B>& value) {
        keep(value.first, value.second);
    }
    template <class T>
    void put(const std::optional<T>& value) {
        put_pointer(value.has_value() ? &*value : nullptr);
    }
    template <class T>
    void put(const std::unique_ptr<T>& value) {
        put_pointer(value.get());
    }
    template <class... T>
    void put(const std::variant<T...>& value) {
        put(std::uint8_t(value.index()));
        std::visit([this](const auto& one) { put(one); }, value);
    }
    /// The list itself at its first owner, then its number.
    void put(const SharedIndices& value) {
        if (!value) return put(std::uint64_t(0));
        const auto [known, added] = shared_.try_emplace(value.get(), shared_.size() + 1);
        put(std::uint64_t(known->second));
        if (added) put(*value);
    }
    template <class List>
    void put_list(const List& values) {
        put(std::uint64_t(values.size()));
        if constexpr (contiguous_numbers<List>)
            raw(values.data(), values.size() * sizeof(typename List::value_type));
        else
            for (const auto& value : values) put(value);
    }
    template <class T>
    void put_pointer(const T* value) {
        put(value != nullptr);
        if (value != nullptr) put(*value);
    }

    std::vector<std::byte> bytes_;  // its size is the room for bytes
    std::size_t size_ = 0;
    std::unordered_map<const void*, std::uint64_t> shared_;  // looked up, never gone through
};

}  // namespace tumble
