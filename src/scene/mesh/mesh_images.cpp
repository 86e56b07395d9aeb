#include "scene/mesh/mesh_images.h"

#include "scene/mesh/input_file.h"
#include "scene/mesh/mesh_file.h"
#include "scene/mesh/texture_image.h"
#include "scene/toml/limits.h"

#include <fmt/format.h>

#include <algorithm>

namespace tumble {
namespace {

constexpr std::size_t name_shown = 60;  // characters of a name in a message

/// The file itself or that of the same name in the mesh's folder; empty if there is neither.
std::filesystem::path file_of(const std::filesystem::path& folder, std::string name) {
    std::replace(name.begin(), name.end(), '\\', '/');
    for (const std::string& asked : {name, name.substr(name.rfind('/') + 1)}) {
        try {
            const std::filesystem::path file = file_below(folder, asked);
            if (std::filesystem::is_regular_file(file)) return file;
        } catch (const MeshError&) {
        }
    }
    return {};
}

}  // namespace

void MeshImages::add_missing(const std::string& name) {
    if (std::find(missing_.begin(), missing_.end(), name) == missing_.end()) missing_.push_back(name);
}

std::optional<std::string> MeshImages::read(std::string_view name) {
    const std::filesystem::path file = file_of(folder_, std::string(name));
    if (file.empty()) {
        add_missing(readable(name, name_shown));
        return std::nullopt;
    }
    std::string bytes;
    try {
        bytes = read_mesh_bytes(file);
    } catch (const MeshError& error) {
        throw MeshError(fmt::format("names the image \"{}\", which {}", readable(name, name_shown), error.what()));
    }
    bytes_ += std::int64_t(bytes.size());
    if (bytes_ > limits::mesh_bytes)
        throw MeshError(fmt::format("names images of more than {} MiB together", limits::mesh_bytes >> 20));
    if (std::find(files_.begin(), files_.end(), file) == files_.end()) files_.push_back(file);
    return bytes;
}

std::shared_ptr<const Texture> MeshImages::texture(std::string_view name) {
    const std::string key = fmt::format("file {}", name);
    if (const auto known = textures_.find(key); known != textures_.end()) return known->second;
    const std::optional<std::string> bytes = read(name);
    std::shared_ptr<const Texture> made;
    if (bytes && is_texture_image(*bytes))
        made = make_texture(*bytes, readable(name, name_shown), texels_);
    else if (bytes)
        add_missing(readable(name, name_shown));
    return textures_.emplace(key, std::move(made)).first->second;
}

std::shared_ptr<const Texture> MeshImages::texture(const std::string& name, std::string_view bytes) {
    if (const auto known = textures_.find(name); known != textures_.end()) return known->second;
    std::shared_ptr<const Texture> made;
    if (is_texture_image(bytes))
        made = make_texture(bytes, name, texels_);
    else
        add_missing(name);
    return textures_.emplace(name, std::move(made)).first->second;
}

}  // namespace tumble
