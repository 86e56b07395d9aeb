#include "scene/keys/materials.h"

#include "core/safe_text.h"
#include "scene/keys/read_fields.h"

#include <fmt/format.h>

namespace tumble {
namespace {

constexpr Color default_color{0xcf, 0x9a, 0x5b};        // light wood: contrasts with ground and sky
constexpr Color default_plane_color{0xd6, 0xd8, 0xda};  // light gray, on which shadows and grid lines are visible

}  // namespace

Material overridden(const Material& material, const Material& over) {
    const auto either = [](const auto& mine, const auto& theirs) { return theirs ? theirs : mine; };
    return {either(material.color, over.color),
            either(material.density, over.density),
            either(material.restitution, over.restitution),
            either(material.friction, over.friction),
            either(material.rolling_friction, over.rolling_friction),
            either(material.spinning_friction, over.spinning_friction),
            either(material.roughness, over.roughness),
            either(material.metallic, over.metallic),
            either(material.pattern, over.pattern),
            either(material.sound, over.sound)};
}

Materials read_materials(const TomlTable& root) {
    Materials materials;
    const auto table = root.find_table("materials");
    if (!table) return materials;
    for (const auto& [name, value] : table->entries()) {
        TomlTable entry = value.table();
        entry.set_title(fmt::format("[materials.{}]", name));
        materials.emplace(name, read_all_fields<Material>(entry));
    }
    return materials;
}

const Material& find_material(const Materials& materials, const TomlValue& value) {
    const std::string name = value.text();
    if (const auto found = materials.find(name); found != materials.end()) return found->second;
    std::vector<std::string_view> known;
    for (const auto& [other, material] : materials) known.push_back(other);
    value.origin().fail(fmt::format("\"{}\" is not among the materials{}", safe_text(name), suggestion(name, known)));
}

void apply_material(const Material& material, BodyDescription& body) {
    const bool is_plane = endless(body.shape);
    body.appearance.color = material.color.value_or(is_plane ? default_plane_color : default_color);
    body.appearance.pattern = material.pattern.value_or(is_plane ? Pattern::grid : Pattern::plain);
    body.appearance.roughness = material.roughness.value_or(body.appearance.roughness);
    body.appearance.metallic = material.metallic.value_or(body.appearance.metallic);
    body.density = material.density.value_or(body.density);
    body.restitution = material.restitution;
    body.sound = material.sound.value_or(body.sound);
    body.friction = material.friction;
    body.rolling_friction = material.rolling_friction;
    body.spinning_friction = material.spinning_friction;
}

}  // namespace tumble
