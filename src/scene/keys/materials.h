// [materials.NAME]: physical and visual properties, shared by the bodies that name it.
#pragma once

#include "scene/description/description.h"
#include "scene/toml/toml_reader.h"

#include <map>
#include <optional>
#include <string>

namespace tumble {

/// Properties given by a material, or by a body itself. Missing ones stay empty, because the defaults of planes differ.
struct Material {
    std::optional<Color> color;
    std::optional<double> density;  // kg/m^3
    std::optional<double> restitution;
    std::optional<double> friction;
    std::optional<double> roughness;
    std::optional<double> metallic;
    std::optional<Pattern> pattern;

    /// A copy in which the properties of `over` take precedence.
    Material overridden_by(const Material& over) const;
};

using Materials = std::map<std::string, Material, std::less<>>;

Materials read_materials(const TomlTable& root);

/// Reads the keys of a material from a table with other keys (a body).
Material read_material_keys(const TomlTable& table);

/// The material of that name, or an error with the nearest or all known names.
const Material& find_material(const Materials& materials, const TomlValue& name);

/// Sets the physical and visual properties of a body, with the defaults of its shape.
void apply_material(const Material& material, BodyDescription& body);

}  // namespace tumble
