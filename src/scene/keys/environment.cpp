#include "scene/keys/readers.h"

#include "core/safe_text.h"
#include "scene/environment/exr_image.h"
#include "scene/environment/hdr_image.h"
#include "scene/environment/presets.h"
#include "scene/fields/settings_fields.h"
#include "scene/keys/read_fields.h"
#include "scene/mesh/mesh_file.h"
#include "scene/mesh/texture_image.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

namespace tumble {
namespace {

namespace fs = std::filesystem;

EnvironmentImage light_of_picture(const Texture& texture) {
    const Texture::Level& picture = texture.levels.front();
    EnvironmentImage image{picture.width, picture.height, {}};
    if (std::max(image.width, image.height) > limits::environment_side)
        throw MeshError(fmt::format("is too large: {} x {} pixels (at most {} a side)", image.width, image.height,
                                    limits::environment_side));
    image.texels.reserve(picture.texels.size());
    for (const auto& texel : picture.texels) {
        const auto light = [&](std::size_t c) { return float(texel[c]) * float(texel[c]) / (255.0f * 255.0f); };
        image.texels.push_back({light(0), light(1), light(2)});
    }
    return image;
}

EnvironmentImage load_image(const fs::path& file, MeshImports imports) {
    const std::string bytes = read_mesh_bytes(file);
    if (is_hdr_image(bytes)) return read_hdr_image(bytes);
    if (is_exr_image(bytes)) {
        if (imports == MeshImports::refused)
            throw MeshError("is an OpenEXR file, which is read in a child process, and that is not allowed here");
        return import_exr_image(bytes);
    }
    if (!is_texture_image(bytes)) throw MeshError("is neither an HDR nor an OpenEXR nor a PNG nor a JPEG file");
    std::int64_t texels = 0;
    return light_of_picture(*make_texture(bytes, "", texels));
}

std::shared_ptr<const EnvironmentImage> read_image(const TomlValue& value, const fs::path& folder,
                                                   std::vector<fs::path>& files, MeshImports imports) {
    const std::string name = value.text();
    if (name.empty()) value.fail("must not be empty");
    if (name.find('\0') != std::string::npos) value.fail("must not hold a zero byte");
    const fs::path file = (folder / fs::path(name)).lexically_normal();
    try {
        auto image = std::make_shared<const EnvironmentImage>(load_image(file, imports));
        files.push_back(file);
        return image;
    } catch (const MeshError& error) {
        throw InputError(value.origin().where,
                         fmt::format("image \"{}\" {} (looked at {})", safe_text(name, path_text_bytes), error.what(),
                                     safe_path(file)));
    }
}

EnvironmentPreset read_preset(const TomlValue& value) {
    const std::string name = value.text();
    if (std::find(environment_presets.begin(), environment_presets.end(), name) == environment_presets.end())
        value.fail(fmt::format("must be {}", quoted_list({environment_presets.begin(), environment_presets.end()})));
    return environment_preset(name);
}

void read_background(const TomlValue& value, EnvironmentDescription& environment) {
    if (value.is_array()) {
        const auto colors = value.items(2, "colors, of the horizon and straight up");
        environment.background = BackgroundKind::colors;
        environment.low = colors[0].color();
        environment.high = colors[1].color();
        return;
    }
    const std::string text = value.text();
    if (text == "sky") {
        environment.background = BackgroundKind::sky;
    } else if (text == "image") {
        if (!environment.image) value.fail("is \"image\", which needs a preset or an image beside it");
        environment.background = BackgroundKind::image;
    } else {
        if (!text.starts_with('#'))
            value.fail("must be \"sky\", \"image\", a color such as \"#202428\", or two colors in brackets");
        environment.background = BackgroundKind::colors;
        environment.low = environment.high = value.color();
    }
}

void needs_image(const TomlTable& table, const EnvironmentDescription& environment) {
    if (environment.image) return;
    for (const char* key : {"rotation", "intensity", "blur"})
        if (const auto given = table.find(key))
            given->origin().fail("has an effect on an image only: give a preset or an image beside it");
}

}  // namespace

std::optional<EnvironmentDescription> read_environment(const TomlTable& root, const fs::path& folder,
                                                       std::vector<fs::path>& files, MeshImports imports) {
    const auto table = root.find_table("environment");
    if (!table) return std::nullopt;
    auto environment = read_all_fields<EnvironmentDescription>(*table);
    if (const auto preset = table->find("preset")) {
        auto [image, sun] = read_preset(*preset);
        environment.image = std::move(image);
        environment.sun = sun;
    }
    if (const auto image = table->find("image")) {
        if (environment.image) image->origin().fail("and preset exclude each other: give one of them");
        environment.image = read_image(*image, folder, files, imports);
    }
    if (environment.image) environment.background = BackgroundKind::image;
    if (const auto background = table->find("background")) read_background(*background, environment);
    needs_image(*table, environment);
    return environment;
}

}  // namespace tumble
