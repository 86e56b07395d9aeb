#include "scene/description/looks.h"

#include "core/deterministic_math.h"

#include <algorithm>
#include <cmath>

namespace tumble {
namespace {

std::uint8_t channel_of(double linear) {
    return std::uint8_t(std::lround(255.0 * linear_to_srgb(std::clamp(linear, 0.0, 1.0))));
}

/// Share of the second color in the mean of a pattern, as in shaders/solid_pattern.glsl.
double second_share(Pattern pattern) {
    switch (pattern) {
        case Pattern::grid:
            return 0.087;
        case Pattern::dots:
            return 0.283;
        case Pattern::wood:
            return 0.36;
        case Pattern::marble:
            return 0.16;
        default:
            return 0.5;
    }
}

/// The direction along which a surface is flattest, and the position seen from there: rightward and downward.
TexturePlace seen_from_outside(const Vec3& position, const Vec3& normal) {
    const Vec3 a = normal.cwiseAbs();
    if (a.x() > a.y() && a.x() > a.z()) return {normal.x() > 0.0 ? -position.z() : position.z(), -position.y()};
    if (a.y() > a.z()) return {position.x(), normal.y() > 0.0 ? position.z() : -position.z()};
    return {normal.z() > 0.0 ? position.x() : -position.x(), -position.y()};
}

/// A flat end of a cylinder or of a cone.
bool on_cap(const Shape& shape, const Vec3& normal) {
    const auto* curved = std::get_if<CurvedShape>(&shape);
    const bool has_caps = curved && (curved->kind == CurvedKind::cylinder || curved->kind == CurvedKind::cone);
    return has_caps && std::abs(normal.y()) > 0.9999;
}

/// From end to end.
double whole_height(const CurvedShape& shape) {
    if (shape.kind == CurvedKind::ellipsoid) return 2.0 * shape.radii.y();
    return shape.height + (shape.kind == CurvedKind::capsule ? 2.0 * shape.radius : 0.0);
}

double widest(const CurvedShape& shape) {
    if (shape.kind == CurvedKind::ellipsoid) return std::max(shape.radii.x(), shape.radii.z());
    return std::max(shape.radius, shape.top_radius);
}

/// Places of a texture on one kind of shape.
struct PlaceOn {
    const Vec3& position;
    const Vec3& normal;
    double scale;

    TexturePlace on_box(const Vec3& from_center, const Vec3& size) const {
        const TexturePlace at = seen_from_outside(from_center, normal), whole = seen_from_outside(size, normal);
        TexturePlace place;
        for (std::size_t c = 0; c < 2; ++c)
            place[c] = 0.5 + at[c] / (scale > 0.0 ? scale : std::max(std::abs(whole[c]), 1e-300));
        return place;
    }

    TexturePlace operator()(const BoxShape& box) const { return on_box(position, box.size); }
    TexturePlace operator()(const SphereShape& ball) const {
        const auto [images, height] = images_around(ball, scale);
        const double polar = atan2_stable(hypotenuse(position.x(), position.z()), position.y());
        return {images * (0.5 + atan2_stable(position.x(), position.z()) / (2.0 * pi)),
                0.5 + height * (polar / pi - 0.5)};
    }
    TexturePlace operator()(const PlaneShape& plane) const {
        const PlaneAxes axes = plane_axes(plane.normal);
        const double image = scale > 0.0 ? scale : 1.0;
        return {axes.u.dot(position) / image, -axes.v.dot(position) / image};
    }
    TexturePlace operator()(const MeshShape& mesh) const {
        const Bounds bounds = mesh.asset->mesh.bounds();
        return on_box(position - bounds.center(), bounds.extent());
    }
    // Around the axis and down its height, as a label on a can; an end has the image as a disk.
    TexturePlace operator()(const CurvedShape& shape) const {
        const double width = 2.0 * widest(shape), height = whole_height(shape);
        if (on_cap(shape, normal)) return on_box(position, {width, height, width});
        return {images_around(shape, scale)[0] * (0.5 + atan2_stable(position.x(), position.z()) / (2.0 * pi)),
                0.5 - position.y() / (scale > 0.0 ? scale : height)};
    }
    TexturePlace operator()(const CompoundShape&) const { return {}; }  // its parts have places
};

}  // namespace

std::array<double, 2> images_around(const Shape& shape, double scale) {
    if (const auto* curved = std::get_if<CurvedShape>(&shape)) {
        if (!(scale > 0.0)) return {1.0, 1.0};
        return {std::max(1.0, std::round(2.0 * pi * widest(*curved) / scale)), whole_height(*curved) / scale};
    }
    const auto* ball = std::get_if<SphereShape>(&shape);
    if (ball == nullptr) return {};
    const double around = 2.0 * pi * ball->radius;
    if (!(scale > 0.0)) return {1.0, 1.0};
    return {std::max(1.0, std::round(around / scale)), 0.5 * around / scale};
}

bool two_colored(const Appearance& look) {
    if (look.pattern == Pattern::grid || look.pattern == Pattern::checker) return look.pattern_color.has_value();
    return look.pattern != Pattern::panel && look.pattern != Pattern::plain;
}

Color second_color(const Appearance& look) {
    if (look.pattern_color) return *look.pattern_color;
    const std::array<double, 3> linear = to_linear(look.color);
    const bool wood = look.pattern == Pattern::wood;  // late wood is redder
    return {channel_of((wood ? 0.46 : 0.35) * linear[0]), channel_of((wood ? 0.34 : 0.35) * linear[1]),
            channel_of((wood ? 0.25 : 0.35) * linear[2])};
}

Color mean_color(const Appearance& look) {
    if (!two_colored(look) && !look.texture) return look.color;
    const std::array<double, 3> first = to_linear(look.color);
    std::array<double, 3> second = to_linear(second_color(look));
    double share = second_share(look.pattern);
    if (look.texture) {
        const std::array<float, 4> texel = look.texture->texel(look.texture->levels.size() - 1, 0, 0);
        for (std::size_t c = 0; c < 3; ++c) second[c] = first[c] * double(texel[c]);
        share = 1.0;
    }
    std::array<std::uint8_t, 3> mean{};
    for (std::size_t c = 0; c < 3; ++c) mean[c] = channel_of(first[c] + share * (second[c] - first[c]));
    return {mean[0], mean[1], mean[2]};
}

PlaneAxes plane_axes(const Vec3& normal) {
    const Vec3 across = std::abs(normal.x()) < 0.9 ? Vec3::UnitX() : Vec3::UnitY();
    const Vec3 u = (across - normal * normal.dot(across)).normalized();
    return {u, normal.cross(u)};
}

TextureWraps texture_wraps(const Shape& shape, const Appearance& look) {
    if (std::holds_alternative<PlaneShape>(shape) || look.texture_scale > 0.0)
        return {TextureWrap::repeat, TextureWrap::repeat};
    return {images_around(shape, 0.0)[0] > 0.0 ? TextureWrap::repeat : TextureWrap::clamp, TextureWrap::clamp};
}

TexturePlace texture_place(const Shape& shape, const Vec3& position, const Vec3& normal, double scale) {
    return std::visit(PlaceOn{position, normal, scale}, shape);
}

std::array<TexturePlace, 3> texture_places(const Shape& shape, const std::array<Vec3, 3>& positions,
                                           const std::array<Vec3, 3>& normals, double scale) {
    const double images = images_around(shape, scale)[0];
    // A face of a box has one normal; a rounded corner belongs to the face of its triangle.
    const Vec3 flat = (positions[1] - positions[0]).cross(positions[2] - positions[0]);
    std::array<TexturePlace, 3> places;
    for (std::size_t i = 0; i < 3; ++i)
        places[i] = texture_place(shape, positions[i], images > 0.0 ? normals[i] : flat, scale);
    if (images == 0.0 || on_cap(shape, normals[0])) return places;
    const auto at_pole = [&](std::size_t i) {
        return hypotenuse(positions[i].x(), positions[i].z()) < 1e-6 * positions[i].norm();
    };
    const std::size_t fixed = at_pole(0) ? 1 : 0;
    for (std::size_t i = 0; i < 3; ++i) places[i][0] -= images * std::round((places[i][0] - places[fixed][0]) / images);
    for (std::size_t i = 0; i < 3; ++i)
        if (at_pole(i)) places[i][0] = 0.5 * (places[(i + 1) % 3][0] + places[(i + 2) % 3][0]);
    return places;
}

MeshMaterial texture_material(const Shape& shape, const Appearance& look) {
    MeshMaterial material;
    const std::array<double, 3> linear = to_linear(look.color);
    for (std::size_t c = 0; c < 3; ++c) material.color[c] = float(linear[c]);
    const TextureWraps wraps = texture_wraps(shape, look);
    material.texture = look.texture;
    material.wrap_u = wraps.u;
    material.wrap_v = wraps.v;
    material.nearest = look.texture_filter == TextureFilter::nearest;
    material.maps = {look.normal_map, look.roughness_map, nullptr};
    return material;
}

std::shared_ptr<const MeshPaint> texture_paint(const Shape& shape, const Appearance& look,
                                               std::span<const MeshAsset::Vertex> vertices,
                                               std::span<const std::uint32_t> indices) {
    auto paint = std::make_shared<MeshPaint>();
    paint->materials.push_back(texture_material(shape, look));
    paint->mean = mean_color(look);
    paint->material_of_triangle.assign(indices.size() / 3, 0);
    for (std::size_t t = 0; t + 2 < indices.size(); t += 3) {
        std::array<Vec3, 3> positions, normals;
        for (std::size_t i = 0; i < 3; ++i) {
            const MeshAsset::Vertex& v = vertices[indices[t + i]];
            positions[i] = Vec3(v.position[0], v.position[1], v.position[2]);
            normals[i] = Vec3(v.normal[0], v.normal[1], v.normal[2]);
        }
        for (const TexturePlace& place : texture_places(shape, positions, normals, look.texture_scale))
            paint->corners.push_back({{float(place[0]), float(place[1])}, {1.0f, 1.0f, 1.0f}});
    }
    return paint;
}

}  // namespace tumble
