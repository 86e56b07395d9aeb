// `tumble compare`: of two pictures, and of folders, clips and scenes (compare_sets.cpp).
#pragma once

#include "compare/comparison.h"
#include "scene/keys/overrides.h"
#include "tumble/output.h"

#include <filesystem>
#include <optional>
#include <string>

namespace tumble {

struct CompareCommand {
    std::filesystem::path a, b;
    std::optional<std::filesystem::path> difference;
    v0::CompareOptions options;
    std::optional<std::filesystem::path> tolerances;           // .toml
    std::optional<std::filesystem::path> report, json, junit;  // to write
    std::optional<std::string> platform;                       // of the references; "none": the general ones alone
    bool allow_added = false;                                  // a picture without a reference is no difference
    bool accept = false;                                       // pictures that are not alike become references
    SceneOverrides overrides;                                  // of a scene that is drawn; fps of clips too
    int workers = 1;                                           // pairs at a time, and render processes
    bool quiet = false;
};

/// True if the command is more than the comparison of two pictures by the options of the command line.
bool compares_sets(const CompareCommand& command);

/// Returns the exit code of the result (compare/comparison.h). Throws InputError before anything is compared if the
/// operands or the tolerances are wrong.
int compare_sets(const CompareCommand& command);

/// The pictures that are not alike, with reasons (of many, the first), and the number of each verdict; with `brief` the
/// pictures alone.
void print_summary(const SetResult& result, bool brief);

}  // namespace tumble
