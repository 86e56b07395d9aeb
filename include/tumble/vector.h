// Vectors, rotations and colors as plain values, and views of arrays.
#pragma once

#include "version.h"

#include <cstddef>
#include <cstdint>
#include <type_traits>
#include <utility>
#include <variant>

TUMBLE_BEGIN

struct Vec3 {
    double x = 0.0, y = 0.0, z = 0.0;
};

/// A unit quaternion.
struct Quat {
    double w = 1.0, x = 0.0, y = 0.0, z = 0.0;
};

/// A rotation about an axis, counterclockwise seen from its tip. The length of the axis is ignored.
struct AxisAngle {
    Vec3 axis;
    double degrees = 0.0;
};

using Rotation = std::variant<Quat, AxisAngle>;

/// sRGB, 8 bits per channel.
struct Color {
    std::uint8_t r = 0, g = 0, b = 0;
};

/// A view of elements in a row, like std::span of C++20. Made of a pointer and a count, or of any container with data()
/// and size(): std::vector, std::array, std::span. Owns nothing: the elements must outlive it.
template <class T>
class Span {
public:
    constexpr Span() = default;
    constexpr Span(T* first, std::size_t count) : data_(first), size_(count) {}
    template <class Container,
              class = std::enable_if_t<std::is_convertible_v<decltype(std::declval<const Container&>().data()), T*>>>
    constexpr Span(const Container& elements) : data_(elements.data()), size_(elements.size()) {}

    constexpr T* begin() const { return data_; }
    constexpr T* end() const { return data_ + size_; }
    constexpr std::size_t size() const { return size_; }

private:
    T* data_ = nullptr;
    std::size_t size_ = 0;
};

constexpr bool operator==(const Vec3& a, const Vec3& b) { return a.x == b.x && a.y == b.y && a.z == b.z; }
constexpr bool operator!=(const Vec3& a, const Vec3& b) { return !(a == b); }
constexpr bool operator==(const Quat& a, const Quat& b) { return a.w == b.w && a.x == b.x && a.y == b.y && a.z == b.z; }
constexpr bool operator!=(const Quat& a, const Quat& b) { return !(a == b); }
constexpr bool operator==(const AxisAngle& a, const AxisAngle& b) { return a.axis == b.axis && a.degrees == b.degrees; }
constexpr bool operator!=(const AxisAngle& a, const AxisAngle& b) { return !(a == b); }
constexpr bool operator==(Color a, Color b) { return a.r == b.r && a.g == b.g && a.b == b.b; }
constexpr bool operator!=(Color a, Color b) { return !(a == b); }

TUMBLE_END
