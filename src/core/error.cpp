#include "core/error.h"

#include "core/check.h"
#include "core/safe_text.h"

#include <fmt/format.h>

#include <cstdio>
#include <cstdlib>

namespace tumble {

namespace {

// Messages contain user text that the thrower may not have made safe.
std::string located(const SourceLocation& where, const std::string& message) {
    const std::string text = safe_text(message, message_text_bytes);
    if (where.file.empty()) return "error: " + text;
    const std::string file = safe_path(where.file);
    if (where.line == 0) return fmt::format("{}: error: {}", file, text);
    return fmt::format("{}:{}:{}: error: {}", file, where.line, where.column, text);
}

}  // namespace

InputError::InputError(const std::string& message) : InputError(SourceLocation(), message) {}

InputError::InputError(const SourceLocation& where, const std::string& message)
    : std::runtime_error(located(where, message)), where_(where), message_(safe_text(message, message_text_bytes)) {}

// Several lines, because the message may contain another program's output.
RunError::RunError(const std::string& message)
    : std::runtime_error("error: " + safe_lines(message)), message_(safe_lines(message)) {}

std::string reason_of(std::string_view what) {
    constexpr std::string_view prefix = "error: ";
    return std::string(what.starts_with(prefix) ? what.substr(prefix.size()) : what);
}

void contract_broken(const char* file, int line, const std::string& text) {
    // The only print outside app/: the process aborts next, so no caller can report the reason.
    std::fprintf(stderr, "%s:%d: broken contract: %s\n", file, line, text.c_str());
    std::abort();
}

}  // namespace tumble
