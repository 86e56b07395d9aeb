#include "core/input_file.h"

#include "core/error.h"

#include <fmt/format.h>

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <system_error>

namespace tumble {
namespace {

std::string system_text(int error) { return "cannot be read: " + std::generic_category().message(error); }

[[noreturn]] void fail_with(int error) {
    const bool missing = error == ENOENT || error == ENOTDIR;
    throw UnreadableFile(missing ? "does not exist" : system_text(error), error);
}

void check_kind(const struct stat& state) {
    if (S_ISDIR(state.st_mode)) throw UnreadableFile("is a folder, not a file");
    if (!S_ISREG(state.st_mode)) throw UnreadableFile("is not a regular file");
}

void check_size(std::int64_t size, std::int64_t most) {
    if (size > most) throw UnreadableFile(fmt::format("is larger than {} MiB", most >> 20));
}

template <class Read>
auto with_input_error(const std::filesystem::path& file, const std::string& what, const Read& read) {
    try {
        return read();
    } catch (const UnreadableFile& error) {
        const std::string problem = error.error() != 0 ? system_text(error.error()) : error.what();
        throw InputError({file.string(), 0, 0}, what.empty() ? problem : fmt::format("{} {}", what, problem));
    }
}

}  // namespace

OpenFile open_regular_file(const std::filesystem::path& file) {
    // Checked before opening, because opening has an effect on some devices.
    struct stat state {};
    if (::stat(file.c_str(), &state) != 0) fail_with(errno);
    check_kind(state);
    // Checked again after opening, because the name may have been replaced; O_NONBLOCK avoids waiting for the writer of
    // a FIFO.
    const int descriptor = ::open(file.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK | O_NOCTTY);
    if (descriptor < 0) fail_with(errno);
    OpenFile opened(::fdopen(descriptor, "rb"));
    if (!opened) {
        const int error = errno;
        ::close(descriptor);
        fail_with(error);
    }
    if (::fstat(descriptor, &state) != 0) fail_with(errno);
    check_kind(state);
    return opened;
}

std::string read_regular_file(const std::filesystem::path& file, std::int64_t most) {
    const OpenFile opened = open_regular_file(file);
    struct stat state {};
    if (::fstat(::fileno(opened.get()), &state) != 0) fail_with(errno);
    check_size(state.st_size, most);
    std::string bytes(static_cast<std::size_t>(state.st_size) + 1, '\0');  // one more, to detect the end of the file
    std::size_t size = 0;
    while (true) {
        const ssize_t got = ::read(::fileno(opened.get()), bytes.data() + size, bytes.size() - size);
        if (got < 0 && errno == EINTR) continue;
        if (got < 0) fail_with(errno);
        if (got == 0) break;
        size += static_cast<std::size_t>(got);
        check_size(static_cast<std::int64_t>(size), most);
        if (size == bytes.size()) bytes.resize(2 * size);
    }
    bytes.resize(size);
    return bytes;
}

OpenFile open_input_file(const std::filesystem::path& file, const std::string& what) {
    return with_input_error(file, what, [&] { return open_regular_file(file); });
}

std::string read_input_file(const std::filesystem::path& file, const std::string& what, std::int64_t most) {
    return with_input_error(file, what, [&] { return read_regular_file(file, most); });
}

}  // namespace tumble
