// How much memory the process may still take, and the refusal of what needs more: known beforehand, it is an error with
// figures and a remedy, and not a machine that swaps or a process that the system ends.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>

namespace tumble {

struct AvailableMemory {
    std::uint64_t bytes = 0;
    std::string_view bound;   // what sets it: "the machine", ...
};

/// Where the system tells of it; tests have folders of their own.
struct MemoryFiles {
    std::filesystem::path proc = "/proc", cgroups = "/sys/fs/cgroup";
};

/// For all processes together, the lesser of: what the machine has free or can free (MemAvailable and free swap), and what
/// the limits of the process's control groups leave. What cannot be read bounds nothing.
AvailableMemory shared_memory(const MemoryFiles& files = {});

/// For this process: no more than that, and than the limits of its address space and data (ulimit -v, -d) leave.
AvailableMemory available_memory(const MemoryFiles& files = {});

/// "7.9 GiB".
std::string memory_text(std::uint64_t bytes);

/// Throws RunError where `bytes` are more than available: "WHAT takes 7.9 GiB of memory, and the machine has 3.1 GiB
/// left; REMEDY".
void require_memory(std::uint64_t bytes, const AvailableMemory& available, std::string_view what, std::string_view remedy);

/// The same of this process's.
void require_memory(std::uint64_t bytes, std::string_view what, std::string_view remedy);

}  // namespace tumble
