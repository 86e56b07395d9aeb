// The tables [overlay] and [[caption]], and the options that take their place.
#pragma once

#include "scene/description/description.h"
#include "scene/keys/overrides.h"
#include "scene/toml/toml_reader.h"

namespace tumble {

/// `bodies`: of the scene, to find those that the table names.
OverlayDescription read_overlay(const TomlTable& root, const std::vector<BodyDescription>& bodies,
                                const SceneOverrides& overrides);

}  // namespace tumble
