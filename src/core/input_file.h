// Files that a command reads. Each is a regular file; links are followed. A folder, a pipe, a socket or a device is
// refused without waiting for it: opening one may wait, or act on it.
#pragma once

#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <limits>
#include <memory>
#include <stdexcept>
#include <string>

namespace tumble {

struct CloseFile {
    void operator()(std::FILE* file) const { std::fclose(file); }
};
using OpenFile = std::unique_ptr<std::FILE, CloseFile>;

/// what() goes on after the name of the file: "does not exist", "is not a regular file".
class UnreadableFile : public std::runtime_error {
public:
    explicit UnreadableFile(const std::string& problem, int error = 0) : std::runtime_error(problem), error_(error) {}
    int error() const { return error_; }  // of the system; 0: it gave none

private:
    int error_;
};

inline constexpr std::int64_t any_size = std::numeric_limits<std::int64_t>::max();

/// Throws UnreadableFile.
OpenFile open_regular_file(const std::filesystem::path& file);

/// All bytes. Throws UnreadableFile, also for a file of more than `most` bytes.
std::string read_regular_file(const std::filesystem::path& file, std::int64_t most = any_size);

/// The same with an InputError that names the file. `what`: its kind for the message, as in "the scene".
OpenFile open_input_file(const std::filesystem::path& file, const std::string& what = {});
std::string read_input_file(const std::filesystem::path& file, const std::string& what = {},
                            std::int64_t most = any_size);

}  // namespace tumble
