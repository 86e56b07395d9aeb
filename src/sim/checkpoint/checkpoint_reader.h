// Reads what the writer wrote, and refuses other bytes: archive.h.
#pragma once

#include "core/check.h"
#include "core/error.h"
#include "core/vector.h"
#include "sim/checkpoint/checkpoint_values.h"

#include <algorithm>
#include <array>
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
#include <utility>
#include <variant>
#include <vector>

namespace tumble {

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
        TUMBLE_CHECK_EQ(made_, false);  // otherwise the element belongs to keep_each()
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
    /// Reads a value without a past.
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
    bool made_ = false;       // true if the value that is read was made for it
    std::vector<SharedIndices> shared_;
};

}  // namespace tumble
