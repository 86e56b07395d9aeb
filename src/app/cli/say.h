// Text for the user. Standard error carries messages about the run, as text or with --log json as JSON (messages.h);
// standard output carries requested results.
#pragma once

#include "app/log/messages.h"

#include <fmt/format.h>

#include <string_view>
#include <utility>

namespace tumble {

/// The messages of the process: like standard error, there is one stream of them.
Messages& messages();

/// Prints to standard error, or an event of the log for each line. A failure of the write has no effect.
void say_text(std::string_view text);

template <class... Values>
void say(fmt::format_string<Values...> format, Values&&... values) {
    say_text(fmt::format(format, std::forward<Values>(values)...));
}

/// Prints to standard output. Throws RunError if it cannot be written.
void put_text(std::string_view text);

template <class... Values>
void put(fmt::format_string<Values...> format, Values&&... values) {
    put_text(fmt::format(format, std::forward<Values>(values)...));
}

/// Flushes standard output. Throws RunError if it cannot be written.
void finish_standard_output();

}  // namespace tumble
