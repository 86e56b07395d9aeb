#include "output/png_check.h"

#include "output/file_bytes.h"
#include "output/png_writer.h"

#include <cstdint>
#include <string_view>

namespace tumble {
namespace {

constexpr std::string_view signature = "\x89PNG\r\n\x1a\n";

std::uint32_t number_at(std::string_view bytes, std::size_t at) {
    std::uint32_t number = 0;
    for (std::size_t i = 0; i < 4; ++i) number = number << 8 | static_cast<unsigned char>(bytes[at + i]);
    return number;
}

/// State of a file that starts with these bytes, up to the first fault.
PngState state_of(std::string_view bytes) {
    PngState state;
    if (!bytes.starts_with(signature)) return state;
    bool head = false, pixels = false;
    for (std::size_t at = signature.size(); at + 12 <= bytes.size();) {
        const std::size_t size = number_at(bytes, at);
        if (size > bytes.size() - at - 12) return state;
        const std::string_view name = bytes.substr(at + 4, 4), data = bytes.substr(at + 8, size);
        const std::string_view checked = bytes.substr(at + 4, 4 + size);
        if (crc32_of(0, std::as_bytes(std::span(checked))) != number_at(bytes, at + 8 + size)) return state;
        at += 12 + size;
        if (!head && name != "IHDR") return state;
        head = true;
        pixels = pixels || name == "IDAT";
        if (name == "tEXt" && data.starts_with(png_mark_keyword) && data.size() > png_mark_keyword.size() &&
            data[png_mark_keyword.size()] == '\0')
            state.mark = data.substr(png_mark_keyword.size() + 1);
        if (name == "IEND") {
            state.whole = pixels && at == bytes.size();
            return state;
        }
    }
    return state;
}

}  // namespace

PngState state_of_png(const std::filesystem::path& path) {
    const std::optional<std::string> file = bytes_of_file(path);
    return file ? state_of(*file) : PngState();
}

std::optional<std::string> mark_of_png(const std::filesystem::path& path) {
    constexpr std::size_t head = 512;  // bytes: the mark ends at 150
    const std::optional<std::string> file = bytes_of_file(path, head);
    return file ? state_of(*file).mark : std::nullopt;
}

}  // namespace tumble
