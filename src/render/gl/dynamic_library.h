// A shared library opened at run time, so that the program starts (and says what to install) where it is missing.
#pragma once

#include <span>
#include <string>

namespace tumble {

class DynamicLibrary {
public:
    /// Opens the first of `names` that is there. Throws RunError with the reasons, and with the Debian package to install where
    /// none is there; MemoryError where memory ran out.
    DynamicLibrary(std::span<const char* const> names, const std::string& package);

    /// The address of a function, or null.
    void* find(const char* symbol) const;

    /// The same, typed; throws RunError when the library lacks it.
    template <class Function>
    Function require(const char* symbol) const {
        return reinterpret_cast<Function>(require_address(symbol));
    }

private:
    void* require_address(const char* symbol) const;

    void* handle_ = nullptr;  // never closed: Mesa and LLVM keep threads and exit handlers inside
    std::string name_;
};

}  // namespace tumble
