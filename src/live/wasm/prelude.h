// Features of C++20 that the library of Debian's emscripten (libc++ 13) lacks, for one thread. Included before each
// source of the module, so that the sources themselves are the native program's.
#pragma once
#ifdef __cplusplus

#include <algorithm>
#include <charconv>
#include <cstdlib>
#include <cstring>
#include <functional>
#include <string>
#include <thread>
#include <utility>

#define __builtin_ia32_pause() static_cast<void>(0)
#define __builtin_cpu_supports(name) false  // the names are of other processors

namespace std {

template <class To, class From>
constexpr To bit_cast(const From& from) noexcept {
    return __builtin_bit_cast(To, from);
}

// One thread: no access is at the same time as another.
template <class T>
class atomic_ref {
public:
    explicit atomic_ref(T& value) : value_(value) {}
    T load(memory_order) const { return value_; }
    void store(T value, memory_order) const { value_ = value; }

private:
    T& value_;
};

class jthread {
public:
    template <class Work>
    explicit jthread(Work&& work) : thread_(std::forward<Work>(work)) {}
    jthread(jthread&&) = default;
    jthread& operator=(jthread&&) = default;
    ~jthread() {
        if (thread_.joinable()) thread_.join();
    }

private:
    std::thread thread_;
};

// strtod of musl rounds correctly, as std::from_chars does; it takes more spellings, which are refused here.
inline from_chars_result from_chars(const char* first, const char* last, double& value,
                                    chars_format = chars_format::general) {
    const char* digit = first != last && *first == '-' ? first + 1 : first;
    if (digit == last || !((*digit >= '0' && *digit <= '9') || *digit == '.')) return {first, errc::invalid_argument};
    if (last - digit > 1 && digit[0] == '0' && (digit[1] == 'x' || digit[1] == 'X')) last = digit + 1;
    const string text(first, last);
    char* end = nullptr;
    const double read = strtod(text.c_str(), &end);
    if (end == text.c_str()) return {first, errc::invalid_argument};
    value = read;
    return {first + (end - text.c_str()), errc()};
}

inline to_chars_result to_chars(char* first, char* last, double value, chars_format = chars_format::general,
                                int digits = 17) {
    char text[64];
    const int length = snprintf(text, sizeof text, "%.*g", digits, value);
    if (length > last - first) return {last, errc::value_too_large};
    memcpy(first, text, size_t(length));
    return {first + length, errc()};
}

namespace ranges {

struct identity_of_prelude {
    template <class T>
    constexpr T&& operator()(T&& value) const {
        return std::forward<T>(value);
    }
};
using Same = identity_of_prelude;

template <class Range, class Test, class Part = Same>
constexpr bool any_of(Range&& range, Test test, Part part = {}) {
    return std::any_of(std::begin(range), std::end(range),
                       [&](auto&& x) { return bool(std::invoke(test, std::invoke(part, x))); });
}
template <class Range, class Test, class Part = Same>
constexpr bool all_of(Range&& range, Test test, Part part = {}) {
    return !ranges::any_of(range, [&](auto&& x) { return !std::invoke(test, std::invoke(part, x)); });
}
template <class Range, class Test, class Part = Same>
constexpr bool none_of(Range&& range, Test test, Part part = {}) {
    return !ranges::any_of(range, test, part);
}
template <class Range, class Test, class Part = Same>
constexpr auto find_if(Range&& range, Test test, Part part = {}) {
    return std::find_if(std::begin(range), std::end(range),
                        [&](auto&& x) { return bool(std::invoke(test, std::invoke(part, x))); });
}
template <class Range, class T, class Part = Same>
constexpr auto find(Range&& range, const T& value, Part part = {}) {
    return ranges::find_if(range, [&](auto&& x) { return std::invoke(part, x) == value; });
}
template <class Range, class Test, class Part = Same>
constexpr auto count_if(Range&& range, Test test, Part part = {}) {
    return std::count_if(std::begin(range), std::end(range),
                         [&](auto&& x) { return bool(std::invoke(test, std::invoke(part, x))); });
}
template <class Range, class T>
constexpr auto count(Range&& range, const T& value) {
    return std::count(std::begin(range), std::end(range), value);
}
template <class A, class B>
constexpr bool equal(A&& a, B&& b) {
    return std::equal(std::begin(a), std::end(a), std::begin(b), std::end(b));
}
template <class Range, class Less = std::less<>, class Part = Same>
constexpr void sort(Range&& range, Less less = {}, Part part = {}) {
    std::sort(std::begin(range), std::end(range),
              [&](auto&& a, auto&& b) { return bool(std::invoke(less, std::invoke(part, a), std::invoke(part, b))); });
}
template <class Range, class Less = std::less<>, class Part = Same>
constexpr void stable_sort(Range&& range, Less less = {}, Part part = {}) {
    std::stable_sort(std::begin(range), std::end(range), [&](auto&& a, auto&& b) {
        return bool(std::invoke(less, std::invoke(part, a), std::invoke(part, b)));
    });
}
template <class Range, class T, class Less = std::less<>, class Part = Same>
constexpr auto lower_bound(Range&& range, const T& value, Less less = {}, Part part = {}) {
    return std::lower_bound(std::begin(range), std::end(range), value,
                            [&](auto&& x, const T& v) { return bool(std::invoke(less, std::invoke(part, x), v)); });
}
template <class Range, class T, class Less = std::less<>, class Part = Same>
constexpr auto upper_bound(Range&& range, const T& value, Less less = {}, Part part = {}) {
    return std::upper_bound(std::begin(range), std::end(range), value,
                            [&](const T& v, auto&& x) { return bool(std::invoke(less, v, std::invoke(part, x))); });
}
template <class A, class B>
struct in_in_result {
    A in1;
    B in2;
};
template <class A, class B>
constexpr auto mismatch(A&& a, B&& b) {
    const auto [x, y] = std::mismatch(std::begin(a), std::end(a), std::begin(b), std::end(b));
    return in_in_result<std::decay_t<decltype(x)>, std::decay_t<decltype(y)>>{x, y};
}

}  // namespace ranges
}  // namespace std

#endif
