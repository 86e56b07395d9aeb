// Several runs from scenes and varied values: --vary PATH=VALUE,VALUE,...
#pragma once

#include "scene/keys/overrides.h"

#include <filesystem>
#include <span>
#include <string>
#include <vector>

namespace tumble {

struct Variant {
    std::filesystem::path scene;
    SceneOverrides overrides;
    std::string label;  // that tells it from the others: the scene's file name, the varied values
};

/// Every scene with every combination of the varied values, the last one varying fastest. Commas in brackets,
/// braces and quotes belong to a value. Throws InputError for a text without values.
std::vector<Variant> make_variants(std::span<const std::filesystem::path> scenes, const SceneOverrides& overrides,
                                   std::span<const std::string> vary);

/// Gives the variants these labels, if there are any. Throws InputError if their numbers differ, or if two labels are
/// alike.
void label_variants(std::vector<Variant>& variants, std::span<const std::string> labels);

}  // namespace tumble
