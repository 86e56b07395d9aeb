#include "harness/options.h"

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <string_view>

namespace tumble::bench {
namespace {

bool wanted(const std::vector<std::string>& names, const std::string& name) {
    return names.empty() || std::find(names.begin(), names.end(), name) != names.end();
}

int explain(const char* program, const CommandLine& line) {
    std::fprintf(stderr, "usage: %s [--header] [--quick] [--case NAME]... [--%s NAME]...%s | --list\n", program,
                 line.way.c_str(), line.patience ? " [--patience SECONDS]" : "");
    return 2;
}

}  // namespace

bool Options::wants_case(const std::string& name) const { return wanted(cases, name); }
bool Options::wants_way(const std::string& name) const { return wanted(ways, name); }

std::optional<int> read_options(int argc, char** argv, const CommandLine& line, Options& options) {
    for (int i = 1; i < argc; ++i) {
        const std::string_view option = argv[i];
        const bool more = i + 1 < argc;
        if (option == "--quick") {
            options.quick = true;
        } else if (option == "--case" && more) {
            options.cases.emplace_back(argv[++i]);
        } else if (option == "--" + line.way && more) {
            options.ways.emplace_back(argv[++i]);
        } else if (option == "--patience" && more && line.patience) {
            options.patience = std::atof(argv[++i]);
        } else if (option == "--header") {
            std::puts(line.header.c_str());
        } else if (option == "--list") {
            for (const std::string& name : line.cases) std::puts(name.c_str());
            return 0;
        } else {
            return explain(argv[0], line);
        }
    }
    return std::nullopt;
}

std::string quoted(const std::string& text) { return text.find(',') == std::string::npos ? text : '"' + text + '"'; }

}  // namespace tumble::bench
