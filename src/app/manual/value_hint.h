// The values that a shell can offer: read from the name of the value and the help, which users read as well, so that a
// new option has its completion without further declaration.
#pragma once

#include <string>
#include <vector>

namespace tumble::manual {

/// A value may have several alternatives, as in "stepped|exact|I.csv".
struct ValueHint {
    std::vector<std::string> words;    // choices
    bool word_list = false;            // several of the words, separated by commas
    bool files = false;                // names of files,
    std::vector<std::string> endings;  // of these kinds, without the dot; empty: all
    bool folders = false;              // names of folders

    bool empty() const { return words.empty() && !files && !folders; }

    /// From the value's name in the help and the option's help:
    ///   draft|normal|best [normal]   words: the names in lower case
    ///   LIST, "a list out of a,b"    words of a list
    ///   DIR, SITE                    folders
    ///   T.csv                        files with the ending, and with the endings of the help (".svg .png or .pdf")
    ///   SCENE, PLAN, "(TOML)"         TOML files
    ///   CLIP, FILE                   files with the endings of the help
    ///   all others                   numbers and texts: nothing to offer
    static ValueHint of(const std::string& value, const std::string& help);
};

}  // namespace tumble::manual
