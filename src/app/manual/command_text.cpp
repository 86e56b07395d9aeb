#include "app/manual/command_text.h"

#include <algorithm>

namespace tumble::manual {

std::vector<std::string> lines_of(const std::string& text) {
    std::vector<std::string> lines;
    for (std::size_t first = 0; first < text.size();) {
        const std::size_t end = std::min(text.find('\n', first), text.size());
        lines.push_back(text.substr(first, end - first));
        first = end + 1;
    }
    return lines;
}

std::string joined(const std::vector<std::string>& texts, const std::string& separator) {
    std::string all;
    for (std::size_t i = 0; i < texts.size(); ++i) all += (i == 0 ? "" : separator) + texts[i];
    return all;
}

std::string replaced(std::string text, const std::string& from, const std::string& to) {
    for (std::size_t at = text.find(from); at != std::string::npos; at = text.find(from, at + to.size()))
        text.replace(at, from.size(), to);
    return text;
}

std::string short_help(const std::string& help) {
    constexpr std::size_t most = 90;  // characters, so that a name and its text fit into a line
    std::string text = replaced(help, "\n", " ");
    text.resize(std::min(text.find(". "), text.size()));
    if (text.size() <= most) return text;
    const std::size_t space = text.rfind(' ', most - 3);
    return text.substr(0, space == std::string::npos ? most - 3 : space) + "...";
}

}  // namespace tumble::manual
