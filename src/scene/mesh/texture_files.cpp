#include "scene/mesh/texture_files.h"

#include "scene/mesh/mesh_file.h"
#include "scene/mesh/texture_image.h"

#include <algorithm>
#include <string>

namespace tumble {

template <class Make>
TextureFiles::Made TextureFiles::load(const std::filesystem::path& file, Use use, const Make& make) {
    if (const auto known = textures_.find({file, use}); known != textures_.end()) return known->second;
    const std::string bytes = read_mesh_bytes(file);
    if (!is_texture_image(bytes)) throw MeshError("is neither a PNG nor a JPEG file");
    Made made = make(bytes);
    if (std::ranges::find(files_, file) == files_.end()) files_.push_back(file);
    return textures_.emplace(std::pair(file, use), std::move(made)).first->second;
}

std::shared_ptr<const Texture> TextureFiles::load(const std::filesystem::path& file) {
    return load(file, Use::color, [&](const std::string& bytes) { return make_texture(bytes, "", texels_); });
}

std::shared_ptr<const Texture> TextureFiles::load_normals(const std::filesystem::path& file) {
    return load(file, Use::normals, [&](const std::string& bytes) {
        Made made = make_map(bytes, "", texels_);
        if (is_gray(*made))
            throw MeshError(
                "is gray: a normal map has directions as colors, mostly a pale blue; this is a map of "
                "heights");
        return made;
    });
}

std::shared_ptr<const Texture> TextureFiles::load_roughness(const std::filesystem::path& file) {
    return load(file, Use::roughness, [&](const std::string& bytes) {
        return changed_map(*make_map(bytes, "", texels_), [](int, int, std::array<std::uint8_t, 4>& texel) {
            texel = {255, texel[1], 255, 255};
        });
    });
}

}  // namespace tumble
