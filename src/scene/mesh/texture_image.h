// Textures from the bytes of image files, PNG and JPEG.
#pragma once

#include "scene/description/mesh_paint.h"

#include <array>
#include <cstdint>
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

/// The mean of the bytes of each channel, from 0 to 1, of an image that holds numbers. Throws as make_texture().
std::array<float, 4> mean_of_image(std::string_view bytes, const std::string& name);

}  // namespace tumble
