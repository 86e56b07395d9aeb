#include "render/damage/damage_tracker.h"

#include "render/damage/plane_damage.h"
#include "render/damage/volume_damage.h"
#include "render/scene/near_plane.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace tumble {
namespace {

// Largest number of moved bodies for which damage is computed: 1 microsecond each, and as much again for their shadows.
constexpr std::ptrdiff_t most_marked = 10'000;

// Square of the shadow maps in coarse cells: the smallest distance from the sun of a moved body in each. Points outside
// count as in the cells at the border.
class LightCells {
public:
    explicit LightCells(const ShadowLight& light) : light_(light) {
        depths_.fill(std::numeric_limits<double>::infinity());
    }

    void add(const DrawableBounds& caster) {
        const double depth = light_.direction.dot(caster.center) - caster.radius;
        visit(caster, 0.0, [&](double& cell) { cell = std::min(cell, depth); });
    }
    bool shadows(const DrawableBounds& receiver) {
        const double depth = light_.direction.dot(receiver.center) + receiver.radius;
        bool found = false;
        // of the cascade that the receiver uses
        const bool far = light_.cascades.may_look_far(receiver.center, receiver.radius);
        const double margin =
            light_.cascades.filter.extent * (far ? light_.cascades.far_texel : light_.cascades.near_texel);
        visit(receiver, margin, [&](const double& cell) { found = found || cell < depth; });
        return found;
    }

private:
    static constexpr int count = 128;  // cells per side

    template <class Visit>
    void visit(const DrawableBounds& item, double more, Visit see) {
        const double radius = (item.radius + more) * length(light_.cascades.x);
        const auto [x0, x1] = range(light_.cascades.x, item.center, radius);
        const auto [y0, y1] = range(light_.cascades.y, item.center, radius);
        for (int y = y0; y <= y1; ++y)
            for (int x = x0; x <= x1; ++x) see(depths_[std::size_t(y * count + x)]);
    }
    static double length(const glm::vec4& row) {
        return std::sqrt(double(row.x) * row.x + double(row.y) * row.y + double(row.z) * row.z);
    }
    static std::pair<int, int> range(const glm::vec4& row, const Vec3& center, double radius) {
        const double at = row.x * center.x() + row.y * center.y() + row.z * center.z() + double(row.w);
        const auto cell = [](double u) { return int(std::clamp(std::floor(u * count), 0.0, double(count - 1))); };
        return {cell(at - radius), cell(at + radius)};
    }

    ShadowLight light_;
    std::array<double, std::size_t(count* count)> depths_;
};

}  // namespace

DamageTracker::DamageTracker(const SceneDescription& description, const RenderScene& scene, const Camera& view)
    : description_(&description), scene_(&scene), view_(&view) {}

bool DamageTracker::moved(const Snapshot& snapshot, std::size_t body) const {
    const BodyState& state = snapshot.bodies[body];
    return poses_[body].origin != state.origin || poses_[body].orientation.coeffs() != state.orientation.coeffs();
}

bool DamageTracker::unmoved(const Snapshot& snapshot) const {
    for (std::size_t i = 0; i < snapshot.bodies.size(); ++i)
        if (first_ || moved(snapshot, i)) return false;
    return !first_;
}

DirtyTiles DamageTracker::find(const FrameState& now, const OcclusionChanges& occlusion, const Visibility& visibility) {
    DirtyTiles dirty(*view_);
    const std::size_t bodies = scene_->bodies.size();
    background_changed_ = first_ || now.near_distance != near_distance_;
    shadow_damage_ = ShadowDirtyTiles(now.shadows);
    if (first_ || now.shadows != shadows_) shadow_damage_.mark_all();
    if (first_) poses_.resize(bodies);
    std::vector<char> item_moved(now.items.size(), 0);
    for (std::size_t i = 0; i < now.items.size(); ++i) {
        const std::size_t body = i < bodies ? i : description_->cords[i - bodies].body;
        item_moved[i] = first_ || moved(now.snapshot, body) ? 1 : 0;
        if (item_moved[i] == 0) continue;
        if (i < bodies && scene_->bodies[i].kind == DrawKind::plane) background_changed_ = true;
        if (!now.items[i].exists()) continue;
        if (!first_) shadow_damage_.mark(items_[i]);
        shadow_damage_.mark(now.items[i]);
    }
    shadow_damage_.settle();
    // If many bodies move, computing the damage would cost more than a full redraw.
    const bool many = std::count(item_moved.begin(), item_moved.end(), char(1)) > most_marked;
    if (too_near(now) || many || background_changed_ || now.shadows != shadows_ || occlusion.plane_tiles_moved) {
        dirty.mark_all();
    } else {
        for (std::size_t i = 0; i < now.items.size() && !dirty.all(); ++i) {
            if (item_moved[i] == 0 || !now.items[i].exists()) continue;
            for (const DrawableBounds* item : std::array<const DrawableBounds*, 2>{&items_[i], &now.items[i]}) {
                dirty.mark_hull(item->corners());
                mark_on_planes(*item, i, now, dirty);
            }
        }
        if (description_->light.shadows) mark_shadow_receivers(item_moved, now, visibility, dirty);
        for (const OcclusionChanges::Body& changed : occlusion.bodies) {
            const DrawableBounds& item = now.items[changed.body];
            if (item_moved[changed.body] != 0) continue;
            if (changed.faces == 0) dirty.mark_hull(item.corners());
            for (int face = 0; face < 6; ++face)
                if ((changed.faces >> face & 1) != 0) dirty.mark_hull(face_part(item, face));
        }
        for (const OcclusionChanges::Part& part : occlusion.parts) {
            if (item_moved[part.body] != 0) continue;
            const DrawableBounds& item = now.items[part.body];
            // With several samples, the pixel center may be outside the face and use a texel at its border.
            dirty.mark_hull(now.one_sample ? face_part(item, part.face, part.low, part.high)
                                           : face_part(item, part.face));
        }
        for (const OcclusionChanges::Patch& patch : occlusion.patches) {
            if (item_moved[patch.body] != 0 || dirty.all()) continue;
            const BodyState& state = now.snapshot.bodies[patch.body];
            const Vec3 center = view_->relative(state.origin) + state.orientation * patch.bounds.center();
            dirty.mark_hull(now.one_sample
                                ? box_corners(center, state.orientation.toRotationMatrix(), 0.5 * patch.bounds.extent())
                                : now.items[patch.body].corners());
        }
    }
    for (std::size_t i = 0; i < bodies; ++i)
        poses_[i] = {now.snapshot.bodies[i].origin, now.snapshot.bodies[i].orientation};
    items_ = now.items;
    near_distance_ = now.near_distance;
    shadows_ = now.shadows;
    first_ = false;
    return dirty;
}

// Items in front of the near plane are clamped to the nearest depth, which closed tiles have as well.
bool DamageTracker::too_near(const FrameState& now) const {
    for (std::size_t i = 0; i < now.items.size(); ++i) {
        const DrawableBounds& item = now.items[i];
        if (!item.exists() || !view_->sees(item.center, item.radius)) continue;
        const double depth = i < scene_->bodies.size() ? least_depth(scene_->bodies[i], *scene_, now.snapshot.bodies[i],
                                                                     {item.center, item.radius}, *view_)
                                                       : item.center.dot(view_->forward()) - item.radius;
        if (depth < 1.01 * now.near_distance) return true;
    }
    return false;
}

void DamageTracker::mark_on_planes(const DrawableBounds& item, std::size_t number, const FrameState& now,
                                   DirtyTiles& dirty) const {
    const double ao_radius = number < scene_->bodies.size() ? scene_->bodies[number].ao_radius : 0.0;
    const ShadowLight light(description_->light, now.shadows);
    const double blur = 1.5 * scene_->plane_cell;
    for (const PlanePatch& plane : now.planes) mark_on_plane(plane, item, ao_radius, blur, light, *view_, dirty);
}

// Marks items that stand still behind one that moved, as seen from the sun.
void DamageTracker::mark_shadow_receivers(const std::vector<char>& item_moved, const FrameState& now,
                                          const Visibility& visibility, DirtyTiles& dirty) const {
    const ShadowLight light(description_->light, now.shadows);
    LightCells cells{light};
    for (std::size_t i = 0; i < now.items.size(); ++i) {
        if (item_moved[i] == 0 || !now.items[i].exists()) continue;
        cells.add(items_[i]);
        cells.add(now.items[i]);
    }
    std::vector<FaceDamage> faces;
    std::vector<VolumeDamage> volumes;
    for (std::size_t i = 0; i < now.items.size(); ++i) {
        if (item_moved[i] != 0 || !now.items[i].exists()) continue;
        if (i < visibility.bodies.size() && !visibility.bodies[i]) continue;
        if (!cells.shadows(now.items[i])) continue;
        const RenderBody* proxy = i < scene_->bodies.size() ? &scene_->bodies[i] : nullptr;
        const bool large = proxy != nullptr && (proxy->large_receiver || proxy->lightmap >= 0) && now.one_sample &&
                           FaceDamage::suits(now.items[i], now.shadows);
        if (!large)
            dirty.mark_hull(now.items[i].corners());
        else if (proxy->kind == DrawKind::box)
            faces.emplace_back(now.items[i], visibility.faces[i], light, *view_);
        else
            volumes.emplace_back(now.items[i], *proxy, *scene_, now.snapshot.bodies[i], light, *view_);
    }
    if (faces.empty() && volumes.empty()) return;
    for (std::size_t i = 0; i < now.items.size() && !dirty.all(); ++i) {
        if (item_moved[i] == 0 || !now.items[i].exists()) continue;
        for (const FaceDamage& box : faces) {
            box.mark_shadow(items_[i], dirty);
            box.mark_shadow(now.items[i], dirty);
        }
        for (const VolumeDamage& volume : volumes) {
            volume.mark_shadow(items_[i], dirty);
            volume.mark_shadow(now.items[i], dirty);
        }
    }
}

}  // namespace tumble
