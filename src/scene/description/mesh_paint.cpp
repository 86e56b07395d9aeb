#include "scene/description/mesh_paint.h"

#include <algorithm>
#include <cmath>

namespace tumble {
namespace {

/// The texel of a place along one side, u = 0 to 1 across the image.
int texel_of(float u, int size, TextureWrap wrap) {
    if (!std::isfinite(u)) return 0;
    float in = std::clamp(u, 0.0f, 1.0f);
    if (wrap == TextureWrap::repeat) in = u - std::floor(u);
    if (wrap == TextureWrap::mirror) {
        in = u - 2.0f * std::floor(0.5f * u);
        if (in > 1.0f) in = 2.0f - in;
    }
    return std::clamp(int(in * float(size)), 0, size - 1);
}

}  // namespace

std::array<float, 4> Texture::texel(std::size_t level, int x, int y) const {
    const Level& image = levels[level];
    const auto& code = image.texels[std::size_t(y) * std::size_t(image.width) + std::size_t(x)];
    std::array<float, 4> result{};
    for (std::size_t c = 0; c < 4; ++c) result[c] = float(code[c]) / 255.0f;
    for (std::size_t c = 0; c < 3; ++c) result[c] *= result[c];
    return result;
}

std::array<float, 3> color_at(const MeshMaterial& material, const std::array<float, 2>& uv,
                              const std::array<float, 3>& vertex_color) {
    std::array<float, 3> color = material.color;
    if (material.texture) {
        const Texture::Level& image = material.texture->levels.front();
        const auto texel = material.texture->texel(0, texel_of(uv[0], image.width, material.wrap_u),
                                                   texel_of(uv[1], image.height, material.wrap_v));
        for (std::size_t c = 0; c < 3; ++c) color[c] *= texel[c];
    }
    for (std::size_t c = 0; c < 3; ++c) color[c] *= vertex_color[c];
    return color;
}

}  // namespace tumble
