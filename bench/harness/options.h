// The command line that the benchmarks' programs share.
#pragma once

#include <optional>
#include <string>
#include <vector>

namespace tumble::bench {

struct Options {
    bool quick = false;
    double patience = 150.0;               // CPU s
    std::vector<std::string> cases, ways;  // empty: all

    bool wants_case(const std::string& name) const;
    bool wants_way(const std::string& name) const;
};

struct CommandLine {
    std::string header;              // the first line of the results
    std::vector<std::string> cases;  // lines of --list
    std::string way = "way";         // name of the option that selects a way
    bool patience = false;           // true if --patience exists
};

/// Reads the arguments; prints the header or the list on request. Returns the exit status if nothing more is to be
/// done.
std::optional<int> read_options(int argc, char** argv, const CommandLine& line, Options& options);

/// A text as a field of a CSV line.
std::string quoted(const std::string& text);

}  // namespace tumble::bench
