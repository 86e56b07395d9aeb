#include "app/manual/command_text.h"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>

namespace tumble::manual {
namespace {

using Json = nlohmann::ordered_json;

Json codes_json(const std::vector<ExitCode>& codes) {
    Json list = Json::array();
    for (const auto& [code, meaning] : codes) list.push_back({{"code", code}, {"meaning", meaning}});
    return list;
}

Json option_json(const OptionText& option) {
    const ValueKind& kind = option.kind;
    Json json = {{"names", option.names}, {"help", replaced(option.help, "\n", " ")}, {"required", option.required}};
    json["repeated"] = option.repeated;
    json["type"] = !option.takes_value() ? "flag"
                   : kind.files          ? "file"
                   : kind.folders        ? "folder"
                   : kind.word_list      ? "list"
                   : !kind.words.empty() ? "choice"
                   : kind.number         ? "number"
                                         : "text";
    if (option.takes_value()) json["value"] = option.value;
    if (!option.usual.empty()) json["default"] = option.usual;
    if (!kind.words.empty()) json["choices"] = kind.words;
    if (!kind.endings.empty()) json["endings"] = kind.endings;
    if (!option.excluded.empty()) json["excludes"] = option.excluded;
    return json;
}

Json command_json(const CommandText& command) {
    Json json = {{"name", command.name}, {"description", replaced(command.description, "\n", " ")}};
    if (!command.exit_codes.empty()) json["exit_codes"] = codes_json(command.exit_codes);
    if (!command.notes.empty()) json["notes"] = lines_of(command.notes);
    if (!command.examples.empty()) json["examples"] = lines_of(command.examples);
    for (const char* list : {"arguments", "options", "commands"}) json[list] = Json::array();
    for (const OptionText& argument : command.arguments) json["arguments"].push_back(option_json(argument));
    for (const OptionText& option : command.options) json["options"].push_back(option_json(option));
    for (const CommandText& part : command.commands) json["commands"].push_back(command_json(part));
    return json;
}

}  // namespace

std::string codes_text(const std::vector<ExitCode>& codes) {
    std::vector<std::string> texts;
    for (const auto& [code, meaning] : codes) texts.push_back(fmt::format("{} {}", code, meaning));
    return joined(texts, ", ");
}

std::string sentence(const std::string& description, const std::vector<ExitCode>& codes) {
    return codes.empty() ? description : description + ": exit code " + codes_text(codes);
}

std::string to_json(const CommandText& program, const std::string& version) {
    Json json = {{"version", version}};
    json.update(command_json(program));
    return json.dump(1) + '\n';
}

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
