// The images that a mesh file names or holds, as textures, each read once.
#pragma once

#include "scene/description/mesh_paint.h"

#include <cstdint>
#include <filesystem>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace tumble {

class MeshImages {
public:
    /// Files are read from the folder of the mesh file, and below.
    explicit MeshImages(std::filesystem::path folder) : folder_(std::move(folder)) {}

    /// The bytes of the file of that name, or of its last part, because programs write paths of their own disk. Empty
    /// if there is none: the name is kept in missing(). Throws MeshError if it is too large.
    std::optional<std::string> read(std::string_view name);
    /// The texture of a file; null if there is none, or if it is neither PNG nor JPEG.
    std::shared_ptr<const Texture> texture(std::string_view name);
    /// The texture of an image that the mesh file holds under this name.
    std::shared_ptr<const Texture> texture(const std::string& name, std::string_view bytes);
    /// The same of images that hold numbers.
    std::shared_ptr<const Texture> map(std::string_view name);
    std::shared_ptr<const Texture> map(const std::string& name, std::string_view bytes);
    void add_missing(const std::string& name);

    const std::vector<std::filesystem::path>& files() const { return files_; }
    const std::vector<std::string>& missing() const { return missing_; }

private:
    template <class Make>
    std::shared_ptr<const Texture> made(const std::string& key, const std::string& shown,
                                        const std::optional<std::string_view>& bytes, const Make& make);

    std::filesystem::path folder_;
    std::vector<std::filesystem::path> files_;
    std::vector<std::string> missing_;
    std::map<std::string, std::shared_ptr<const Texture>, std::less<>> textures_;
    std::int64_t texels_ = 0, bytes_ = 0;
};

}  // namespace tumble
