#include "core/safe_text.h"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>

namespace tumble {
namespace {

/// The character at the start of the text and its bytes; no bytes: the text does not start with complete, valid UTF-8
/// (RFC 3629).
struct Character {
    char32_t code = 0;
    std::size_t bytes = 0;
};

Character first_character(std::string_view text) {
    const auto byte = [&](std::size_t i) { return static_cast<unsigned char>(text[i]); };
    const unsigned char lead = byte(0);
    if (lead < 0x80) return {lead, 1};
    const std::size_t bytes = lead >= 0xf0 ? 4 : lead >= 0xe0 ? 3 : 2;
    if (lead < 0xc2 || lead > 0xf4 || text.size() < bytes) return {};
    char32_t code = lead & (0x7fu >> bytes);
    for (std::size_t i = 1; i < bytes; ++i) {
        if ((byte(i) & 0xc0) != 0x80) return {};
        code = code << 6 | (byte(i) & 0x3fu);
    }
    constexpr char32_t least[] = {0, 0, 0x80, 0x800, 0x10000};  // a smaller code would be an overlong form
    const bool surrogate = code >= 0xd800 && code <= 0xdfff;
    if (code < least[bytes] || code > 0x10ffff || surrogate) return {};
    return {code, bytes};
}

/// Control characters, and those of Unicode's format characters (category Cf) and separators that are invisible or move
/// other text. The two joiners (200c, 200d) belong to the spelling of words and are safe.
bool is_unsafe(char32_t code) {
    struct Span {
        char32_t first, last;
    };
    constexpr Span unsafe[] = {
        {0x00, 0x1f},
        {0x7f, 0x9f},  // C0, delete, C1
        {0xad, 0xad},
        {0x180e, 0x180e},  // soft hyphen, Mongolian vowel separator
        {0x61c, 0x61c},
        {0x200e, 0x200f},  // marks of the reading direction
        {0x200b, 0x200b},
        {0xfeff, 0xfeff},  // spaces without a width
        {0x2028, 0x202e},
        {0x2060, 0x206f},  // separators of lines, embeddings, overrides, isolates, invisible operators
        {0xfff9, 0xfffb},
        {0xe0000, 0xe007f},  // annotations, tags
    };
    return std::any_of(std::begin(unsafe), std::end(unsafe), [&](Span s) { return code >= s.first && code <= s.last; });
}

std::string escaped(char32_t code) {
    switch (code) {
        case '\n':
            return "\\n";
        case '\r':
            return "\\r";
        case '\t':
            return "\\t";
        default:
            break;
    }
    const auto number = static_cast<unsigned>(code);
    if (code < 0x80) return fmt::format("\\x{:02x}", number);
    return code > 0xffff ? fmt::format("\\U{:08x}", number) : fmt::format("\\u{:04x}", number);
}

std::string escaped(std::string_view text, std::size_t longest, bool lines) {
    std::string safe;
    std::size_t room_for_end = 0;  // bytes of `safe` that fit together with the note about the cut
    const std::string end = fmt::format("... ({} bytes)", text.size());
    for (std::string_view rest = text; !rest.empty();) {
        const Character next = first_character(rest);
        const std::size_t taken = std::max<std::size_t>(next.bytes, 1);
        if (next.bytes == 0)
            safe += fmt::format("\\x{:02x}", static_cast<unsigned char>(rest[0]));
        else if (lines && (next.code == '\n' || next.code == '\t'))
            safe += rest[0];
        else if (is_unsafe(next.code))
            safe += escaped(next.code);
        else
            safe += rest.substr(0, taken);
        if (safe.size() > longest) return safe.substr(0, room_for_end) + end;
        if (safe.size() + end.size() <= longest) room_for_end = safe.size();
        rest.remove_prefix(taken);
    }
    return safe;
}

}  // namespace

std::string safe_text(std::string_view text, std::size_t longest) { return escaped(text, longest, false); }

std::string safe_lines(std::string_view text, std::size_t longest) { return escaped(text, longest, true); }

std::string safe_path(const std::filesystem::path& path) { return safe_text(path.native(), path_text_bytes); }

bool has_control_characters(std::string_view text) {
    return std::ranges::any_of(text, [](char c) { return (c >= 0 && c < ' ') || c == '\x7f'; });
}

}  // namespace tumble
