#include "scene/keys/materials.h"

#include "core/safe_text.h"
#include "scene/description/looks.h"
#include "scene/keys/read_fields.h"
#include "scene/mesh/curved_mesh.h"
#include "scene/mesh/mesh_file.h"
#include "scene/toml/limits.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

namespace tumble {
namespace {

constexpr Color default_color{0xcf, 0x9a, 0x5b};        // light wood: contrasts with ground and sky
constexpr Color default_plane_color{0xd6, 0xd8, 0xda};  // light gray, on which shadows and grid lines are visible

/// Shapes with a look of their own (Pattern::panel).
bool has_panels(const Shape& shape) {
    return std::holds_alternative<BoxShape>(shape) || std::holds_alternative<SphereShape>(shape) ||
           std::holds_alternative<CompoundShape>(shape);
}

/// By the coordinates of the file, or by the sides of its bounding box.
MeshShape with_texture(const MeshShape& mesh, const Appearance& look) {
    auto asset = std::make_shared<MeshAsset>(*mesh.asset);
    auto paint = std::make_shared<MeshPaint>(*texture_paint(mesh, look, asset->vertices, asset->indices));
    const MeshPaint* of_file = mesh.asset->paint.get();
    const auto placed = [](const MeshPaint::Corner& corner) { return corner.uv != std::array<float, 2>{}; };
    if (of_file != nullptr && look.texture_scale == 0.0 && std::ranges::any_of(of_file->corners, placed)) {
        for (std::size_t i = 0; i < paint->corners.size(); ++i) paint->corners[i].uv = of_file->corners[i].uv;
        paint->materials.front().wrap_u = paint->materials.front().wrap_v = TextureWrap::repeat;
    }
    asset->paint = std::move(paint);
    MeshShape made = mesh;
    made.asset = std::move(asset);
    made.painted = true;
    return made;
}

Shape textured(const Shape& shape, const Appearance& look) {
    if (const auto* mesh = std::get_if<MeshShape>(&shape)) return with_texture(*mesh, look);
    if (const auto* curved = std::get_if<CurvedShape>(&shape)) {
        constexpr int rows = 32;
        const bool tapers = curved->kind == CurvedKind::cone && curved->radius != curved->top_radius;
        auto asset = std::make_shared<MeshAsset>(tapers ? *curved_mesh(*curved, rows) : *curved->drawn);
        asset->paint = texture_paint(shape, look, asset->vertices, asset->indices);
        CurvedShape made = *curved;
        made.drawn = std::move(asset);
        return made;
    }
    const auto* compound = std::get_if<CompoundShape>(&shape);
    if (compound == nullptr) return shape;
    auto parts = std::make_shared<std::vector<CompoundPart>>(*compound->parts);
    for (CompoundPart& part : *parts) {
        Appearance of_part = look;
        of_part.color = part.color.value_or(look.color);
        part.shape = textured(part.shape, of_part);
    }
    return CompoundShape{std::move(parts)};
}

}  // namespace

Material overridden(const Material& material, const Material& over) {
    const auto either = [](const auto& mine, const auto& theirs) { return theirs ? theirs : mine; };
    const bool images = over.texture || over.normal_map || over.roughness_map;
    // A pattern replaces images.
    const auto image = [&](const auto& mine, const auto& theirs) {
        return over.pattern ? theirs : either(mine, theirs);
    };
    return {either(material.color, over.color),
            either(material.density, over.density),
            either(material.restitution, over.restitution),
            either(material.friction, over.friction),
            either(material.rolling_friction, over.rolling_friction),
            either(material.spinning_friction, over.spinning_friction),
            either(material.roughness, over.roughness),
            either(material.metallic, over.metallic),
            images ? over.pattern : either(material.pattern, over.pattern),
            either(material.pattern_color, over.pattern_color),
            either(material.pattern_scale, over.pattern_scale),
            image(material.texture, over.texture),
            either(material.texture_scale, over.texture_scale),
            either(material.texture_filter, over.texture_filter),
            image(material.normal_map, over.normal_map),
            image(material.roughness_map, over.roughness_map),
            either(material.opacity, over.opacity),
            either(material.emission, over.emission),
            either(material.reflection, over.reflection),
            either(material.sound, over.sound),
            {either(material.fracture.strength, over.fracture.strength),
             either(material.fracture.shear_strength, over.fracture.shear_strength),
             either(material.fracture.compressive_strength, over.fracture.compressive_strength),
             either(material.fracture.stiffness, over.fracture.stiffness),
             either(material.fracture.toughness, over.fracture.toughness),
             either(material.fracture.blow_time, over.fracture.blow_time),
             either(material.fracture.inner_color, over.fracture.inner_color)}};
}

void read_material_keys(const TomlTable& table, const TextureSource& textures, Material& material) {
    read_fields(table, material);
    read_fields(table, material.fracture);
    const auto read = [&](const char* key, std::shared_ptr<const Texture>& image, const auto& load) {
        const auto value = table.find(key);
        if (!value) return;
        for (const char* pattern : {"pattern", "pattern_color", "pattern_scale"})
            if (const auto other = table.find(pattern))
                other->origin().fail(fmt::format("and {} exclude each other: give one of them", key));
        const std::string name = value->text();
        if (name.empty()) value->fail("must not be empty");
        if (name.find('\0') != std::string::npos) value->fail("must not hold a zero byte");
        const std::filesystem::path file = (textures.folder / std::filesystem::path(name)).lexically_normal();
        try {
            image = load(file);
        } catch (const MeshError& error) {
            throw InputError(value->origin().where,
                             fmt::format("{} \"{}\" {} (looked at {})", key, safe_text(name, path_text_bytes),
                                         error.what(), safe_path(file)));
        }
    };
    TextureFiles& files = textures.files;
    read("texture", material.texture, [&](const auto& file) { return files.load(file); });
    read("normal_map", material.normal_map, [&](const auto& file) { return files.load_normals(file); });
    read("roughness_map", material.roughness_map, [&](const auto& file) { return files.load_roughness(file); });
}

Materials read_materials(const TomlTable& root, const TextureSource& textures) {
    Materials materials;
    const auto table = root.find_table("materials");
    if (!table) return materials;
    for (const auto& [name, value] : table->entries()) {
        TomlTable entry = value.table();
        entry.set_title(fmt::format("[materials.{}]", name));
        entry.expect_keys(list_keys<Material, FractureMaterial>().keys);
        read_material_keys(entry, textures, materials[name]);
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
    Appearance& look = body.appearance;
    look.color = material.color.value_or(material.texture ? Color{255, 255, 255}
                                         : is_plane       ? default_plane_color
                                                          : default_color);
    const bool has_image = material.texture || material.normal_map || material.roughness_map;
    look.pattern = material.pattern.value_or(has_image ? Pattern::plain : is_plane ? Pattern::grid : Pattern::panel);
    if (look.pattern == Pattern::plain && !has_panels(body.shape)) look.pattern = Pattern::panel;
    look.roughness = material.roughness.value_or(material.roughness_map ? 1.0 : look.roughness);
    look.metallic = material.metallic.value_or(look.metallic);
    look.pattern_color = material.pattern_color;
    look.pattern_scale = material.pattern_scale.value_or(0.0);
    look.texture = material.texture;
    look.texture_scale = material.texture_scale.value_or(0.0);
    look.texture_filter = material.texture_filter.value_or(look.texture_filter);
    look.normal_map = material.normal_map;
    look.roughness_map = material.roughness_map;
    look.opacity = material.opacity.value_or(1.0);
    look.emission = material.emission.value_or(look.emission);
    look.reflection = is_plane ? material.reflection.value_or(0.0) : 0.0;
    if (has_image) body.shape = textured(body.shape, look);
    body.density = material.density.value_or(body.density);
    body.restitution = material.restitution;
    body.sound = material.sound.value_or(body.sound);
    body.friction = material.friction;
    body.rolling_friction = material.rolling_friction;
    body.spinning_friction = material.spinning_friction;
}

}  // namespace tumble
