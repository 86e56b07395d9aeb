// [template.NAME]: bodies and joints that instances place.
#pragma once

#include "scene/description/description.h"
#include "scene/keys/bodies.h"
#include "scene/toml/toml_reader.h"

#include <map>
#include <string>
#include <vector>

namespace tumble {

/// Bodies with names of their own, and joints with indices into them.
struct SceneTemplate {
    std::vector<BodyDescription> bodies;
    std::vector<JointDescription> joints;
};

using SceneTemplates = std::map<std::string, SceneTemplate, std::less<>>;

/// Reads all templates.
SceneTemplates read_templates(const TomlTable& root, const BodySources& sources);

}  // namespace tumble
