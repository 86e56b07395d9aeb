// The texel of a place in a texture.
#pragma once

#include "scene/description/mesh_paint.h"

#include <algorithm>
#include <cmath>

namespace tumble {

/// Along one side, u = 0 to 1 across the image.
inline int texel_of(float u, int size, TextureWrap wrap) {
    if (!std::isfinite(u)) return 0;
    float in = std::clamp(u, 0.0f, 1.0f);
    if (wrap == TextureWrap::repeat) in = u - std::floor(u);
    if (wrap == TextureWrap::mirror) {
        in = u - 2.0f * std::floor(0.5f * u);
        if (in > 1.0f) in = 2.0f - in;
    }
    return std::clamp(int(in * float(size)), 0, size - 1);
}

/// Linear light and alpha of the nearest texel of the image; white without one.
inline std::array<float, 4> nearest_texel(const MeshMaterial& material, const std::array<float, 2>& uv) {
    if (!material.texture) return {1.0f, 1.0f, 1.0f, 1.0f};
    const Texture::Level& image = material.texture->levels.front();
    return material.texture->texel(0, texel_of(uv[0], image.width, material.wrap_u),
                                   texel_of(uv[1], image.height, material.wrap_v));
}

}  // namespace tumble
