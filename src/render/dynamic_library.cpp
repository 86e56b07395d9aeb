#include "render/dynamic_library.h"

#include "core/error.h"

#include <dlfcn.h>
#include <fmt/format.h>

namespace tumble {

DynamicLibrary::DynamicLibrary(std::span<const char* const> names, const std::string& package) {
    std::string tried;
    for (const char* name : names) {
        handle_ = dlopen(name, RTLD_NOW | RTLD_LOCAL);
        if (handle_ != nullptr) {
            name_ = name;
            return;
        }
        const char* reason = dlerror();
        tried += fmt::format("\n  {}", reason != nullptr ? reason : name);
    }
    throw RunError(
        fmt::format("no library to draw with; install it with 'apt-get install {}'. Tried:{}", package, tried));
}

void* DynamicLibrary::find(const char* symbol) const { return dlsym(handle_, symbol); }

void* DynamicLibrary::require_address(const char* symbol) const {
    void* address = find(symbol);
    if (address == nullptr) throw RunError(fmt::format("{} has no function {}; it is too old", name_, symbol));
    return address;
}

}  // namespace tumble
