#include "core/memory_limit.h"

#include <fmt/format.h>

#include <sys/resource.h>

namespace tumble {

std::string memory_limit_note() {
    rlimit limit{};
    if (::getrlimit(RLIMIT_AS, &limit) != 0 || limit.rlim_cur == RLIM_INFINITY) return "";
    return fmt::format("; the limit of address space (ulimit -v) is {} MiB", limit.rlim_cur >> 20);
}

}  // namespace tumble
