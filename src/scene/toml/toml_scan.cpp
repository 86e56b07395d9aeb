#include "scene/toml/toml_scan.h"

#include "core/available_memory.h"
#include "core/error.h"
#include "scene/toml/limits.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstdint>
#include <optional>

namespace tumble {
namespace {

// Bytes of toml++ 3.3's nodes on the heap (glibc, x86-64), measured with some million of each: keys of numbers take 173
// and of tables 220, items 59 to 103. A refused text certainly does not fit.
constexpr std::uint64_t key_bytes = 170, item_bytes = 59;

/// A line break ends an unclosed string of one line: the parser reports an error there.
std::size_t end_of_string(std::string_view text, std::size_t first) {
    const char quote = text[first];
    const bool escapes = quote == '"';
    const std::string_view triple = text.substr(first, 3);
    const bool lines = triple.size() == 3 && triple[1] == quote && triple[2] == quote;
    for (std::size_t i = first + (lines ? 3 : 1); i < text.size(); ++i) {
        if (escapes && text[i] == '\\')
            ++i;
        else if (!lines && (text[i] == quote || text[i] == '\n'))
            return i + 1;
        else if (lines && text.substr(i, 3) == triple)
            return i + 3;
    }
    return text.size();
}

struct Scan {
    TomlAmounts amounts;
    std::optional<std::size_t> deep_key;  // position of a key with too many parts
};

Scan scanned(std::string_view text) {
    Scan scan;
    std::size_t dots = 0;  // in the current key or number
    for (std::size_t i = 0; i < text.size();) {
        const char c = text[i];
        if (c == '"' || c == '\'') {
            i = end_of_string(text, i);
            continue;
        }
        ++i;
        switch (c) {
            case '.':
                if (++dots >= std::size_t(limits::key_parts) && !scan.deep_key) scan.deep_key = i - 1;
                break;
            case '#':
                i = std::min(text.find('\n', i), text.size());
                break;
            case '=':
                scan.amounts.keys += dots + 1;
                dots = 0;
                break;
            case ']':
                if (dots > 1) scan.amounts.keys += dots;  // a header; a number has one
                dots = 0;
                break;
            case '[':
            case '{':
            case ',':
                ++scan.amounts.items;
                dots = 0;
                break;
            case '}':
            case '\n':
                dots = 0;
                break;
            default:  // of keys, numbers and words
                break;
        }
    }
    return scan;
}

/// Columns count characters, like the parser's.
SourceLocation location_in(std::string_view text, std::size_t at, const std::string& file) {
    const std::string_view before = text.substr(0, at);
    const std::size_t line_start = before.rfind('\n') == std::string_view::npos ? 0 : before.rfind('\n') + 1;
    const auto starts_character = [](char c) { return (static_cast<unsigned char>(c) & 0xc0) != 0x80; };
    return {file, 1 + int(std::count(before.begin(), before.end(), '\n')),
            1 + int(std::count_if(before.begin() + std::ptrdiff_t(line_start), before.end(), starts_character))};
}

}  // namespace

TomlAmounts toml_amounts(std::string_view text) { return scanned(text).amounts; }

void check_toml_amounts(std::string_view text, const std::string& file) {
    const Scan scan = scanned(text);
    if (scan.deep_key)
        throw InputError(
            location_in(text, *scan.deep_key, file),
            fmt::format("a key has more than {} parts, which is deeper than a scene goes", limits::key_parts));
    const auto [keys, items] = scan.amounts;
    require_memory(key_bytes * keys + item_bytes * items, fmt::format("a scene of {} keys and {} items", keys, items),
                   "a grid or scatter makes many bodies of one table");
}

}  // namespace tumble
