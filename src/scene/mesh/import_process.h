// A child process in which a library reads a file, with limits of memory and time: libraries allocate as much as a file
// claims, and some files crash them.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <string>
#include <string_view>
#include <vector>

namespace tumble {

struct ImportLimits {
    const char* library;   // its name, for errors
    std::uint64_t memory;  // bytes beyond the program's own
    unsigned seconds;
    const char* instead;  // kinds of file to save one as that crashes the library
};

/// The result, on its way from the child.
class ImportOutput {
public:
    explicit ImportOutput(int pipe) : pipe_(pipe) {}

    void write(const void* data, std::size_t size);
    /// A list with its length before it.
    template <class T>
    void write(const std::vector<T>& list) {
        const std::uint64_t count = list.size();
        write(&count, sizeof count);
        write(list.data(), list.size() * sizeof(T));
    }
    bool empty() const { return empty_; }

private:
    int pipe_;
    bool empty_ = true;
};

/// Calls `work` in a child and returns the bytes that it wrote. A child that the library corrupted may have written
/// anything. Throws MeshError if `work` throws, crashes, or exceeds the limits; `work` throws before it writes.
std::string run_import(const ImportLimits& limits, const std::function<void(ImportOutput&)>& work);

}  // namespace tumble
