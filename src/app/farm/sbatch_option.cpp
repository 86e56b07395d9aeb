#include "app/farm/sbatch_option.h"

#include "app/farm/shell_text.h"
#include "core/error.h"
#include "core/safe_text.h"

#include <fmt/format.h>

#include <algorithm>

namespace tumble {
namespace {

/// An option that a farm sets, and the remedy; `letter` 0: there is no short form.
struct OwnOption {
    std::string_view name;
    char letter;
    const char* remedy;
};

constexpr const char* by_the_scripts = "is set by the scripts themselves";
constexpr OwnOption own_options[] = {
    {"array", 'a', by_the_scripts},
    {"cpus-per-task", 'c', "has an option of its own: --cpus-per-task"},
    {"dependency", 'd', by_the_scripts},
    {"job-name", 'J', by_the_scripts},
    {"kill-on-invalid-dep", 0, by_the_scripts},
    {"no-requeue", 0, by_the_scripts},
    {"open-mode", 0, by_the_scripts},
    {"output", 'o', by_the_scripts},
    {"parsable", 0, by_the_scripts},
    {"partition", 'p', "has an option of its own: --partition"},
    {"requeue", 0, by_the_scripts},
    {"test-only", 0, "submits nothing: use --write-only"},
    {"time", 't', "has an option of its own: --time"},
    {"wait", 'W', "would hold up the job: leave it out"},
    {"wrap", 0, by_the_scripts},
};
constexpr std::string_view short_flags = "hHIkOQsvVW";  // of sbatch: a letter after one of these is another option

/// The place of the value after the name: "=" of a long option, a space of both.
std::size_t end_of_name(std::string_view option) { return std::min(option.find_first_of("= "), option.size()); }

[[noreturn]] void refuse(std::string_view given, const char* why) {
    throw InputError(fmt::format("--sbatch: {} {}", safe_text(given), why));
}

void check_long(std::string_view name) {
    // sbatch takes the start of a name for the name.
    for (const OwnOption& own : own_options)
        if (own.name.starts_with(name)) refuse(fmt::format("--{}", own.name), own.remedy);
}

void check_short(std::string_view letters) {
    for (const char letter : letters) {
        for (const OwnOption& own : own_options)
            if (own.letter == letter) refuse(fmt::format("-{}", letter), own.remedy);
        if (short_flags.find(letter) == std::string_view::npos) return;  // the rest is its value
    }
}

/// One option, with a value in one word where it is not behind a '='.
bool is_one_option(std::string_view option) {
    const std::size_t end = end_of_name(option);
    const std::string_view name = option.substr(0, end);
    if (name.size() < 2 || name[0] != '-' || name == "--" || has_control_characters(option)) return false;
    if (end == option.size() || option[end] == '=') return name.find_first_of("\"'#\\") == std::string_view::npos;
    const std::string_view value = option.substr(end + 1);
    return !value.empty() && value[0] != '-' && is_plain_word(value);
}

}  // namespace

void check_sbatch_option(const std::string& option) {
    if (!is_one_option(option))
        throw InputError(fmt::format("--sbatch: must be one option of sbatch, as in --sbatch=--account=film (was '{}')",
                                     safe_text(option)));
    const std::string_view name = std::string_view(option).substr(0, end_of_name(option));
    if (name.starts_with("--"))
        check_long(name.substr(2));
    else
        check_short(std::string_view(option).substr(1));
}

std::string sbatch_line(const std::string& option) {
    const std::size_t end = end_of_name(option);
    if (end == option.size() || option[end] == ' ') return option;
    return fmt::format("{}={}", option.substr(0, end), sbatch_value(std::string_view(option).substr(end + 1)));
}

std::string sbatch_value(std::string_view text) {
    if (is_plain_word(text)) return std::string(text);
    std::string quoted = "\"";
    for (const char c : text) {
        if (c == '"' || c == '\\') quoted += '\\';
        quoted += c;
    }
    return quoted + "\"";
}

}  // namespace tumble
