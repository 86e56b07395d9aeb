#include "tumble/error.h"

#include "core/safe_text.h"

#include <utility>

namespace tumble::v0 {
namespace {

std::string located(const ErrorLocation& where, const std::string& message) {
    if (!where.element.empty()) return where.element + ": error: " + message;
    if (where.file.empty()) return "error: " + message;
    const std::string file = safe_path(where.file);
    if (where.line == 0) return file + ": error: " + message;
    return file + ":" + std::to_string(where.line) + ":" + std::to_string(where.column) + ": error: " + message;
}

}  // namespace

Error::Error(ErrorKind kind, ErrorLocation where, std::string message)
    : std::runtime_error(located(where, message)),
      kind_(kind),
      where_(std::move(where)),
      message_(std::move(message)) {}

Error::~Error() = default;  // here, so that the type has one home for all programs

}  // namespace tumble::v0
