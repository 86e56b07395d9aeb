#include "app/farm/shell_text.h"

#include <algorithm>

namespace tumble {

std::string shell_word(std::string_view text) {
    constexpr std::string_view plain = "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_./:,@%+-";
    if (!text.empty() && text.find_first_not_of(plain) == std::string_view::npos) return std::string(text);
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
