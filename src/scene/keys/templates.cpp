#include "scene/keys/templates.h"

#include "scene/fields/many_bodies_fields.h"
#include "scene/keys/joints.h"
#include "scene/keys/read_fields.h"
#include "scene/keys/readers.h"

#include <fmt/format.h>

namespace tumble {
namespace {

void refuse_instances(const TomlTable& table) {
    for (const char* key : {"instance", "template"})
        if (const auto value = table.find(key))
            value->origin().fail(
                "is not for templates: give the bodies and joints themselves, or make an instance of "
                "each template in the scene");
}

SceneTemplate read_content(const TomlTable& table, const BodySources& sources, const SourcePosition& origin) {
    SceneTemplate content;
    content.bodies = read_bodies(table, sources);
    read_chains(table, sources, content.bodies, content.joints);
    read_joints(table, content.bodies, content.joints);
    if (content.bodies.empty()) origin.fail("holds no body: give at least one");
    return content;
}

/// A scene of bodies, joints and chains only, with its own materials.
SceneTemplate read_template_file(const TomlValue& value, const BodySources& sources) {
    std::filesystem::path file;
    const std::string text = read_named_file(value, "template", sources, file);
    const toml::table document = parse_toml(text, file.string());
    const TomlTable root(document, {"template", {file.string(), 1, 1}}, "the file of a template");
    refuse_instances(root);
    root.expect_keys(list_keys<TemplateFile>().keys);
    const std::filesystem::path folder = file.parent_path();
    const Materials materials = read_materials(root, {folder, sources.textures});
    return read_content(root, {materials, folder, sources.settings, sources.meshes, sources.textures, sources.files},
                        value.origin());
}

SceneTemplate read_template(const TomlTable& table, const BodySources& sources) {
    refuse_instances(table);
    read_all_fields<TemplateRequest>(table);
    const auto file = table.find("file");
    if (!file) return read_content(table, sources, table.origin());
    for (const char* key : {"body", "joint", "chain"})
        if (const auto value = table.find(key)) value->origin().fail("and file exclude each other: give one of them");
    return read_template_file(*file, sources);
}

}  // namespace

SceneTemplates read_templates(const TomlTable& root, const BodySources& sources) {
    SceneTemplates templates;
    const auto value = root.find("template");
    if (!value) return templates;
    if (!value->is_table()) value->fail("must be tables: write [template.NAME], and [[template.NAME.body]] for bodies");
    for (const auto& [name, content] : value->table().entries()) {
        TomlTable table = content.table();
        table.set_title(fmt::format("[template.{}]", name));
        templates.emplace(name, read_template(table, sources));
    }
    return templates;
}

}  // namespace tumble
