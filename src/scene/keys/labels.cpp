#include "scene/keys/readers.h"

#include "core/safe_text.h"
#include "scene/fields/label_fields.h"
#include "scene/keys/body_index.h"
#include "scene/keys/read_fields.h"
#include "scene/mesh/mesh_file.h"

#include <fmt/format.h>

#include <filesystem>
#include <utility>

namespace tumble {
namespace {

std::shared_ptr<const Texture> read_image(const TomlValue& value, const TextureSource& textures) {
    const std::string name = value.text();
    if (name.empty()) value.fail("must not be empty");
    if (name.find('\0') != std::string::npos) value.fail("must not hold a zero byte");
    const std::filesystem::path file = (textures.folder / std::filesystem::path(name)).lexically_normal();
    try {
        return textures.files.load(file);
    } catch (const MeshError& error) {
        throw InputError(value.origin().where,
                         fmt::format("image \"{}\" {} (looked at {})", safe_text(name, path_text_bytes), error.what(),
                                     safe_path(file)));
    }
}

LabelDescription read_label(const TomlTable& table, const SceneDescription& scene, const BodyIndex& bodies) {
    LabelDescription label = read_all_fields<LabelDescription>(table);
    if (const LabelText text = parse_label(label.text); !text.fault.empty()) table.find("text")->fail(text.fault);
    const TomlValue body = table.require("body");
    label.body = bodies.find(body);
    if (endless(scene.bodies[label.body].shape)) body.fail("must have a center: a plane has none");
    if (label.end <= label.start)
        table.find(table.has("to") ? "to" : "from")
            ->fail(fmt::format("makes the time span end before it starts, at {} s", number_text(label.start)));
    return label;
}

}  // namespace

std::optional<LogoDescription> read_logo(const TomlTable& root, const TextureSource& textures) {
    const auto table = root.find_table("logo");
    if (!table) return std::nullopt;
    auto logo = read_all_fields<LogoDescription>(*table);
    logo.image = read_image(table->require("image"), textures);
    return logo;
}

void read_labels(const TomlTable& root, std::optional<LogoDescription> logo, const SceneOverrides& overrides,
                 SceneDescription& scene) {
    std::vector<LabelDescription> labels;
    if (const auto list = root.find("label")) {
        const BodyIndex bodies(scene.bodies);
        for (TomlTable& table : list->tables("; write [[label]] for each")) {
            table.set_title("[[label]]");
            labels.push_back(read_label(table, scene, bodies));
        }
    }
    if (overrides.overlay == "none") return;
    scene.overlay.labels = std::move(labels);
    scene.overlay.logo = std::move(logo);
}

}  // namespace tumble
