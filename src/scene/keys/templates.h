// [template.NAME]: bodies and joints that instances place; [[instance]].
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

/// Appends the bodies NAME.BODY and the joints NAME.JOINT of all instances; copies are NAME.0.BODY.
void read_instances(const TomlTable& root, const SceneTemplates& templates, const BodySources& sources,
                    std::vector<BodyDescription>& bodies, std::vector<JointDescription>& joints);

/// Moves the bodies so that hinges and sliders have the given coordinates (`pose = { NAME = degrees or m }`). Fixed and
/// kinematic bodies and the world stay; without them, the first body of each group of joined bodies.
void apply_pose(const TomlValue& pose, SceneTemplate& content);

}  // namespace tumble
