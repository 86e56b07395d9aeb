// Memory that ran out, and the user's limit of it.
#pragma once

#include "core/error.h"

#include <string>

namespace tumble {

/// The run failed because memory ran out: there is nothing to install.
class MemoryError : public RunError {
public:
    using RunError::RunError;
};

/// "; the limit of address space (ulimit -v) is 500 MiB", for messages, or nothing where there is no limit.
std::string memory_limit_note();

}  // namespace tumble
