#include "app/cli/unknown_word.h"

#include "core/safe_text.h"
#include "scene/toml/error_text.h"

#include <fmt/format.h>

#include <algorithm>
#include <functional>
#include <string_view>
#include <vector>

namespace tumble {
namespace {

std::string nearest(std::string_view given, const std::vector<std::string>& known) {
    return did_you_mean(given, {known.begin(), known.end()});
}

std::vector<const CLI::App*> commands_of(const CLI::App& command) {
    return command.get_subcommands([](const CLI::App*) { return true; });
}

std::string unknown_command(const CLI::App& command, std::string_view word) {
    std::vector<std::string> names;
    for (const CLI::App* one : commands_of(command))
        if (!one->get_group().empty()) names.push_back(one->get_name());
    return fmt::format("unknown command \"{}\"{}", safe_text(word), nearest(word, names));
}

std::string unknown_option(const CLI::App& command, std::string_view word) {
    std::vector<std::string> names;
    for (const CLI::Option* one : command.get_options())
        for (const std::string& name : one->get_lnames())
            if (!one->get_group().empty()) names.push_back("--" + name);
    const std::string whole = command.get_parent() == nullptr
                                  ? command.get_name()
                                  : command.get_parent()->get_name() + " " + command.get_name();
    return fmt::format("unknown option \"{}\" of {}{}", safe_text(word), whole, nearest(word, names));
}

}  // namespace

std::string unknown_word(const CLI::App& program, std::span<const char* const> words) {
    const CLI::App* command = &program;
    for (std::size_t i = 0; i < words.size(); ++i) {
        const std::string word = words[i];
        if (word == "--") return "";
        if (word.size() > 1 && word[0] == '-') {
            const std::string name = word[1] == '-' ? word.substr(0, word.find('=')) : word.substr(0, 2);
            const CLI::Option* const option = command->get_option_no_throw(name);
            if (option == nullptr) return unknown_option(*command, word.substr(0, word.find('=')));
            if (option->get_items_expected_max() > 0 && name == word) ++i;  // its value
            continue;
        }
        const std::vector<const CLI::App*> commands = commands_of(*command);
        if (commands.empty()) continue;
        const auto found = std::ranges::find(commands, word, [](const CLI::App* one) { return one->get_name(); });
        if (found == commands.end()) return unknown_command(*command, word);
        command = *found;
    }
    return "";
}

}  // namespace tumble
