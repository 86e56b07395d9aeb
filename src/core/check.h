// Contracts between functions of Tumble. A broken one is a bug, never an error of the user's input: the program stops
// with the place and both values. They stay in release builds, so none belongs in an inner loop.
#pragma once

#include <fmt/format.h>

#include <string>

namespace tumble {

/// Prints "FILE:LINE: broken contract: TEXT" and aborts.
[[noreturn]] void contract_broken(const char* file, int line, const std::string& text);

}  // namespace tumble

#define TUMBLE_CHECK_OP(a, op, b)                                                                                      \
    do {                                                                                                               \
        const auto& check_left = (a);                                                                                  \
        const auto& check_right = (b);                                                                                 \
        if (!(check_left op check_right))                                                                              \
            ::tumble::contract_broken(__FILE__, __LINE__,                                                              \
                                      fmt::format("{} {} {} (with {} and {})", #a, #op, #b, check_left, check_right)); \
    } while (false)

#define TUMBLE_CHECK_EQ(a, b) TUMBLE_CHECK_OP(a, ==, b)
#define TUMBLE_CHECK_LT(a, b) TUMBLE_CHECK_OP(a, <, b)
#define TUMBLE_CHECK_LE(a, b) TUMBLE_CHECK_OP(a, <=, b)
#define TUMBLE_CHECK_GT(a, b) TUMBLE_CHECK_OP(a, >, b)
#define TUMBLE_CHECK_GE(a, b) TUMBLE_CHECK_OP(a, >=, b)
