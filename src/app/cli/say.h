// Words for the user. Standard error tells of the run and is not part of it; standard output is what was asked for.
#pragma once

#include <fmt/format.h>

#include <string_view>
#include <utility>

namespace tumble {

/// On standard error, as it is. Whether it can be written changes nothing.
void say_text(std::string_view text);

template <class... Values>
void say(fmt::format_string<Values...> format, Values&&... values) {
    say_text(fmt::format(format, std::forward<Values>(values)...));
}

/// On standard output. Throws RunError where it cannot be written.
void put_text(std::string_view text);

template <class... Values>
void put(fmt::format_string<Values...> format, Values&&... values) {
    put_text(fmt::format(format, std::forward<Values>(values)...));
}

/// What was put may wait until here. Throws RunError where it cannot be written.
void finish_standard_output();

}  // namespace tumble
