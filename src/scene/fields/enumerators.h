// Enumerators of an enum whose values count up from 0, by name: for checks at compile time that a list has all of them.
#pragma once

#include <cstddef>
#include <string_view>

namespace tumble {

/// Empty for a value without an enumerator.
template <auto value>
consteval std::string_view enumerator_name() {
    std::string_view text =
        __PRETTY_FUNCTION__;  // "... value = tumble::BodyType::fixed; ...", or "= (tumble::BodyType)9"
    text = text.substr(text.find("value = ") + 8);
    text = text.substr(0, text.find_first_of(";]"));
    return text.starts_with('(') ? std::string_view() : text.substr(text.rfind(':') + 1);
}

template <class Enum, std::size_t n = 0>
consteval std::size_t enumerator_count() {
    if constexpr (enumerator_name<Enum(n)>().empty())
        return n;
    else
        return enumerator_count<Enum, n + 1>();
}

}  // namespace tumble
