#include "core/error.h"

#include <fmt/format.h>

namespace tumble {
namespace {

std::string located(const SourceLocation& where, const std::string& message) {
    if (where.file.empty()) return "error: " + message;
    if (where.line == 0) return fmt::format("{}: error: {}", where.file, message);
    return fmt::format("{}:{}:{}: error: {}", where.file, where.line, where.column, message);
}

}  // namespace

InputError::InputError(const std::string& message) : std::runtime_error("error: " + message) {}

InputError::InputError(const SourceLocation& where, const std::string& message)
    : std::runtime_error(located(where, message)) {}

RunError::RunError(const std::string& message) : std::runtime_error("error: " + message) {}

}  // namespace tumble
