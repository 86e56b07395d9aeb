// A PNG or JPEG file as a texture: the result is an image with all of its mip maps, or a MeshError.
#include "png_bytes.h"

#include "core/check.h"
#include "scene/mesh/mesh_file.h"
#include "scene/mesh/texture_image.h"
#include "scene/toml/limits.h"

#include <algorithm>
#include <string_view>

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    const std::string_view bytes(reinterpret_cast<const char*>(data), size);
    if (!tumble::is_texture_image(bytes)) return 0;
    std::int64_t texels = tumble::limits::texture_texels - tumble::fuzzed_pixels;  // larger images are too much
    try {
        const auto texture = tumble::make_texture(bytes, "", texels);
        int width = texture->levels.front().width, height = texture->levels.front().height;
        for (const tumble::Texture::Level& level : texture->levels) {
            TUMBLE_CHECK_EQ(level.width, width);
            TUMBLE_CHECK_EQ(level.height, height);
            TUMBLE_CHECK_EQ(level.texels.size(), std::size_t(width) * std::size_t(height));
            width = std::max(1, width / 2);
            height = std::max(1, height / 2);
        }
        TUMBLE_CHECK_EQ(texture->levels.back().texels.size(), std::size_t(1));
        for (const auto& texel : texture->levels.front().texels)
            TUMBLE_CHECK_EQ(texel[3] >= texture->least_alpha, true);
        const auto map = tumble::make_map(bytes, "", texels);
        TUMBLE_CHECK_EQ(map->levels.size(), texture->levels.size());
        TUMBLE_CHECK_EQ(tumble::normals_of_heights(*map, 1.0f)->levels.size(), map->levels.size());
    } catch (const tumble::MeshError&) {
    }
    return 0;
}

extern "C" std::size_t LLVMFuzzerMutate(std::uint8_t* data, std::size_t size, std::size_t room) __attribute__((weak));

extern "C" std::size_t LLVMFuzzerCustomMutator(std::uint8_t* data, std::size_t size, std::size_t room, unsigned seed) {
    size = LLVMFuzzerMutate(data, size, room);
    if (size > 0 && data[0] == 0x89 && seed % 8 != 0) tumble::mend_checksums({data, size});
    return size;
}
