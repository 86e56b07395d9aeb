#include "app/sweep/resolved_scene.h"

#include "app/sweep/toml_json.h"
#include "scene/toml/set_values.h"
#include "scene/toml/toml_text.h"

namespace tumble {
namespace {

namespace fs = std::filesystem;

/// The name of a mesh file for a scene in another folder.
void move_mesh(toml::table& shape, const fs::path& from, const fs::path& to) {
    toml::value<std::string>* file = shape["file"].as_string();
    if (file == nullptr || shape["type"].value<std::string>() != "mesh") return;
    const fs::path name(file->get());
    if (name.empty() || name.is_absolute()) return;
    file->get() = fs::absolute(from / name).lexically_normal().lexically_relative(fs::absolute(to).lexically_normal());
}

void move_meshes(toml::node& node, const fs::path& from, const fs::path& to) {
    if (toml::table* table = node.as_table()) {
        move_mesh(*table, from, to);
        for (auto&& [key, inner] : *table) move_meshes(inner, from, to);
    } else if (toml::array* array = node.as_array()) {
        for (toml::node& inner : *array) move_meshes(inner, from, to);
    }
}

}  // namespace

std::string resolved_scene(const std::string& text, const fs::path& scene, const std::vector<std::string>& assignments,
                           const fs::path& folder, SceneForm form) {
    toml::table document = parse_toml(text, scene.string());
    set_values(document, assignments);
    move_meshes(document, scene.parent_path(), folder);
    if (form == SceneForm::json) return json_of(document).dump(2) + "\n";
    return toml_document_text(document);
}

std::vector<std::string> title_assignment(const std::string& text, const fs::path& scene) {
    const toml::table document = parse_toml(text, scene.string());
    if (document.contains("title")) return {};
    return {"title=" + toml_string(scene.stem().string())};
}

}  // namespace tumble
