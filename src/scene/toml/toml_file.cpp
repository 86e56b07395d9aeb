#include "scene/toml/toml_file.h"

#include "core/error.h"

#include <fmt/format.h>

#include <cerrno>
#include <cstring>
#include <fstream>
#include <system_error>

namespace tumble {

std::string read_toml_file(const std::filesystem::path& file, const std::string& what, std::int64_t most_bytes) {
    const SourceLocation whole{file.string(), 0, 0};
    const auto fail = [&](const std::string& problem) {
        throw InputError(whole, fmt::format("the {} {}", what, problem));
    };
    std::error_code error;
    if (std::filesystem::is_directory(file, error)) fail("is a folder, not a file");
    std::ifstream stream(file, std::ios::binary);
    if (!stream) fail(fmt::format("cannot be read: {}", std::strerror(errno)));
    std::string text;
    char block[1 << 16];
    while (stream.read(block, sizeof block), stream.gcount() > 0) {
        text.append(block, static_cast<std::size_t>(stream.gcount()));
        if (text.size() > static_cast<std::size_t>(most_bytes))
            fail(fmt::format("is larger than {} MiB", most_bytes >> 20));
    }
    if (stream.bad()) fail(fmt::format("cannot be read: {}", std::strerror(errno)));
    return text;
}

}  // namespace tumble
