// `fracture` of a body, and the pieces that it makes.
#pragma once

#include "scene/description/description.h"
#include "scene/keys/materials.h"
#include "scene/toml/toml_reader.h"

#include <cstdint>

namespace tumble {

/// Reads `fracture` of a body whose other fields are read, with the properties of its material.
void read_fracture(const TomlTable& table, const FractureMaterial& material, BodyDescription& body);

/// The same cut of a body that is enlarged by a factor.
void enlarge_fracture(BodyDescription& body, double factor);

/// Another cut for copy number i.
void vary_fracture(BodyDescription& body, std::uint64_t i);

/// Appends the pieces NAME/0, NAME/1, ... of all bodies, after everything that names bodies is read.
void append_pieces(SceneDescription& scene);

/// The same for a scene that has pieces, after changes of the requests.
void cut_again(SceneDescription& scene);

}  // namespace tumble
