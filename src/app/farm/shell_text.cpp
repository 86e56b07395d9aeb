#include "app/farm/shell_text.h"

namespace tumble {

bool is_plain_word(std::string_view text) {
    constexpr std::string_view plain = "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_./:,@%+-=";
    return !text.empty() && text.find_first_not_of(plain) == std::string_view::npos;
}

std::string shell_word(std::string_view text) {
    if (is_plain_word(text)) return std::string(text);
    std::string word = "'";
    for (const char c : text) {
        if (c == '\'')
            word += "'\\''";
        else
            word += c;
    }
    return word + "'";
}

std::string shell_array(std::string_view name, const std::vector<std::string>& words) {
    std::string line(name);
    line += "=(";
    for (const std::string& word : words) line.append(" ").append(shell_word(word));
    line += " )";
    return line;
}

}  // namespace tumble
