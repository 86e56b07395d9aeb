// New cases in the text of a suite: the rest of the file stays as it was written.
#pragma once

#include "app/golden/suite.h"

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace tumble {

/// A case of the command line.
struct NewCase {
    std::filesystem::path scene;
    std::optional<std::string> name;   // without this, the scene's file name
    std::vector<std::int64_t> frames;  // empty: those of [defaults], or the first one
    SceneOverrides overrides;
    bool transparent = false;
};

/// The suite's text with the case at its end; a new suite's if the file does not exist. Throws InputError for a mistake
/// in either.
std::string suite_text_with(const std::filesystem::path& suite, const NewCase& added);

}  // namespace tumble
