// [materials.NAME]: physical and visual properties, shared by the bodies that name it.
#pragma once

#include "scene/fields/body_fields.h"
#include "scene/toml/toml_reader.h"

#include <map>
#include <string>

namespace tumble {

/// A copy in which the properties of `over` take precedence.
Material overridden(const Material& material, const Material& over);

using Materials = std::map<std::string, Material, std::less<>>;

Materials read_materials(const TomlTable& root);

/// The material of that name, or an error with the nearest or all known names.
const Material& find_material(const Materials& materials, const TomlValue& name);

/// Sets the physical and visual properties of a body, with the defaults of its shape.
void apply_material(const Material& material, BodyDescription& body);

}  // namespace tumble
