#include "scene/mesh/input_file.h"

#include "scene/mesh/mesh_file.h"

#include <fmt/format.h>

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>
#include <cerrno>
#include <system_error>

namespace tumble {
namespace {

class Descriptor {
public:
    explicit Descriptor(int number) : number_(number) {}
    ~Descriptor() {
        if (number_ >= 0) close(number_);
    }
    Descriptor(const Descriptor&) = delete;
    Descriptor& operator=(const Descriptor&) = delete;
    int number() const { return number_; }

private:
    int number_;
};

[[noreturn]] void fail_with(int error) {
    if (error == ENOENT || error == ENOTDIR) throw MeshError("does not exist");
    throw MeshError("cannot be read: " + std::generic_category().message(error));
}

}  // namespace

std::string read_regular_file(const std::filesystem::path& file, std::int64_t limit) {
    // Checked before opening, because opening has an effect on some devices.
    struct stat state {};
    if (stat(file.c_str(), &state) != 0) fail_with(errno);
    if (!S_ISREG(state.st_mode)) throw MeshError("is not a regular file");
    // Checked again after opening, because the name may have been replaced; O_NONBLOCK avoids waiting for the writer of
    // a FIFO.
    const Descriptor opened(open(file.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK | O_NOCTTY));
    if (opened.number() < 0 || fstat(opened.number(), &state) != 0) fail_with(errno);
    if (!S_ISREG(state.st_mode)) throw MeshError("is not a regular file");
    const auto check_size = [&](std::int64_t size) {
        if (size > limit) throw MeshError(fmt::format("is larger than {} MiB", limit >> 20));
    };
    check_size(state.st_size);
    std::string bytes(static_cast<std::size_t>(state.st_size) + 1, '\0');  // one more, to detect the end of the file
    std::size_t size = 0;
    while (true) {
        const ssize_t got = read(opened.number(), bytes.data() + size, bytes.size() - size);
        if (got < 0 && errno == EINTR) continue;
        if (got < 0) fail_with(errno);
        if (got == 0) break;
        size += static_cast<std::size_t>(got);
        check_size(static_cast<std::int64_t>(size));
        if (size == bytes.size()) bytes.resize(2 * size);
    }
    bytes.resize(size);
    return bytes;
}

}  // namespace tumble
