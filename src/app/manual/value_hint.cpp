#include "app/manual/value_hint.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <string_view>

namespace tumble::manual {
namespace {

constexpr std::string_view lower_case = "abcdefghijklmnopqrstuvwxyz";
constexpr std::string_view word_characters = "abcdefghijklmnopqrstuvwxyz0123456789-";
constexpr std::array folder_names = {"DIR", "SITE", "FOLDER"};
constexpr std::array file_names = {"FILE", "CLIP"};

template <class Names>
bool is_one_of(const std::string& text, const Names& names) {
    return std::find(names.begin(), names.end(), text) != names.end();
}

void add_once(std::vector<std::string>& texts, std::string text) {
    if (!is_one_of(text, texts)) texts.push_back(std::move(text));
}

/// Endings as single words: ".svg .png or .pdf". A full stop at the end of a sentence and names such as "t.csv" are none.
std::vector<std::string> endings_in(const std::string& help) {
    std::vector<std::string> endings;
    for (std::size_t dot = help.find('.'); dot != std::string::npos; dot = help.find('.', dot + 1)) {
        const bool begins = dot == 0 || std::string_view(" \n(").find(help[dot - 1]) != std::string_view::npos;
        const std::size_t end = std::min(help.find_first_not_of(word_characters, dot + 1), help.size());
        const bool sentence_ends =
            help[end] == '.' && (end + 1 == help.size() || help.find_first_of(" \n", end) == end + 1);
        const bool ends = end == help.size() || sentence_ends || (help[end] != '.' && help[end] != '/');
        if (begins && ends && end - dot > 2) add_once(endings, help.substr(dot + 1, end - dot - 1));
    }
    return endings;
}

/// The words after "out of", separated by commas without spaces; a line may break after a comma.
std::vector<std::string> list_in(const std::string& help) {
    constexpr std::string_view before = "out of";
    std::vector<std::string> words;
    std::size_t at = help.find(before);
    if (at == std::string::npos) return words;
    at = help.find_first_of(lower_case, at + before.size());
    if (at == std::string::npos) return words;
    if (help.find("none, or") < at) words.emplace_back("none");
    while (at < help.size()) {
        const std::size_t end = std::min(help.find_first_not_of(word_characters, at), help.size());
        if (end == at) break;
        words.push_back(help.substr(at, end - at));
        if (end == help.size() || help[end] != ',') break;
        at = end + 1;
        if (at < help.size() && help[at] == '\n') ++at;
    }
    return words;
}

/// Scenes, suites, plans: the help says so in brackets, "(TOML)" or "(TOML; docs/...)". Single letters stand for files of
/// several kinds.
bool is_toml(const std::string& help) {
    const std::size_t at = help.find("(TOML");
    return at != std::string::npos && at + 5 < help.size() && (help[at + 5] == ')' || help[at + 5] == ';');
}

void add_alternative(ValueHint& hint, const std::string& name, const std::string& help) {
    const std::size_t dot = name.rfind('.');
    if (dot != std::string::npos) {
        hint.files = true;
        if (dot + 1 < name.size()) add_once(hint.endings, name.substr(dot + 1));
        for (std::string& ending : endings_in(help)) add_once(hint.endings, std::move(ending));
    } else if (is_one_of(name, folder_names)) {
        hint.folders = true;
    } else if (is_one_of(name, file_names)) {
        hint.files = true;
        for (std::string& ending : endings_in(help)) add_once(hint.endings, std::move(ending));
    } else if (name.size() > 1 && is_toml(help)) {
        hint.files = true;
        add_once(hint.endings, "toml");
    } else if (name == "LIST") {
        hint.words = list_in(help);
        hint.word_list = true;
    } else if (!name.empty() && name.find_first_not_of(word_characters) == std::string::npos &&
               std::islower(static_cast<unsigned char>(name[0])) != 0) {
        hint.words.push_back(name);
    }
}

}  // namespace

ValueHint ValueHint::of(const std::string& value, const std::string& help) {
    ValueHint hint;
    const std::string names = value.substr(0, value.find(' '));
    for (std::size_t first = 0; first < names.size();) {
        const std::size_t end = std::min(names.find('|', first), names.size());
        add_alternative(hint, names.substr(first, end - first), help);
        first = end + 1;
    }
    return hint;
}

}  // namespace tumble::manual
