// Exhausted memory, and the user's limit of it.
#pragma once

#include "core/error.h"

#include <string>

namespace tumble {

/// The run failed because memory is exhausted; installing a package is no remedy.
class MemoryError : public RunError {
public:
    using RunError::RunError;
};

/// "; the limit of address space (ulimit -v) is 500 MiB", for messages, or empty without a limit.
std::string memory_limit_note();

}  // namespace tumble
