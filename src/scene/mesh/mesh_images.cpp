#include "scene/mesh/mesh_images.h"

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

template <class Make>
std::shared_ptr<const Texture> MeshImages::made(const std::string& key, const std::string& shown,
                                                const std::optional<std::string_view>& bytes, const Make& make) {
    if (const auto known = textures_.find(key); known != textures_.end()) return known->second;
    std::optional<std::string> of_file;
    if (!bytes) of_file = read(key.substr(key.find(' ') + 1));
    const std::optional<std::string_view> image = of_file ? std::string_view(*of_file) : bytes;
    std::shared_ptr<const Texture> texture;
    if (image && is_texture_image(*image))
        texture = make(*image, shown, texels_);
    else if (image)
        add_missing(shown);
    return textures_.emplace(key, std::move(texture)).first->second;
}

std::shared_ptr<const Texture> MeshImages::texture(std::string_view name) {
    return made(fmt::format("file {}", name), readable(name, name_shown), std::nullopt, make_texture);
}

std::shared_ptr<const Texture> MeshImages::texture(const std::string& name, std::string_view bytes) {
    return made(name, name, bytes, make_texture);
}

std::shared_ptr<const Texture> MeshImages::map(std::string_view name) {
    return made(fmt::format("map {}", name), readable(name, name_shown), std::nullopt, make_map);
}

std::shared_ptr<const Texture> MeshImages::map(const std::string& name, std::string_view bytes) {
    return made(fmt::format("numbers of {}", name), name, bytes, make_map);
}

}  // namespace tumble
