#include "core/dynamic_library.h"

#include "core/available_memory.h"
#include "core/error.h"

#include <dlfcn.h>
#include <fmt/format.h>

#include <string_view>

namespace tumble {
namespace {

/// The text of dlerror() is the only information that glibc gives; running out of memory has no text of its own.
bool is_missing(std::string_view reason) { return reason.ends_with("No such file or directory"); }
bool is_out_of_memory(std::string_view reason) {
    return reason.ends_with("Cannot allocate memory") || reason.ends_with("failed to map segment from shared object") ||
           reason.ends_with("cannot map zero-fill pages");
}

}  // namespace

DynamicLibrary::DynamicLibrary(std::span<const char* const> names, const char* what, const std::string& package) {
    std::string tried;
    bool missing = true;
    for (const char* name : names) {
        handle_ = dlopen(name, RTLD_NOW | RTLD_LOCAL);
        if (handle_ != nullptr) {
            name_ = name;
            return;
        }
        const char* const words = dlerror();
        const std::string reason = words != nullptr ? words : name;
        if (is_out_of_memory(reason))
            throw MemoryError(fmt::format("not enough memory to open {} ({}{})", name, reason, memory_limit_note()));
        missing = missing && is_missing(reason);
        tried += "\n  " + reason;
    }
    if (!missing)
        throw RunError(fmt::format("{} cannot be opened (it is in the package {}). Tried:{}", what, package, tried));
    throw RunError(fmt::format("{} is missing; install it with 'apt-get install {}'. Tried:{}", what, package, tried));
}

void* DynamicLibrary::find(const char* symbol) const { return dlsym(handle_, symbol); }

void* DynamicLibrary::require_address(const char* symbol) const {
    void* address = find(symbol);
    if (address == nullptr) throw RunError(fmt::format("{} has no function {}; it is too old", name_, symbol));
    return address;
}

}  // namespace tumble
