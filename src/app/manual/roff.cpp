#include "app/manual/roff.h"

#include <cctype>

namespace tumble::manual {
namespace {

/// A line that begins with a control character is text all the same.
std::string guarded(const std::string& line) {
    return !line.empty() && (line[0] == '.' || line[0] == '\'') ? "\\&" + line : line;
}

/// Lines of one list without spaces, "a,b," and "c,d", become one: a filled paragraph would put a space between them.
std::vector<std::string> with_whole_lists(const std::vector<std::string>& lines) {
    std::vector<std::string> whole;
    for (const std::string& line : lines) {
        const std::size_t comma = line.substr(0, line.find(' ')).find(',');
        if (!whole.empty() && whole.back().ends_with(',') && comma != std::string::npos && comma + 1 < line.size())
            whole.back() += line;
        else
            whole.push_back(line);
    }
    return whole;
}

}  // namespace

std::string roff(const std::string& text) {
    std::string out;
    for (std::size_t i = 0; i < text.size(); ++i) {
        const char c = text[i];
        const char next = i + 1 < text.size() ? text[i + 1] : ' ';
        if (c == '\\')
            out += "\\e";
        else if (c == '-')
            out += "\\-";
        else if (c == '"')
            out += "\\(dq";
        else if (c == '\'')
            out += "\\(aq";
        else if (c == '`')
            out += "\\(ga";
        else if (c == '^')
            out += "\\(ha";
        else if (c == '~')
            out += "\\(ti";
        else
            out += c;
        if (c == ',' && std::isspace(static_cast<unsigned char>(next)) == 0) out += "\\:";  // long lists may break
    }
    return guarded(out);
}

std::string roff_code(const std::string& text) { return "\\fB" + roff(text) + "\\fR"; }

std::string roff_lines(const std::vector<std::string>& lines) {
    std::string out = ".nf\n";
    for (const std::string& line : lines) out += roff(line) + '\n';
    return out + ".fi\n";
}

std::string roff_paragraphs(const std::vector<std::string>& lines) {
    std::string out;
    std::vector<std::string> indented;
    const auto finish = [&] {
        if (!indented.empty()) out += roff_lines(indented);
        indented.clear();
    };
    for (const std::string& line : with_whole_lists(lines)) {
        if (line.starts_with(' ')) {
            indented.push_back(line);
            continue;
        }
        finish();
        out += line.empty() ? ".PP\n" : roff(line) + '\n';
    }
    finish();
    return out;
}

}  // namespace tumble::manual
