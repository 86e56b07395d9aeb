// Colors of patterns, and places of textures on shapes.
#pragma once

#include "scene/description/description.h"

#include <array>
#include <memory>
#include <span>

namespace tumble {

/// True for a pattern of two colors. A grid and a checker without a pattern_color only darken.
bool two_colored(const Appearance& look);

/// The second color of a pattern: pattern_color, or the color, darker.
Color second_color(const Appearance& look);

/// The one color that stands for a pattern of two, or for a texture, where only one can be shown; otherwise the color.
Color mean_color(const Appearance& look);

/// Continuation of the texture of a shape beyond its edges.
struct TextureWraps {
    TextureWrap u, v;
};
TextureWraps texture_wraps(const Shape& shape, const Appearance& look);

/// Place in the texture, in images: (0, 0) at its top left corner. Front of a shape is +z, up is +y.
using TexturePlace = std::array<double, 2>;
/// `normal`: of the surface, in the frame of the shape. `scale`: Appearance::texture_scale.
TexturePlace texture_place(const Shape& shape, const Vec3& position, const Vec3& normal, double scale);
/// Images around a ball or a curved shape, and from end to end; 0 of other shapes.
std::array<double, 2> images_around(const Shape& shape, double scale);
/// The same of the corners of a triangle: continuous where the image closes around a shape.
std::array<TexturePlace, 3> texture_places(const Shape& shape, const std::array<Vec3, 3>& positions,
                                           const std::array<Vec3, 3>& normals, double scale);

/// The axes of a plane's pattern, of its texture and of its tile in the AO atlas.
struct PlaneAxes {
    Vec3 u, v;  // unit, in the plane, u x v = normal
};
PlaneAxes plane_axes(const Vec3& normal);

/// The texture of a look as a material; without a texture its color alone.
MeshMaterial texture_material(const Shape& shape, const Appearance& look);

/// The paint of triangles that stand for a shape, by the places of their corners.
std::shared_ptr<const MeshPaint> texture_paint(const Shape& shape, const Appearance& look,
                                               std::span<const MeshAsset::Vertex> vertices,
                                               std::span<const std::uint32_t> indices);

}  // namespace tumble
