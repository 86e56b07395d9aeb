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
        const bool far = light_.fit.may_look_far(receiver.center, receiver.radius);
        const double margin = light_.fit.filter.reach * (far ? light_.fit.far_texel : light_.fit.near_texel);
        visit(receiver, margin, [&](const double& cell) { found = found || cell < depth; });
        return found;
    }

private:
    static constexpr int count = 128;  // cells per side

    template <class Visit>
    void visit(const DrawableBounds& item, double more, Visit see) {
        const double radius = (item.radius + more) * length(light_.fit.x);
        const auto [x0, x1] = range(light_.fit.x, item.center, radius);
        const auto [y0, y1] = range(light_.fit.y, item.center, radius);
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

DamageTracker::DamageTracker(const SceneDescription& scene, const RenderScene& looks, const Camera& view)
    : scene_(&scene), looks_(&looks), view_(&view) {}

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
    DirtyTiles marks(*view_);
    const std::size_t bodies = looks_->bodies.size();
    background_changed_ = first_ || now.near_distance != near_distance_;
    shadow_marks_ = ShadowDirtyTiles(now.shadows);
    if (first_ || now.shadows != shadows_) shadow_marks_.mark_all();
    if (first_) poses_.resize(bodies);
    std::vector<char> item_moved(now.items.size(), 0);
    for (std::size_t i = 0; i < now.items.size(); ++i) {
        const std::size_t body = i < bodies ? i : scene_->cords[i - bodies].body;
        item_moved[i] = first_ || moved(now.snapshot, body) ? 1 : 0;
        if (item_moved[i] == 0) continue;
        if (i < bodies && looks_->bodies[i].kind == DrawKind::plane) background_changed_ = true;
        if (!now.items[i].exists()) continue;
        if (!first_) shadow_marks_.mark(items_[i]);
        shadow_marks_.mark(now.items[i]);
    }
    shadow_marks_.settle();
    // If many bodies move, computing the damage would cost more than a full redraw.
    const bool many = std::count(item_moved.begin(), item_moved.end(), char(1)) > most_marked;
    if (too_near(now) || many || background_changed_ || now.shadows != shadows_ || occlusion.windows_moved) {
        marks.mark_all();
    } else {
        for (std::size_t i = 0; i < now.items.size() && !marks.all(); ++i) {
            if (item_moved[i] == 0 || !now.items[i].exists()) continue;
            for (const DrawableBounds* item : std::array<const DrawableBounds*, 2>{&items_[i], &now.items[i]}) {
                marks.mark_hull(item->corners());
                mark_on_planes(*item, i, now, marks);
            }
        }
        if (scene_->light.shadows) mark_shadowed(item_moved, now, visibility, marks);
        for (const OcclusionChanges::Body& changed : occlusion.bodies) {
            const DrawableBounds& item = now.items[changed.body];
            if (item_moved[changed.body] != 0) continue;
            if (changed.faces == 0) marks.mark_hull(item.corners());
            for (int face = 0; face < 6; ++face)
                if ((changed.faces >> face & 1) != 0) marks.mark_hull(face_part(item, face));
        }
        for (const OcclusionChanges::Part& part : occlusion.parts) {
            if (item_moved[part.body] != 0) continue;
            const DrawableBounds& item = now.items[part.body];
            // With several samples, the pixel center may be outside the face and use a texel at its border.
            marks.mark_hull(now.one_sample ? face_part(item, part.face, part.low, part.high)
                                           : face_part(item, part.face));
        }
        for (const OcclusionChanges::Patch& patch : occlusion.patches) {
            if (item_moved[patch.body] != 0 || marks.all()) continue;
            const BodyState& state = now.snapshot.bodies[patch.body];
            const Vec3 center = view_->relative(state.origin) + state.orientation * patch.bounds.center();
            marks.mark_hull(now.one_sample
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
    return marks;
}

// Items in front of the near plane are clamped to the nearest depth, which closed tiles have as well.
bool DamageTracker::too_near(const FrameState& now) const {
    for (std::size_t i = 0; i < now.items.size(); ++i) {
        const DrawableBounds& item = now.items[i];
        if (!item.exists() || !view_->sees(item.center, item.radius)) continue;
        const double depth = i < looks_->bodies.size() ? least_depth(looks_->bodies[i], *looks_, now.snapshot.bodies[i],
                                                                     {item.center, item.radius}, *view_)
                                                       : item.center.dot(view_->forward()) - item.radius;
        if (depth < 1.01 * now.near_distance) return true;
    }
    return false;
}

void DamageTracker::mark_on_planes(const DrawableBounds& item, std::size_t number, const FrameState& now,
                                   DirtyTiles& marks) const {
    const double reach = number < looks_->bodies.size() ? looks_->bodies[number].reach : 0.0;
    const ShadowLight light(scene_->light, now.shadows);
    const double blur = 1.5 * looks_->window_cell;
    for (const PlanePatch& plane : now.planes) mark_on_plane(plane, item, reach, blur, light, *view_, marks);
}

// Marks items that stand still behind one that moved, as seen from the sun.
void DamageTracker::mark_shadowed(const std::vector<char>& item_moved, const FrameState& now,
                                  const Visibility& visibility, DirtyTiles& marks) const {
    const ShadowLight light(scene_->light, now.shadows);
    LightCells cells{light};
    for (std::size_t i = 0; i < now.items.size(); ++i) {
        if (item_moved[i] == 0 || !now.items[i].exists()) continue;
        cells.add(items_[i]);
        cells.add(now.items[i]);
    }
    std::vector<FaceDamage> grounds;
    std::vector<VolumeDamage> volumes;
    for (std::size_t i = 0; i < now.items.size(); ++i) {
        if (item_moved[i] != 0 || !now.items[i].exists()) continue;
        if (i < visibility.bodies.size() && !visibility.bodies[i]) continue;
        if (!cells.shadows(now.items[i])) continue;
        const RenderBody* look = i < looks_->bodies.size() ? &looks_->bodies[i] : nullptr;
        const bool large = look != nullptr && (look->ground || look->fine_surface >= 0) && now.one_sample &&
                           FaceDamage::suits(now.items[i], now.shadows);
        if (!large)
            marks.mark_hull(now.items[i].corners());
        else if (look->kind == DrawKind::box)
            grounds.emplace_back(now.items[i], visibility.faces[i], light, *view_);
        else
            volumes.emplace_back(now.items[i], *look, *looks_, now.snapshot.bodies[i], light, *view_);
    }
    if (grounds.empty() && volumes.empty()) return;
    for (std::size_t i = 0; i < now.items.size() && !marks.all(); ++i) {
        if (item_moved[i] == 0 || !now.items[i].exists()) continue;
        for (const FaceDamage& ground : grounds) {
            ground.mark_shadow(items_[i], marks);
            ground.mark_shadow(now.items[i], marks);
        }
        for (const VolumeDamage& ground : volumes) {
            ground.mark_shadow(items_[i], marks);
            ground.mark_shadow(now.items[i], marks);
        }
    }
}

}  // namespace tumble
