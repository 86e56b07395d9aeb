#include "compare/glob.h"

#include <vector>

namespace tumble {
namespace {

struct Token {
    enum class Kind { one, any_of, any_in_name, any, any_folders } kind;
    std::string_view set;  // between the brackets
    char character = 0;    // of `one` with a fixed character; 0: '?'
    bool inverted = false;
};

/// One after the ']' of a set that begins at `first`, or npos. A ']' that comes first is a member.
std::size_t end_of_set(std::string_view pattern, std::size_t first) {
    std::size_t i = first + 1;
    if (i < pattern.size() && pattern[i] == '!') ++i;
    if (i < pattern.size() && pattern[i] == ']') ++i;
    const std::size_t close = pattern.find(']', i);
    return close == std::string_view::npos ? close : close + 1;
}

std::vector<Token> tokens_of(std::string_view pattern) {
    std::vector<Token> tokens;
    for (std::size_t i = 0; i < pattern.size();) {
        if (pattern.substr(i, 3) == "**/" && (i == 0 || pattern[i - 1] == '/')) {
            tokens.push_back({Token::Kind::any_folders, {}});
            i += 3;
        } else if (pattern.substr(i, 2) == "**") {
            tokens.push_back({Token::Kind::any, {}});
            i += 2;
        } else if (pattern[i] == '*') {
            tokens.push_back({Token::Kind::any_in_name, {}});
            ++i;
        } else if (const std::size_t end = pattern[i] == '[' ? end_of_set(pattern, i) : std::string_view::npos;
                   end != std::string_view::npos) {
            std::string_view set = pattern.substr(i + 1, end - i - 2);
            const bool inverted = set.front() == '!';
            if (inverted) set.remove_prefix(1);
            tokens.push_back({Token::Kind::any_of, set, 0, inverted});
            i = end;
        } else if (pattern[i] == '\\' && i + 1 < pattern.size()) {
            tokens.push_back({Token::Kind::one, {}, pattern[i + 1]});
            i += 2;
        } else {
            tokens.push_back({Token::Kind::one, {}, pattern[i] == '?' ? '\0' : pattern[i]});
            ++i;
        }
    }
    return tokens;
}

bool in_set(const Token& token, char c) {
    bool found = false;
    const auto byte = [](char of) { return static_cast<unsigned char>(of); };
    for (std::size_t i = 0; i < token.set.size(); ++i) {
        if (i + 2 < token.set.size() && token.set[i + 1] == '-') {
            found |= byte(token.set[i]) <= byte(c) && byte(c) <= byte(token.set[i + 2]);
            i += 2;
        } else {
            found |= token.set[i] == c;
        }
    }
    return found != token.inverted;
}

/// The positions of the name at which the rest of it may begin after a token, given those before it. Work is bounded by
/// the product of the lengths, for any pattern.
std::vector<char> after(const Token& token, std::string_view name, const std::vector<char>& before) {
    std::vector<char> to(name.size() + 1, 0);
    bool carried = false;
    for (std::size_t i = 0; i <= name.size(); ++i) {
        const bool here = before[i] != 0;
        switch (token.kind) {
            case Token::Kind::one:
                if (here && i < name.size() && (token.character != 0 ? name[i] == token.character : name[i] != '/'))
                    to[i + 1] = 1;
                break;
            case Token::Kind::any_of:
                if (here && i < name.size() && name[i] != '/' && in_set(token, name[i])) to[i + 1] = 1;
                break;
            case Token::Kind::any_in_name:
                if (i > 0 && name[i - 1] == '/') carried = false;
                carried |= here;
                to[i] = carried;
                break;
            case Token::Kind::any:
                carried |= here;
                to[i] = carried;
                break;
            case Token::Kind::any_folders:  // the start of any later part
                if (here) to[i] = 1;
                if (carried && i > 0 && name[i - 1] == '/') to[i] = 1;
                carried |= here;
                break;
        }
    }
    return to;
}

}  // namespace

bool glob_matches(std::string_view pattern, std::string_view name) {
    if (pattern.find('/') == std::string_view::npos) {
        const std::size_t slash = name.rfind('/');
        if (slash != std::string_view::npos) name.remove_prefix(slash + 1);
    }
    std::vector<char> places(name.size() + 1, 0);
    places[0] = 1;
    for (const Token& token : tokens_of(pattern)) places = after(token, name, places);
    return places.back() != 0;
}

std::optional<std::string> glob_mistake(std::string_view pattern) {
    if (pattern.empty()) return "is empty";
    if (pattern.front() == '/') return "begins with '/': names are relative to the folder";
    for (std::size_t i = 0; i < pattern.size(); ++i) {
        if (pattern[i] == '\\') {
            if (++i == pattern.size()) return "ends with '\\'";
        } else if (pattern[i] == '[') {
            const std::size_t end = end_of_set(pattern, i);
            if (end == std::string_view::npos) return "has a '[' without ']'";
            i = end - 1;
        }
    }
    return std::nullopt;
}

}  // namespace tumble
