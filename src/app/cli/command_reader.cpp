#include "app/cli/command_reader.h"

#include <fmt/format.h>

#include <algorithm>
#include <functional>
#include <string>

namespace tumble {
namespace {

using manual::CommandText, manual::OptionText, manual::ValueHint;

bool has_digits_only(const std::string& text) {
    return !text.empty() && text.find_first_not_of("0123456789") == std::string::npos;
}

/// "N [3]". The number of processor cores as a default would tie the text to a machine.
std::string value_of(const CLI::Option& option) {
    if (option.get_items_expected_max() == 0) return "";
    std::string text = option.get_option_text();
    if (text.empty()) {
        text = option.get_type_name();
        text.resize(std::min(text.find(':'), text.size()));  // after it CLI11 names the checks
        if (const std::string usual = option.get_default_str(); !usual.empty()) text += fmt::format(" [{}]", usual);
    }
    if (const std::size_t at = text.find(" REQUIRED"); at != std::string::npos) text.resize(at);  // said elsewhere
    const bool by_cores = option.check_lname("threads") || option.check_lname("workers") || option.check_lname("jobs");
    const std::size_t bracket = text.find('[');
    if (by_cores && bracket != std::string::npos &&
        has_digits_only(text.substr(bracket + 1, text.find(']') - bracket - 1)))
        text = text.substr(0, bracket) + "[by the cores]";
    return text.empty() ? "VALUE" : text;
}

OptionText read_option(const CLI::Option& option) {
    OptionText text;
    if (option.nonpositional()) {
        for (const std::string& name : option.get_snames()) text.names.push_back("-" + name);
        for (const std::string& name : option.get_lnames()) text.names.push_back("--" + name);
    } else {
        text.names.push_back(option.get_name(true));
    }
    text.value = value_of(option);
    text.help = option.get_description();
    text.required = option.get_required();
    const bool several = option.get_expected_max() == CLI::detail::expected_max_vector_size;
    text.repeated = several || option.get_multi_option_policy() == CLI::MultiOptionPolicy::TakeAll;
    for (const CLI::Option* other : option.get_excludes()) text.excluded.push_back("--" + other->get_lnames().front());
    std::sort(text.excluded.begin(), text.excluded.end());  // CLI11 sorts them by address
    text.hint = ValueHint::of(text.value, text.help);
    return text;
}

}  // namespace

manual::CommandText read_command(CLI::App& command) {
    CommandText text;
    text.name = command.get_name();
    text.description = command.get_description();
    if (text.description.ends_with('.')) text.description.pop_back();
    // CLI11 gives commands the footer of the program, unless they have one.
    const CLI::App* const parent = command.get_parent();
    if (parent == nullptr || parent->get_footer() != command.get_footer()) text.footer = command.get_footer();
    for (const CLI::Option* option : command.get_options()) {
        if (option->get_group().empty()) continue;
        (option->nonpositional() ? text.options : text.arguments).push_back(read_option(*option));
    }
    // Arguments are files, unless they are names.
    for (OptionText& argument : text.arguments)
        argument.hint.files = argument.hint.files || (argument.hint.empty() && !argument.help.starts_with("Name"));
    for (CLI::App* part : command.get_subcommands(std::function<bool(CLI::App*)>()))
        if (!part->get_group().empty()) text.commands.push_back(read_command(*part));
    return text;
}

}  // namespace tumble
