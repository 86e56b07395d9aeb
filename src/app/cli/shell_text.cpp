#include "app/cli/shell_text.h"

#include "core/safe_text.h"

#include <string_view>

namespace tumble {

std::string shell_text(std::span<const char* const> words) {
    constexpr std::string_view plain = "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_@%+=:,./-";
    std::string text;
    for (const std::string_view word : words) {
        if (!text.empty()) text += ' ';
        if (!word.empty() && word.find_first_not_of(plain) == std::string_view::npos) {
            text += word;
            continue;
        }
        text += '\'';
        for (const char c : word)
            if (c == '\'')
                text += "'\\''";
            else
                text += c;
        text += '\'';
    }
    return safe_text(text, message_text_bytes / 2) == text ? text : "";
}

}  // namespace tumble
