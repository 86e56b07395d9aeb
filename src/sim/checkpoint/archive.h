// Writes and reads the state of a simulation as bytes: numbers in little-endian order one after the other, without
// padding, so that equal states have equal bytes on every machine.
//
// Each class with state has one function that names all of its fields, for both directions:
//
//   template <class Archive, class Self>
//   static void visit(Archive& archive, Self& self) {
//       auto& [mass, velocity, spare] = self;
//       archive.rebuilt(mass);    // follows from the scene: right in every world of that scene that has not run yet
//       archive.keep(velocity);   // written and read
//       archive.scratch(spare);   // written before it is read in each step
//   }
//
// A new field does not compile until the function names it. tests/sim/checkpoint_test.cpp compares the motion of
// restored worlds with that of unbroken ones: a field in the wrong group shows there.
//
// Files come from anywhere: the function also declares the bound of each field, and reading refuses a value beyond it.
// keep() takes flags, finite numbers, and classes whose fields declare theirs; whole numbers and enumerations do not
// compile in it:
//
//   archive.body(a, b);                    // indices of bodies
//   archive.enumeration(kind, Kind::last);
//   archive.between(0, count, capacity);
//   archive.count(steps);                  // counted up from 0
//   archive.any(feature);                  // every value is valid
//   archive.unbounded(limit);              // may be infinite
//   archive.require([&] { return first + count <= size; });  // what several fields have to hold together
//
// Structures that follow from other values (trees, lists, islands) are not written, but built anew.
#pragma once

#include "core/check.h"
#include "core/error.h"
#include "core/vector.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <deque>
#include <limits>
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <type_traits>
#include <unordered_map>
#include <utility>
#include <variant>
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

/// Throws InputError where the bytes are not those of such a state.
class CheckpointReader {
public:
    explicit CheckpointReader(std::span<const std::byte> bytes) : bytes_(bytes) {}

    template <class... T>
    void keep(T&... values) {
        static_assert((!BoundedNumber<T> && ...), "declare the bound: see above");
        (get(values), ...);
    }
    /// Numbers that may be infinite.
    template <class... T>
    void unbounded(T&... values) {
        const bool outer = std::exchange(unbounded_, true);
        keep(values...);
        unbounded_ = outer;
    }
    /// Whole numbers all of whose values are valid, and lists of them.
    template <class... T>
    void any(T&... values) {
        (get_any(values), ...);
    }
    template <class Low, class T, class High>
    void between(const Low& low, T& value, const High& high) {
        raw(&value, sizeof value);
        if (std::cmp_less(value, low) || std::cmp_greater(value, high)) damaged("has a number out of its range");
    }
    /// Numbers that are counted up from zero.
    template <class... T>
    void count(T&... values) {
        (between(0, values, std::numeric_limits<T>::max() / 2), ...);
    }
    /// Precondition: the enumerators are 0, 1, 2 and so on, up to `last`.
    template <class T>
    void enumeration(T& value, T last) {
        std::underlying_type_t<T> number = 0;
        between(0, number, std::underlying_type_t<T>(last));
        value = T(number);
    }
    /// Indices of bodies.
    template <class... T>
    void body(T&... indices) {
        (get_body(indices), ...);
    }
    /// The same, or `none`.
    template <class T>
    void body_or(T none, T& index) {
        raw(&index, sizeof index);
        if (index != none) check_body(index);
    }
    void bodies(std::vector<std::uint32_t>& list) {
        get_any(list);
        for (const std::uint32_t i : list) check_body(i);
    }
    void bodies(SharedIndices& list) { get(list); }
    /// An element for each body.
    template <class T>
    void by_body(std::vector<T>& values) {
        get(values);
        if (values.size() != bodies_) damaged("has another number of bodies");
    }
    /// The same, or no element before the first step.
    template <class T>
    void by_body_or_none(std::vector<T>& values) {
        get(values);
        if (!values.empty() && values.size() != bodies_) damaged("has another number of bodies");
    }
    /// A list of bodies for each body, ascending.
    void bodies_by_body(std::vector<std::vector<std::uint32_t>>& lists) {
        if (length(1) != bodies_) damaged("has another number of bodies");
        lists.resize(bodies_);
        for (std::vector<std::uint32_t>& list : lists) {
            bodies(list);
            require([&] { return std::is_sorted(list.begin(), list.end()); });
        }
    }
    /// An element for each of the first bodies.
    template <class T>
    void within_bodies(std::vector<T>& values) {
        get(values);
        if (values.size() > bodies_) damaged("has another number of bodies");
    }
    /// Sets the number of bodies that indices may name.
    void expect_bodies(std::size_t count) { bodies_ = count; }
    template <class Holds>
    void require(Holds&& holds) {
        if (!holds()) damaged("has values that do not belong together");
    }
    template <class... T>
    void rebuilt(const T&...) {
        TUMBLE_CHECK_EQ(made_, false);  // else the element belongs to keep_each()
    }
    template <class... T>
    void scratch(const T&...) {}
    template <class T>
    void keep_each(std::vector<T>& values) {
        if (length(1) != values.size()) damaged("has another number of bodies");
        for (T& value : values) get(value);
    }
    template <class Array>
    void keep_first(std::size_t count, Array& values) {
        if (count > std::size(values)) damaged("has a length beyond its place");
        for (auto& value : std::span(values).first(count)) get(value);
    }

    bool at_end() const { return bytes_.empty(); }
    [[noreturn]] static void fail(const std::string& what) { throw InputError("the checkpoint " + what); }

private:
    [[noreturn]] static void damaged(const char* what) {
        fail(std::string(what) + ": it is damaged, or of another program; simulate again");
    }
    void raw(void* to, std::size_t count) {
        if (count > bytes_.size()) damaged("ends early");
        if (count == 0) return;
        std::memcpy(to, bytes_.data(), count);
        bytes_ = bytes_.subspan(count);
    }
    template <class T>
    void check_body(T index) {
        if (std::cmp_greater_equal(index, bodies_)) damaged("names a body that the scene does not have");
    }
    template <class T>
    void get_body(T& index) {
        raw(&index, sizeof index);
        check_body(index);
    }
    template <BoundedNumber T>
    void get_any(T& value) {
        raw(&value, sizeof value);
    }
    template <BoundedNumber T>
    void get_any(std::vector<T>& values) {
        get_numbers(values);
    }
    template <class T, std::size_t count>
    void get_any(std::array<T, count>& values) {
        for (T& value : values) get_any(value);
    }
    void get(bool& value) {
        std::uint8_t byte = 0;
        raw(&byte, 1);
        if (byte > 1) damaged("has a flag that is neither 0 nor 1");
        value = byte != 0;
    }
    void get(char& value) { raw(&value, 1); }
    void get(double& value) { get_number(value); }
    void get(float& value) { get_number(value); }
    template <class T>
    void get_number(T& value) {
        raw(&value, sizeof value);
        check(value);
    }
    template <class T>
    void check(T value) {
        if (!(unbounded_ ? value == value : std::isfinite(value))) damaged("has a number that is not finite");
    }
    template <class T>
    requires requires(CheckpointReader& archive, T& value) { T::visit(archive, value); }
    void get(T& value) { T::visit(*this, value); }
    template <class T, int rows, int columns>
    void get(Eigen::Matrix<T, rows, columns>& value) {
        raw(value.data(), sizeof(T) * std::size_t(rows * columns));
        for (int i = 0; i < rows * columns; ++i) check(value.data()[i]);
    }
    void get(Quat& value) { get(value.coeffs()); }
    void get(Bounds& value) { unbounded(value.min, value.max); }
    void get(std::string& value) { get_numbers(value); }
    template <class T>
    void get(std::vector<T>& values) {
        static_assert(!BoundedNumber<T>, "declare the bound: see above");
        if constexpr (std::is_same_v<T, std::byte>)
            get_numbers(values);
        else
            get_list(values);
    }
    template <class T>
    void get(std::deque<T>& values) {
        get_list(values);
    }
    template <class Key, class T>
    void get(std::map<Key, T>& values) {
        values.clear();
        for (std::size_t left = length(1); left > 0; --left) {
            Key key{};
            make(key);
            make(values[key]);
        }
    }
    template <class T, std::size_t count>
    void get(std::array<T, count>& values) {
        keep_first(count, values);
    }
    template <class T, std::size_t count>
    void get(T (&values)[count]) {
        keep_first(count, values);
    }
    template <class A, class B>
    void get(std::pair<A, B>& value) {
        keep(value.first, value.second);
    }
    template <class T>
    void get(std::optional<T>& value) {
        value.reset();
        if (has_value()) make(value.emplace());
    }
    template <class T>
    void get(std::unique_ptr<T>& value) {
        value.reset();
        if (!has_value()) return;
        value = std::make_unique<T>();
        make(*value);
    }
    template <class... T>
    void get(std::variant<T...>& value) {
        std::uint8_t index = 0;
        between(0, index, sizeof...(T) - 1);
        std::uint8_t next = 0;
        const auto take = [&]<class One>(std::type_identity<One>) {
            if (next++ == index) make(value.template emplace<One>());
        };
        (take(std::type_identity<T>()), ...);
    }
    void get(SharedIndices& value) {
        std::uint64_t number = 0;
        between(0, number, shared_.size() + 1);
        value.reset();
        if (number == 0) return;
        if (number > shared_.size()) {
            std::vector<std::uint32_t> members;
            bodies(members);
            shared_.push_back(std::make_shared<const std::vector<std::uint32_t>>(std::move(members)));
        }
        value = shared_[number - 1];
    }
    template <class List>
    void get_numbers(List& values) {
        values.resize(length(sizeof(typename List::value_type)));
        raw(values.data(), values.size() * sizeof(typename List::value_type));
    }
    /// Grows as its elements are read: a damaged length cannot ask for memory.
    template <class List>
    void get_list(List& values) {
        values.clear();
        for (std::size_t left = length(1); left > 0; --left) make(values.emplace_back());
    }
    /// Of a value without a past.
    template <class T>
    void make(T& value) {
        const bool outer = std::exchange(made_, true);
        get(value);
        made_ = outer;
    }
    bool has_value() {
        bool there = false;
        get(there);
        return there;
    }
    /// A number of elements, each of so many bytes at least.
    std::size_t length(std::size_t size) {
        std::uint64_t count = 0;
        raw(&count, sizeof count);
        if (count > bytes_.size() / size) damaged("ends early");
        return std::size_t(count);
    }

    std::span<const std::byte> bytes_;  // those not read yet
    std::size_t bodies_ = 0;
    bool unbounded_ = false;  // infinite numbers are right; NaN never is
    bool made_ = false;       // whether the value that is read was made for it
    std::vector<SharedIndices> shared_;
};

}  // namespace tumble
