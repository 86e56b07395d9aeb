#include "scene/description/mesh_paint.h"

#include "scene/description/texel_of.h"

namespace tumble {
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
    const std::array<float, 4> texel = nearest_texel(material, uv);
    for (std::size_t c = 0; c < 3; ++c) color[c] = color[c] * texel[c] * vertex_color[c];
    return color;
}

}  // namespace tumble
