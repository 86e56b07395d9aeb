// The origin of a value, for errors: a place in the scene file or an option of the command line.
#pragma once

#include "core/error.h"

#include <string>
#include <string_view>

namespace tumble {

struct SourcePosition {
    std::string name;      // the key ("fps") or the option ("--fps")
    SourceLocation where;  // without a file: an option

    bool is_option() const { return where.file.empty(); }

    /// Throws InputError "FILE:LINE:COLUMN: error: fps PROBLEM", or "error: --fps: PROBLEM" for an option.
    [[noreturn]] void fail(std::string_view problem) const;
};

}  // namespace tumble
