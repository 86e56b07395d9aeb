#include "output/file_bytes.h"

#include <fcntl.h>
#include <isa-l/crc.h>
#include <isa-l/crc64.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>

namespace tumble {

std::optional<std::string> bytes_of_file(const std::filesystem::path& path, std::size_t most) {
    const int file = ::open(path.c_str(), O_RDONLY | O_NONBLOCK | O_CLOEXEC);
    if (file < 0) return std::nullopt;
    struct stat status {};
    bool good = ::fstat(file, &status) == 0 && S_ISREG(status.st_mode);
    std::string bytes;
    if (good) bytes.resize(std::min(most, std::size_t(status.st_size)));
    for (std::size_t done = 0; good && done < bytes.size();) {
        const ssize_t n = ::read(file, bytes.data() + done, bytes.size() - done);
        if (n < 0 && errno == EINTR) continue;
        good = n > 0;
        done += std::size_t(std::max<ssize_t>(n, 0));
    }
    ::close(file);
    return good ? std::optional(std::move(bytes)) : std::nullopt;
}

std::uint32_t crc32_of(std::uint32_t before, std::span<const std::byte> bytes) {
    return crc32_gzip_refl(before, reinterpret_cast<const unsigned char*>(bytes.data()), bytes.size());
}

std::uint64_t crc64(std::span<const std::byte> bytes) {
    return crc64_ecma_refl(0, reinterpret_cast<const unsigned char*>(bytes.data()), bytes.size());
}

}  // namespace tumble
