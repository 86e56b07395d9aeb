#include "app/manual/help_footer.h"

#include "app/manual/command_text.h"

#include <algorithm>
#include <cctype>

namespace tumble::manual {
namespace {

bool is_digit(const std::string& text, std::size_t at) {
    return at < text.size() && std::isdigit(static_cast<unsigned char>(text[at])) != 0;
}

bool begins_examples(const std::string& line) {
    return line == "Example:" || line == "Examples:" || line == "Start here:";
}

/// The end of a code's text: the comma before the next code, or the end of the sentence. Brackets may hold both.
std::size_t end_of_code(const std::string& text, std::size_t at) {
    int depth = 0;
    for (; at < text.size(); ++at) {
        const char c = text[at];
        depth += c == '(' ? 1 : c == ')' ? -1 : 0;
        const bool word_ends = at + 1 == text.size() || text[at + 1] == ' ';
        if (depth == 0 && (c == '.' || c == ';') && word_ends) break;
        if (depth == 0 && c == ',' && text.compare(at, 2, ", ") == 0 && is_digit(text, at + 2)) break;
    }
    return at;
}

}  // namespace

HelpFooter read_footer(const std::string& footer) {
    HelpFooter parts;
    bool in_examples = false;
    for (const std::string& line : lines_of(footer)) {
        in_examples = begins_examples(line) || (in_examples && line.starts_with(' '));
        if (begins_examples(line)) continue;
        (in_examples ? parts.examples : parts.notes).push_back(line);
    }
    return parts;
}

std::vector<ExitCode> exit_codes_in(const std::string& help) {
    const std::string text = replaced(help, "\n", " ");
    std::vector<ExitCode> codes;
    for (std::size_t at = text.find("xit code"); at != std::string::npos; at = text.find("xit code", at)) {
        at = text.find(' ', at + 4);  // "Exit codes:", "exit code"
        while (at != std::string::npos && is_digit(text, at + 1) && text.compare(at + 2, 1, " ") == 0) {
            const std::size_t end = end_of_code(text, at + 3);
            codes.emplace_back(text[at + 1] - '0', text.substr(at + 3, end - at - 3));
            at = end < text.size() && text[end] == ',' ? end + 1 : std::string::npos;
        }
        if (!codes.empty() || at == std::string::npos) break;
    }
    return codes;
}

}  // namespace tumble::manual
