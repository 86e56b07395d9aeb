// The memory that the process may still take. A task that needs more is refused in advance, with numbers and a remedy,
// instead of a machine that swaps or a process that the system ends.
#pragma once

#include "core/error.h"

#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>

namespace tumble {

struct AvailableMemory {
    std::uint64_t bytes = 0;
    std::string_view bound;  // name of the bound: "the machine", ...
};

/// Files with the system's values; tests have folders of their own.
struct MemoryFiles {
    std::filesystem::path proc = "/proc", cgroups = "/sys/fs/cgroup";
};

/// For all processes together, the smaller of: the memory that the machine has free or can free (MemAvailable and free
/// swap), and the memory that the limits of the process's control groups leave. A value that cannot be read is no
/// bound.
AvailableMemory shared_memory(const MemoryFiles& files = {});

/// For this process: the same, also bounded by its limits of address space and data (ulimit -v, -d).
AvailableMemory available_memory(const MemoryFiles& files = {});

/// "7.9 GiB".
std::string memory_text(std::uint64_t bytes);

/// Throws RunError if `bytes` exceed the available memory: "WHAT takes 7.9 GiB of memory, and the machine has 3.1 GiB
/// left; REMEDY".
void require_memory(std::uint64_t bytes, const AvailableMemory& available, std::string_view what,
                    std::string_view remedy);

/// The same with the available memory of this process.
void require_memory(std::uint64_t bytes, std::string_view what, std::string_view remedy);

// Exhausted memory, and the user's limit of it.

/// The run failed because memory is exhausted; installing a package is no remedy.
class MemoryError : public RunError {
public:
    using RunError::RunError;
};

/// "; the limit of address space (ulimit -v) is 500 MiB", for messages, or empty without a limit.
std::string memory_limit_note();

}  // namespace tumble
