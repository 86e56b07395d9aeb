#include "render/damage/damage_tracker.h"

#include "render/damage/plane_damage.h"
#include "render/damage/receiver_damage.h"
#include "render/scene/drawable_bounds.h"
#include "render/shadow/caster_culling.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace tumble {
namespace {

// Largest number of moved bodies for which damage is computed: 1 microsecond each, and as much again for their shadows.
constexpr std::ptrdiff_t most_moved = 10'000;

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
    void visit(const DrawableBounds& bounds, double more, Visit see) {
        const double radius = (bounds.radius + more) * length(light_.cascades.x);
        const auto [x0, x1] = range(light_.cascades.x, bounds.center, radius);
        const auto [y0, y1] = range(light_.cascades.y, bounds.center, radius);
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

// Calls see(previous, now) for the bounds of each drawable that moved and exists.
template <class See>
void for_each_moved(const DrawableMask& moved, const PerDrawable<DrawableBounds>& previous,
                    const PerDrawable<DrawableBounds>& now, See see) {
    for (std::size_t i = 0; i < now.bodies.size(); ++i)
        if (moved.bodies[i] != 0 && now.bodies[i].exists()) see(previous.bodies[i], now.bodies[i]);
    for (std::size_t i = 0; i < now.cords.size(); ++i)
        if (moved.cords[i] != 0) see(previous.cords[i], now.cords[i]);
}

// Drawables in front of the near plane are clamped to the nearest depth, which closed tiles have as well.
bool too_near(const FrameContext& frame) {
    const Camera& camera = frame.camera;
    const double limit = 1.01 * frame.near_distance;
    for (std::size_t i = 0; i < frame.drawables.bodies.size(); ++i) {
        const DrawableBounds& bounds = frame.drawables.bodies[i];
        if (!bounds.exists() || !camera.sees(bounds.center, bounds.radius)) continue;
        if (least_depth(frame.scene.bodies[i], frame.snapshot.bodies[i], {bounds.center, bounds.radius}, camera) <
            limit)
            return true;
    }
    return std::any_of(frame.drawables.cords.begin(), frame.drawables.cords.end(), [&](const DrawableBounds& bounds) {
        return camera.sees(bounds.center, bounds.radius) && bounds.center.dot(camera.forward()) - bounds.radius < limit;
    });
}

}  // namespace

Damage DamageTracker::find(const FrameContext& frame, const Visibility& visible, const AmbientOcclusion& occlusion,
                           const std::vector<Rectangle>& reflected) {
    Damage damage(frame);
    find_moved(frame, damage);
    // If many bodies move, computing the damage would cost more than a full redraw.
    const auto moved = std::count(moved_.bodies.begin(), moved_.bodies.end(), char(1)) +
                       std::count(moved_.cords.begin(), moved_.cords.end(), char(1));
    if (options_.full_redraw || damage.background || moved > most_moved || frame.cascades != previous_cascades_ ||
        occlusion.changes().plane_tiles_moved || too_near(frame))
        damage.tiles.mark_all();
    else
        mark_tiles(frame, visible, occlusion.changes(), damage.tiles);
    for (const Rectangle& rectangle : reflected) damage.tiles.mark(rectangle);
    damage.changed = damage.tiles.rectangles();
    if (previous_tiles_) damage.previous = previous_tiles_->rectangles_outside(damage.tiles);
    select(frame, damage);
    for (const PlanePatch& plane : frame.planes)
        damage.plane_regions.push_back(
            frame.scene.bodies[plane.body].reflection > 0.0f  // reflections may be anywhere
                ? damage.changed
                : find_dirty_regions(plane, frame, visible.cover, occlusion.atlas(), damage.tiles));
    previous_drawables_ = frame.drawables;
    previous_tiles_ = damage.tiles;
    previous_near_distance_ = frame.near_distance;
    previous_cascades_ = frame.cascades;
    return damage;
}

void DamageTracker::find_moved(const FrameContext& frame, Damage& damage) {
    const bool everything = frame.anew || frame.camera_moved;
    damage.background =
        everything || frame.near_distance != previous_near_distance_ || frame.lamp_map;  // its shadows may be anywhere
    if (everything || options_.full_redraw || frame.cascades != previous_cascades_) damage.shadow_tiles.mark_all();
    moved_.bodies = everything ? std::vector<char>(frame.moved.size(), 1) : frame.moved;
    moved_.cords.clear();
    for (const CordDescription& cord : frame.scene.cords) {
        const bool anchor_moved = cord.anchor_body && moved_.bodies[*cord.anchor_body] != 0;
        moved_.cords.push_back(anchor_moved ? char(1) : moved_.bodies[cord.body]);
    }
    for (const std::size_t plane : frame.scene.planes)
        if (moved_.bodies[plane] != 0) damage.background = true;
    if (everything) return;
    for_each_moved(moved_, previous_drawables_, frame.drawables,
                   [&](const DrawableBounds& previous, const DrawableBounds& now) {
                       damage.shadow_tiles.mark(previous);
                       damage.shadow_tiles.mark(now);
                   });
    damage.shadow_tiles.settle();
}

void DamageTracker::mark_tiles(const FrameContext& frame, const Visibility& visible, const OcclusionChanges& occlusion,
                               DirtyTiles& tiles) const {
    mark_moved(frame, tiles);
    if (frame.scene.light.shadows) mark_shadow_receivers(frame, visible, tiles);
    mark_occlusion(frame, occlusion, tiles);
}

// Marks the drawables that moved, with their shadows and their occlusion on planes, at both poses.
void DamageTracker::mark_moved(const FrameContext& frame, DirtyTiles& tiles) const {
    const ShadowLight light(frame.scene.light, frame.cascades);
    const double blur = 1.5 * frame.scene.plane_cell;
    const auto mark = [&](const DrawableBounds& bounds, double ao_radius) {
        tiles.mark_hull(bounds.corners());
        for (const PlanePatch& plane : frame.planes)
            mark_on_plane(plane, bounds, {ao_radius, blur}, light, frame.camera, tiles);
    };
    for (std::size_t i = 0; i < moved_.bodies.size() && !tiles.all(); ++i) {
        if (moved_.bodies[i] == 0 || !frame.drawables.bodies[i].exists()) continue;
        mark(previous_drawables_.bodies[i], frame.scene.bodies[i].ao_radius);
        mark(frame.drawables.bodies[i], frame.scene.bodies[i].ao_radius);
    }
    for (std::size_t i = 0; i < moved_.cords.size(); ++i) {
        if (moved_.cords[i] == 0) continue;
        mark(previous_drawables_.cords[i], 0.0);
        mark(frame.drawables.cords[i], 0.0);
    }
}

// Marks the surfaces with changed occlusion. With several samples, the pixel center may be outside the face and use a
// texel at its border, so faces and lightmaps are marked as a whole.
void DamageTracker::mark_occlusion(const FrameContext& frame, const OcclusionChanges& occlusion,
                                   DirtyTiles& tiles) const {
    const std::vector<DrawableBounds>& bodies = frame.drawables.bodies;
    for (const OcclusionChanges::Body& changed : occlusion.bodies) {
        if (moved_.bodies[changed.body] != 0) continue;
        if (changed.faces == 0) tiles.mark_hull(bodies[changed.body].corners());
        for (int face = 0; face < 6; ++face)
            if ((changed.faces >> face & 1) != 0) tiles.mark_hull(bodies[changed.body].face(face));
    }
    for (const OcclusionChanges::Patch& patch : occlusion.patches) {
        if (moved_.bodies[patch.body] != 0 || tiles.all()) continue;
        const BodyState& state = frame.snapshot.bodies[patch.body];
        const Vec3 center = frame.camera.relative(state.origin) + state.orientation * patch.bounds.center();
        tiles.mark_hull(frame.one_sample
                            ? box_corners(center, state.orientation.toRotationMatrix(), 0.5 * patch.bounds.extent())
                            : bodies[patch.body].corners());
    }
}

// Marks drawables that stand still behind one that moved, as seen from the sun.
void DamageTracker::mark_shadow_receivers(const FrameContext& frame, const Visibility& visible,
                                          DirtyTiles& tiles) const {
    const ShadowLight light(frame.scene.light, frame.cascades);
    LightCells cells{light};
    for_each_moved(moved_, previous_drawables_, frame.drawables,
                   [&](const DrawableBounds& previous, const DrawableBounds& now) {
                       cells.add(previous);
                       cells.add(now);
                   });
    std::vector<FaceDamage> faces;
    std::vector<VolumeDamage> volumes;
    for (std::size_t i = 0; i < frame.drawables.bodies.size(); ++i) {
        const DrawableBounds& bounds = frame.drawables.bodies[i];
        if (moved_.bodies[i] != 0 || !bounds.exists() || !visible.bodies[i] || !cells.shadows(bounds)) continue;
        const RenderBody& proxy = frame.scene.bodies[i];
        const bool large = (proxy.large_receiver || proxy.lightmap >= 0) && frame.one_sample &&
                           FaceDamage::suits(bounds, frame.cascades);
        if (!large)
            tiles.mark_hull(bounds.corners());
        else if (proxy.kind == DrawKind::box)
            faces.emplace_back(bounds, visible.faces[i], light, frame.camera);
        else
            volumes.emplace_back(bounds, proxy, frame, frame.snapshot.bodies[i], light);
    }
    for (std::size_t i = 0; i < frame.drawables.cords.size(); ++i) {
        const DrawableBounds& bounds = frame.drawables.cords[i];
        if (moved_.cords[i] == 0 && cells.shadows(bounds)) tiles.mark_hull(bounds.corners());
    }
    if (faces.empty() && volumes.empty()) return;
    for_each_moved(moved_, previous_drawables_, frame.drawables,
                   [&](const DrawableBounds& previous, const DrawableBounds& now) {
                       if (tiles.all()) return;
                       for (const FaceDamage& box : faces) {
                           box.mark_shadow(previous, tiles);
                           box.mark_shadow(now, tiles);
                       }
                       for (const VolumeDamage& volume : volumes) {
                           volume.mark_shadow(previous, tiles);
                           volume.mark_shadow(now, tiles);
                       }
                   });
}

// Fills in the masks of the drawables that the dirty tiles and shadow tiles need.
void DamageTracker::select(const FrameContext& frame, Damage& damage) const {
    const Vec3 light = frame.scene.light.direction.normalized();
    const bool all_shadows = damage.shadow_tiles.all();
    const auto is_drawn = [&](const DrawableBounds& bounds) {
        return bounds.exists() && (damage.tiles.all() || damage.tiles.touched_by(bounds.corners())) ? 1 : 0;
    };
    const auto casts = [&](const DrawableBounds& bounds) {
        return bounds.exists() && (all_shadows || damage.shadow_tiles.touched_by(bounds)) &&
                       frame.camera.sees_swept(bounds.center, bounds.radius, light)
                   ? 1
                   : 0;
    };
    for (const DrawableBounds& bounds : frame.drawables.bodies) {
        damage.drawn.bodies.push_back(char(is_drawn(bounds)));
        damage.casters.bodies.push_back(char(casts(bounds)));
    }
    for (const DrawableBounds& bounds : frame.drawables.cords) {
        damage.drawn.cords.push_back(char(is_drawn(bounds)));
        damage.casters.cords.push_back(char(casts(bounds)));
    }
    if (frame.scene.light.shadows && !options_.keep_casters)
        drop_hidden_casters(frame.scene, frame.drawables, frame.cascades, damage.casters);
}

}  // namespace tumble
