// The colors of a mesh file: materials with textures, and colors of vertices. Colors are linear light.
#pragma once

#include "core/color.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

namespace tumble {

/// An image with its mip maps.
struct Texture {
    struct Level {
        int width = 0, height = 0;
        /// Rows from the top: red, green, blue as square roots of linear light, whose 8 bits lose less than half a
        /// level of sRGB and which a shader decodes by one product; alpha as it is.
        std::vector<std::array<std::uint8_t, 4>> texels;
    };
    std::vector<Level> levels;       // each of half the size of the one before, down to one texel
    std::uint8_t least_alpha = 255;  // of the image

    /// A texel of the image: linear light and alpha.
    std::array<float, 4> texel(std::size_t level, int x, int y) const;
};

/// Continuation of a texture beyond its edges.
enum class TextureWrap : std::uint8_t { repeat, mirror, clamp };

/// Images in addition to that of the color, at the same places. Their texels hold numbers, not square roots.
struct SurfaceMaps {
    using Map = std::shared_ptr<const Texture>;
    Map normal;    // red rightward, green upward, blue outward, 128 is 0; a mean that is short stands for a rough place
    Map surface;   // red: share of the sky light; green and blue: factors of roughness and metallic
    Map emission;  // a color, multiplies the emission

    static constexpr unsigned with_normal = 1, with_surface = 2, with_emission = 4;
    /// Bits of the maps that there are.
    unsigned bits() const {
        return (normal ? with_normal : 0u) | (surface ? with_surface : 0u) | (emission ? with_emission : 0u);
    }
    bool operator==(const SurfaceMaps&) const = default;
};

struct MeshMaterial {
    static constexpr float of_body = -1.0f;  // a property that the file does not state

    std::array<float, 3> color{1.0f, 1.0f, 1.0f};
    float roughness = of_body, metallic = of_body;
    std::array<float, 3> emission{};
    float cutoff = 0.0f;                     // texels with less alpha are holes; 0: none
    std::shared_ptr<const Texture> texture;  // multiplies the color; null: none
    TextureWrap wrap_u = TextureWrap::repeat, wrap_v = TextureWrap::repeat;
    bool nearest = false;  // texels are drawn as squares
    SurfaceMaps maps;
    float opacity = 1.0f;
    bool blends = false;  // the alpha of the texture multiplies the opacity

    bool translucent() const { return opacity < 1.0f || (blends && texture && texture->least_alpha < 255); }
    bool has_holes() const { return texture && float(texture->least_alpha) < 255.0f * cutoff; }
};

/// The looks of a mesh, by its triangles in the order of MeshAsset::indices.
struct MeshPaint {
    struct Corner {
        std::array<float, 2> uv;  // place in the texture, (0, 0) at its top left corner
        std::array<float, 3> color;
    };
    std::vector<MeshMaterial> materials;
    std::vector<std::uint32_t> material_of_triangle;
    std::vector<Corner> corners;              // three for each triangle
    Color mean;                               // for drawings with one color
    std::vector<std::string> missing_images;  // names of images that could not be read

    /// SurfaceMaps::bits() of all materials together.
    unsigned map_bits() const {
        unsigned bits = 0;
        for (const MeshMaterial& material : materials) bits |= material.maps.bits();
        return bits;
    }
    bool translucent() const { return std::ranges::any_of(materials, &MeshMaterial::translucent); }
    bool has_holes() const { return std::ranges::any_of(materials, &MeshMaterial::has_holes); }
};

/// The color of a material at a place: of the nearest texel of the image, with the color of the vertices.
std::array<float, 3> color_at(const MeshMaterial& material, const std::array<float, 2>& uv,
                              const std::array<float, 3>& vertex_color);

}  // namespace tumble
