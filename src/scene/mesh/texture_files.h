// Image files that materials of the scene name, as textures, each read once.
#pragma once

#include "scene/description/mesh_paint.h"

#include <cstdint>
#include <filesystem>
#include <map>
#include <memory>
#include <vector>

namespace tumble {

class TextureFiles {
public:
    /// Throws MeshError if the file cannot be read as mesh files are, is no PNG or JPEG, or is too large.
    std::shared_ptr<const Texture> load(const std::filesystem::path& file);

    /// In the order of first use.
    const std::vector<std::filesystem::path>& files() const { return files_; }

private:
    std::map<std::filesystem::path, std::shared_ptr<const Texture>> textures_;
    std::vector<std::filesystem::path> files_;
    std::int64_t texels_ = 0;
};

}  // namespace tumble
