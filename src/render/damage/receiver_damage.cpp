#include "render/damage/receiver_damage.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace tumble {
namespace {

// Margin for the texels to either side that the filter reads.
constexpr double spare_texels = 0.5;

// Texels at the border of the near map within which a pixel may use the far one: 5 (shadow.glsl), and the normal
// offset.
constexpr double rim_texels = 8.0;

Vec3 row_of(const glm::vec4& row) { return {double(row.x), double(row.y), double(row.z)}; }

}  // namespace

// Tests the rectangle around the points along the face's axes; the face is enlarged for rounding.
bool FaceDamage::Face::meets(std::span<const Vec3> points, double around) const {
    const auto apart = [&](const Vec3& axis, double half) {
        double low = std::numeric_limits<double>::infinity(), high = -low;
        for (const Vec3& p : points) {
            const double at = axis.dot(p - middle);
            low = std::min(low, at);
            high = std::max(high, at);
        }
        return low - around > 1.01 * half || high + around < -1.01 * half;
    };
    return !apart(u, half_u) && !apart(v, half_v);
}

std::array<Vec3, 4> FaceDamage::Face::corners() const {
    std::array<Vec3, 4> points;
    for (std::size_t i = 0; i < 4; ++i)
        points[i] = middle + u * ((i & 1) != 0 ? half_u : -half_u) + v * ((i & 2) != 0 ? half_v : -half_v);
    return points;
}

FaceDamage::FaceDamage(const DrawableBounds& box, std::uint8_t faces, const ShadowLight& light, const Camera& view)
    : light_(light), view_(&view), two_maps_(light.cascades.may_look_far(box.center, box.radius)) {
    for (int face = 0; face < 6; ++face) {
        if ((faces >> face & 1) == 0) continue;
        const int axis = face / 2;
        const Vec3 to_side = (face % 2 == 0 ? -1.0 : 1.0) * box.half_axes.col(axis);
        const Vec3 u = box.half_axes.col((axis + 1) % 3), v = box.half_axes.col((axis + 2) % 3);
        Face f;
        f.middle = box.center + to_side;
        f.half_u = u.norm();
        f.half_v = v.norm();
        f.u = u / f.half_u;
        f.v = v / f.half_v;
        f.normal = to_side.normalized();
        f.approach = -f.normal.dot(light.direction);
        if (f.approach < -1e-6) continue;  // turned away from the sun
        Mat3 to_map;
        to_map << row_of(light.cascades.x).transpose(), row_of(light.cascades.y).transpose(), f.normal.transpose();
        f.from_map = to_map.inverse();
        faces_.push_back(f);
    }
}

bool FaceDamage::suits(const DrawableBounds& box, const ShadowCascades& shadows) {
    return shadows.near_holds(box.center, box.radius) || shadows.spans_maps(box.center, box.radius);
}

void FaceDamage::mark_shadow(const DrawableBounds& caster, DirtyTiles& dirty) const {
    const ShadowCascades& cascades = light_.cascades;
    const double most_margin = cascades.filter.extent * (two_maps_ ? cascades.far_texel : cascades.near_texel);
    if (!view_->sees_swept(caster.center, caster.radius + most_margin, light_.direction)) return;
    for (const Face& face : faces_) {
        if (face.normal.dot(caster.center - face.middle) < -caster.radius) continue;
        if (face.approach < least_approach) {
            dirty.mark_hull(face.corners());
            continue;
        }
        const auto foot_of = [&](const Vec3& p) -> Vec3 {
            return p + light_.direction * (face.normal.dot(p - face.middle) / face.approach);
        };
        const std::array<Vec3, 1> foot = {foot_of(caster.center)};
        // the common case in scenes of many bodies
        if (!face.meets(foot, (caster.radius + most_margin) / face.approach)) continue;
        std::array<Vec3, 8> feet = caster.corners();
        for (Vec3& corner : feet) corner = foot_of(corner);
        const double margin = light_.filter_extent(face.approach) * cascades.near_texel / face.approach;
        if (face.meets(feet, margin)) dirty.mark_hull(feet, margin);
        if (two_maps_) mark_in_far_map(face, caster, dirty);
    }
}

// The far map's texels are up to 64 times as wide, but it is used only outside the near one. Unit across the light:
// widths of the near map. A point samples the place of itself displaced along the normal, and some texels around it.
void FaceDamage::mark_in_far_map(const Face& face, const DrawableBounds& caster, DirtyTiles& dirty) const {
    const ShadowCascades& cascades = light_.cascades;
    const double inner = 0.5 - rim_texels / cascades.texels, extent = (cascades.far_along() + spare_texels) *
                                                                      cascades.far_texel /
                                                                      (cascades.near_texel * cascades.texels);
    const auto range = [&](const glm::vec4& row) {
        const Vec3 axis = row_of(row);
        const double at = axis.dot(caster.center) + double(row.w) -
                          axis.dot(face.normal) * (cascades.filter.offset * cascades.far_texel);
        const double half = (caster.half_axes.transpose() * axis).cwiseAbs().sum() + extent;
        return std::pair(at - half, at + half);
    };
    const auto [x0, x1] = range(cascades.x);
    const auto [y0, y1] = range(cascades.y);
    const auto mark = [&](double left, double right, double low, double high) {
        if (!(left < right && low < high)) return;
        std::array<Vec3, 4> points;
        for (std::size_t i = 0; i < 4; ++i)
            points[i] =
                face.from_map * Vec3(((i & 1) != 0 ? right : left) - double(cascades.x.w),
                                     ((i & 2) != 0 ? high : low) - double(cascades.y.w), face.normal.dot(face.middle));
        if (face.meets(points, 0.0)) dirty.mark_hull(points);
    };
    mark(x0, std::min(x1, 0.5 - inner), y0, y1);
    mark(std::max(x0, 0.5 + inner), x1, y0, y1);
    mark(x0, x1, y0, std::min(y1, 0.5 - inner));
    mark(x0, x1, std::max(y0, 0.5 + inner), y1);
}

VolumeDamage::VolumeDamage(const DrawableBounds& item, const RenderBody& proxy, const FrameContext& frame,
                           const BodyState& state, const ShadowLight& light)
    : light_(light),
      view_(&frame.camera),
      axes_(state.orientation.toRotationMatrix()),
      two_maps_(light.cascades.may_look_far(item.center, item.radius)) {
    if (proxy.lightmap < 0) {
        boxes_.push_back({item.center, item.half_axes.colwise().norm()});
        return;
    }
    const Vec3 origin = frame.camera.relative(state.origin);
    for (const OcclusionLightmap::Group& group : frame.scene.lightmaps[std::size_t(proxy.lightmap)].groups) {
        const Vec3 center = origin + axes_ * group.bounds.center();
        if (frame.camera.sees(center, 0.5 * group.bounds.extent().norm()))
            boxes_.push_back({center, 0.5 * group.bounds.extent()});
    }
}

// A shadow extends beyond its outline by the filter and the normal offset. Near the border of the near map, or outside
// it, those of the far one apply.
void VolumeDamage::mark_shadow(const DrawableBounds& caster, DirtyTiles& dirty) const {
    const double near = light_.cascades.filter.extent * light_.cascades.near_texel,
                 far = light_.cascades.filter.extent * light_.cascades.far_texel;
    const double margin = two_maps_ && !light_.cascades.near_holds(caster.center, caster.radius + far) ? far : near;
    if (!view_->sees_swept(caster.center, caster.radius + margin, light_.direction)) return;
    for (const Box& box : boxes_) mark_in(box, caster, margin, dirty);
}

// The interval along the light within which a box around the caster meets the box (the slabs of Kay and Kajiya 1986).
void VolumeDamage::mark_in(const Box& box, const DrawableBounds& caster, double margin, DirtyTiles& dirty) const {
    double enter = -margin, leave = std::numeric_limits<double>::infinity();
    for (int k = 0; k < 3; ++k) {
        const Vec3 axis = axes_.col(k);
        const double at = axis.dot(caster.center - box.center), speed = axis.dot(light_.direction);
        const double room = box.half_size[k] + (caster.half_axes.transpose() * axis).cwiseAbs().sum() + margin;
        if (std::abs(speed) < 1e-12) {
            if (std::abs(at) > room) return;
            continue;
        }
        const double a = (-room - at) / speed, b = (room - at) / speed;
        enter = std::max(enter, std::min(a, b));
        leave = std::min(leave, std::max(a, b));
    }
    if (!(enter <= leave)) return;
    std::array<Vec3, 16> points;
    const std::array<Vec3, 8> corners = caster.corners();
    for (std::size_t i = 0; i < 8; ++i) {
        points[i] = corners[i] + light_.direction * enter;
        points[i + 8] = corners[i] + light_.direction * leave;
    }
    dirty.mark_hull(points, margin);
}

}  // namespace tumble
