#include "render/damage/volume_damage.h"

#include <algorithm>
#include <array>
#include <limits>

namespace tumble {

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
