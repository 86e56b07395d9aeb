// A file in the format of OpenEXR: the result is an image of finite light, or a MeshError.
#include "core/check.h"
#include "scene/environment/exr_image.h"
#include "scene/mesh/mesh_file.h"
#include "scene/toml/limits.h"

#include <cmath>
#include <string_view>

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    const std::string_view bytes(reinterpret_cast<const char*>(data), size);
    if (!tumble::is_exr_image(bytes)) return 0;
    try {
        const tumble::EnvironmentImage image = tumble::read_exr_image(bytes);
        TUMBLE_CHECK_EQ(image.width >= 1 && image.width <= tumble::limits::environment_side, true);
        TUMBLE_CHECK_EQ(image.height >= 1 && image.height <= tumble::limits::environment_side, true);
        TUMBLE_CHECK_EQ(image.texels.size(), std::size_t(image.width) * std::size_t(image.height));
        for (const auto& texel : image.texels)
            for (const float channel : texel) TUMBLE_CHECK_EQ(std::isfinite(channel) && channel >= 0.0f, true);
    } catch (const tumble::MeshError&) {
    }
    return 0;
}
