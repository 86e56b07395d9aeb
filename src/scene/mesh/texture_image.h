// Textures from the bytes of image files, PNG and JPEG.
#pragma once

#include "scene/description/mesh_paint.h"

#include <array>
#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <string_view>

namespace tumble {

/// True for the first bytes of a PNG or JPEG file.
bool is_texture_image(std::string_view bytes);

/// The texture of an image in sRGB. Mip maps are means in linear light, weighted by alpha. Adds its texels to `texels`,
/// of which a file has limits::texture_texels at most. Throws MeshError if it is broken or too large, with the name of
/// the image in a mesh file; without a name the image is the file.
std::shared_ptr<const Texture> make_texture(std::string_view bytes, const std::string& name, std::int64_t& texels);

/// The texture of an image that holds numbers: its bytes as they are, opaque; mip maps are their means. Throws as
/// make_texture().
std::shared_ptr<const Texture> make_map(std::string_view bytes, const std::string& name, std::int64_t& texels);

/// The same with other texels in the image; `change`(x, y, texel) changes one.
std::shared_ptr<const Texture> changed_map(
    const Texture& map, const std::function<void(int x, int y, std::array<std::uint8_t, 4>& texel)>& change);

/// A map whose first two channels are slopes instead of heights: of a gray image, which is higher where it is brighter.
/// `strength`: height of white over black, in texels.
std::shared_ptr<const Texture> normals_of_heights(const Texture& heights, float strength);

/// True for an image whose texels are gray.
bool is_gray(const Texture& map);

}  // namespace tumble
