#include "core/available_memory.h"

#include "core/error.h"

#include <fmt/format.h>
#include <sys/resource.h>

#include <algorithm>
#include <fstream>
#include <limits>
#include <map>
#include <optional>
#include <sstream>

namespace tumble {
namespace {

namespace fs = std::filesystem;

constexpr std::uint64_t unbounded = std::numeric_limits<std::uint64_t>::max();

/// The numbers of lines like "MemAvailable:   1234 kB" or "inactive_file 1234", by name.
std::map<std::string, std::uint64_t> table_of(const fs::path& path) {
    std::map<std::string, std::uint64_t> table;
    std::ifstream text(path);
    for (std::string line; std::getline(text, line);) {
        std::istringstream fields(line);
        std::string name;
        std::uint64_t number = 0;
        if (fields >> name >> number) table[name] = number;
    }
    return table;
}

/// The number in a file; empty if the file is missing or contains "max".
std::optional<std::uint64_t> number_in(const fs::path& path) {
    std::ifstream text(path);
    std::uint64_t number = 0;
    if (text >> number) return number;
    return std::nullopt;
}

std::uint64_t left(std::uint64_t limit, std::uint64_t used) { return limit > used ? limit - used : 0; }

std::uint64_t machine(const MemoryFiles& files) {
    constexpr std::uint64_t unit = 1024;
    const auto table = table_of(files.proc / "meminfo");
    const auto available = table.find("MemAvailable:"), swap = table.find("SwapFree:");
    if (available == table.end()) return unbounded;
    return unit * (available->second + (swap != table.end() ? swap->second : 0));
}

/// File names of a control group, version 1 or 2 (Linux: admin-guide/cgroup-v1/memory, admin-guide/cgroup-v2).
struct GroupFiles {
    const char *limit, *used, *inactive, *active;
};
constexpr GroupFiles version_1{"memory.limit_in_bytes", "memory.usage_in_bytes", "total_inactive_file",
                               "total_active_file"};
constexpr GroupFiles version_2{"memory.max", "memory.current", "inactive_file", "active_file"};

/// Memory left by a group's limit. Cached pages of files count as used there, but are freed when memory is needed.
std::uint64_t left_in_group(const fs::path& folder, const GroupFiles& names) {
    const auto limit = number_in(folder / names.limit), used = number_in(folder / names.used);
    if (!limit || !used) return unbounded;
    auto table = table_of(folder / "memory.stat");
    return left(*limit, left(*used, table[names.inactive] + table[names.active]));
}

/// The smallest value over the process's group and its parents. In a container the group's own folder may be the root.
std::uint64_t groups(const MemoryFiles& files) {
    std::uint64_t least = unbounded;
    std::ifstream text(files.proc / "self" / "cgroup");
    for (std::string line; std::getline(text, line);) {  // NUMBER:CONTROLLERS:PATH
        const std::size_t first = line.find(':'), second = line.find(':', first + 1);
        if (second == std::string::npos) continue;
        const std::string controllers = fmt::format(",{},", line.substr(first + 1, second - first - 1));
        const bool is_version_1 = controllers.find(",memory,") != std::string::npos;
        if (!is_version_1 && controllers != ",,") continue;
        const fs::path root = is_version_1 ? files.cgroups / "memory" : files.cgroups;
        const GroupFiles& names = is_version_1 ? version_1 : version_2;
        for (fs::path group = fs::path(line.substr(second + 1)).relative_path();; group = group.parent_path()) {
            least = std::min(least, left_in_group(root / group, names));
            if (group.empty()) break;
        }
    }
    return least;
}

/// Memory left by a limit of the process; `used` names the value that it bounds.
std::uint64_t left_of_limit(__rlimit_resource which, const char* used, const MemoryFiles& files) {
    rlimit limit{};
    if (getrlimit(which, &limit) != 0 || limit.rlim_cur == RLIM_INFINITY) return unbounded;
    constexpr std::uint64_t unit = 1024;
    auto table = table_of(files.proc / "self" / "status");
    return left(limit.rlim_cur, unit * table[used]);
}

}  // namespace

AvailableMemory shared_memory(const MemoryFiles& files) {
    const AvailableMemory of_machine{machine(files), "the machine"};
    const AvailableMemory of_groups{groups(files), "the control group (the container's limit)"};
    return of_groups.bytes < of_machine.bytes ? of_groups : of_machine;
}

AvailableMemory available_memory(const MemoryFiles& files) {
    const AvailableMemory bounds[] = {
        shared_memory(files),
        {left_of_limit(RLIMIT_AS, "VmSize:", files), "the limit of the address space (ulimit -v)"},
        {left_of_limit(RLIMIT_DATA, "VmData:", files), "the limit of the process's data (ulimit -d)"},
    };
    return *std::min_element(std::begin(bounds), std::end(bounds),
                             [](const AvailableMemory& a, const AvailableMemory& b) { return a.bytes < b.bytes; });
}

std::string memory_text(std::uint64_t bytes) {
    constexpr double mebi = 1024.0 * 1024.0;
    const double amount = double(bytes) / mebi;
    return amount < 1000.0 ? fmt::format("{:.3g} MiB", amount) : fmt::format("{:.3g} GiB", amount / 1024.0);
}

void require_memory(std::uint64_t bytes, const AvailableMemory& available, std::string_view what,
                    std::string_view remedy) {
    if (bytes > available.bytes)
        throw RunError(fmt::format("{} takes {} of memory, and {} has {} left; {}", what, memory_text(bytes),
                                   available.bound, memory_text(available.bytes), remedy));
}

void require_memory(std::uint64_t bytes, std::string_view what, std::string_view remedy) {
    require_memory(bytes, available_memory(), what, remedy);
}

std::string memory_limit_note() {
    rlimit limit{};
    if (::getrlimit(RLIMIT_AS, &limit) != 0 || limit.rlim_cur == RLIM_INFINITY) return "";
    return fmt::format("; the limit of address space (ulimit -v) is {} MiB", limit.rlim_cur >> 20);
}

}  // namespace tumble
