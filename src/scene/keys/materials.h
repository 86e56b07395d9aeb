// [materials.NAME]: matter and looks, shared by the bodies that name it.
#pragma once

#include "scene/description/description.h"
#include "scene/toml/toml_reader.h"

#include <map>
#include <optional>
#include <string>

namespace tumble {

/// What a material, or a body for itself, says. What neither says stays open, because a plane's defaults differ.
struct Material {
    std::optional<Color> color;
    std::optional<double> density;       // kg/m^3
    std::optional<double> restitution;
    std::optional<double> friction;
    std::optional<double> roughness;
    std::optional<double> metallic;
    std::optional<Pattern> pattern;

    /// The same with everything that `over` says in place of what this says.
    Material overridden_by(const Material& over) const;
};

using Materials = std::map<std::string, Material, std::less<>>;

Materials read_materials(const TomlTable& root);

/// Reads the keys of a material from a table that may hold others too (a body).
Material read_material_keys(const TomlTable& table);

/// The material of that name, or an error that names those that are near or there.
const Material& find_material(const Materials& materials, const TomlValue& name);

/// Matter and looks of a body, with the defaults of its shape filled in.
void apply_material(const Material& material, BodyDescription& body);

}  // namespace tumble
