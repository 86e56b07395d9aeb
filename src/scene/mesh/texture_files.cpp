#include "scene/mesh/texture_files.h"

#include "scene/mesh/input_file.h"
#include "scene/mesh/mesh_file.h"
#include "scene/mesh/texture_image.h"

#include <string>

namespace tumble {

std::shared_ptr<const Texture> TextureFiles::load(const std::filesystem::path& file) {
    if (const auto known = textures_.find(file); known != textures_.end()) return known->second;
    const std::string bytes = read_mesh_bytes(file);
    if (!is_texture_image(bytes)) throw MeshError("is neither a PNG nor a JPEG file");
    std::shared_ptr<const Texture> made = make_texture(bytes, "", texels_);
    files_.push_back(file);
    return textures_.emplace(file, std::move(made)).first->second;
}

}  // namespace tumble
