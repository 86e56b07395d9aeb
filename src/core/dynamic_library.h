// A shared library opened at run time, so that the program starts without it and can name the package to install.
#pragma once

#include <span>
#include <string>

namespace tumble {

class DynamicLibrary {
public:
    /// Opens the first library of `names` that exists. Throws RunError with the reasons and the Debian package to
    /// install if none exists; MemoryError if memory ran out. `what`: its name in errors, "the rendering library".
    DynamicLibrary(std::span<const char* const> names, const char* what, const std::string& package);

    /// The address of a function, or null.
    void* find(const char* symbol) const;

    /// The same with a type; throws RunError if the library lacks the function.
    template <class Function>
    Function require(const char* symbol) const {
        return reinterpret_cast<Function>(require_address(symbol));
    }

private:
    void* require_address(const char* symbol) const;

    void* handle_ = nullptr;  // never closed: Mesa, LLVM and GLib keep threads, exit handlers and types in it
    std::string name_;
};

}  // namespace tumble
