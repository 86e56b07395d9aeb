// Image files that materials of the scene name, as textures, each read once.
#pragma once

#include "scene/description/mesh_paint.h"

#include <cstdint>
#include <filesystem>
#include <map>
#include <memory>
#include <utility>
#include <vector>

namespace tumble {

class TextureFiles {
public:
    /// Throws MeshError if the file cannot be read as mesh files are, is no PNG or JPEG, or is too large.
    std::shared_ptr<const Texture> load(const std::filesystem::path& file);
    /// The same of images that hold numbers; of a roughness the SurfaceMaps::surface.
    std::shared_ptr<const Texture> load_normals(const std::filesystem::path& file);
    std::shared_ptr<const Texture> load_roughness(const std::filesystem::path& file);

    /// In the order of first use.
    const std::vector<std::filesystem::path>& files() const { return files_; }

private:
    using Made = std::shared_ptr<const Texture>;
    enum class Use { color, normals, roughness };

    template <class Make>
    Made load(const std::filesystem::path& file, Use use, const Make& make);

    std::map<std::pair<std::filesystem::path, Use>, Made> textures_;
    std::vector<std::filesystem::path> files_;
    std::int64_t texels_ = 0;
};

}  // namespace tumble
