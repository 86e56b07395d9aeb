// The scene of a sample as text: that of the plan with the sample's values in their places.
#pragma once

#include "app/sweep/sweep_plan.h"

#include <filesystem>
#include <string>
#include <vector>

namespace tumble {

/// As TOML, for `tumble render`, or as JSON for other programs. `folder`: where the text will be; names of mesh files
/// become relative to it. Throws InputError.
std::string resolved_scene(const std::string& text, const std::filesystem::path& scene,
                           const std::vector<std::string>& assignments, const std::filesystem::path& folder,
                           SceneForm form);

/// The assignment of a title, for a scene without one: a copy under another file name shows the same title.
std::vector<std::string> title_assignment(const std::string& text, const std::filesystem::path& scene);

}  // namespace tumble
