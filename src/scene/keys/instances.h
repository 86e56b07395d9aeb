// [[instance]]: placed copies of templates.
#pragma once

#include "scene/description/description.h"
#include "scene/keys/bodies.h"
#include "scene/keys/templates.h"
#include "scene/toml/toml_reader.h"

#include <vector>

namespace tumble {

/// Appends the bodies NAME.BODY and the joints NAME.JOINT of all instances; copies are NAME.0.BODY.
void read_instances(const TomlTable& root, const SceneTemplates& templates, const BodySources& sources,
                    std::vector<BodyDescription>& bodies, std::vector<JointDescription>& joints);

}  // namespace tumble
