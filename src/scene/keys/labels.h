// [[label]] and [logo].
#pragma once

#include "scene/description/description.h"
#include "scene/keys/materials.h"
#include "scene/keys/overrides.h"
#include "scene/toml/toml_reader.h"

#include <optional>

namespace tumble {

/// The logo of the file; reads its image.
std::optional<LogoDescription> read_logo(const TomlTable& root, const TextureSource& textures);

/// Labels and logo of the overlay. Precondition: `scene` has its bodies and its overlay.
void read_labels(const TomlTable& root, std::optional<LogoDescription> logo, const SceneOverrides& overrides,
                 SceneDescription& scene);

}  // namespace tumble
