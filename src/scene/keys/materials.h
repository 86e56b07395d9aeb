// [materials.NAME]: physical and visual properties, shared by the bodies that name it.
#pragma once

#include "scene/fields/body_fields.h"
#include "scene/mesh/texture_files.h"
#include "scene/toml/toml_reader.h"

#include <filesystem>
#include <map>
#include <string>

namespace tumble {

/// A copy in which the properties of `over` take precedence.
Material overridden(const Material& material, const Material& over);

using Materials = std::map<std::string, Material, std::less<>>;

/// Where the textures of materials come from.
struct TextureSource {
    const std::filesystem::path& folder;  // of relative paths
    TextureFiles& files;
};

Materials read_materials(const TomlTable& root, const TextureSource& textures);

/// Reads the keys of a material from the table of a material or of a body, and loads the texture.
void read_material_keys(const TomlTable& table, const TextureSource& textures, Material& material);

/// The material of that name, or an error with the nearest or all known names.
const Material& find_material(const Materials& materials, const TomlValue& name);

/// Sets the physical and visual properties of a body, with the defaults of its shape. Its meshes get the texture in
/// place of the colors of their files.
void apply_material(const Material& material, BodyDescription& body);

}  // namespace tumble
