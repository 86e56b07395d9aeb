// Damage: the tiles of the frame that movements since the previous frame may have changed. A moved body damages:
// - the tiles at its old and new pose;
// - the planes in its old and new shadow and within its AO radius;
// - every body behind it as seen from the sun;
// - every surface with changed AO.
// Of large receivers and bodies with lightmaps, only the shadows on them (face_damage.h, volume_damage.h) and the
// changed texels are damaged. A change of the depth range, of the cascades or of a plane damages the whole frame. The
// damage is conservative: the frame has the bytes of a full redraw.
#pragma once

#include "render/ambient_occlusion/occlusion_atlas.h"
#include "render/damage/dirty_tiles.h"
#include "render/damage/face_damage.h"
#include "render/damage/shadow_dirty_tiles.h"
#include "render/scene/drawable_bounds.h"
#include "render/scene/plane_patch.h"
#include "render/shadow/shadow_cascades.h"

#include <vector>

namespace tumble {

/// The inputs of a frame that can change.
struct FrameState {
    const Snapshot& snapshot;
    std::vector<DrawableBounds> items;
    double near_distance = 0.0;  // m
    ShadowCascades shadows;
    std::vector<PlanePatch> planes;
    bool one_sample = false;  // per pixel, at its center
};

class DamageTracker {
public:
    DamageTracker(const SceneDescription& description, const RenderScene& scene, const Camera& view);

    /// True if all poses equal those of the previous find(); the frame is then the same.
    bool unmoved(const Snapshot& snapshot) const;

    /// Makes the next find() report everything as changed, as the first one does; for a changed view.
    void forget() { first_ = true; }

    /// Compares with the state of the previous call, and stores this one.
    DirtyTiles find(const FrameState& now, const OcclusionChanges& occlusion, const Visibility& visibility);

    /// Parts of the shadow maps that changed in the previous find().
    const ShadowDirtyTiles& shadow_damage() const { return shadow_damage_; }
    /// True if the planes or the depth range changed.
    bool background_changed() const { return background_changed_; }

private:
    struct Pose {
        Vec3 origin;
        Quat orientation;
    };
    bool moved(const Snapshot& snapshot, std::size_t body) const;
    void mark_on_planes(const DrawableBounds& item, std::size_t number, const FrameState& now, DirtyTiles& dirty) const;
    bool too_near(const FrameState& now) const;
    void mark_shadow_receivers(const std::vector<char>& item_moved, const FrameState& now, const Visibility& visibility,
                               DirtyTiles& dirty) const;

    const SceneDescription* description_;
    const RenderScene* scene_;
    const Camera* view_;
    bool first_ = true, background_changed_ = true;
    ShadowDirtyTiles shadow_damage_{ShadowCascades()};
    std::vector<Pose> poses_;
    std::vector<DrawableBounds> items_;
    double near_distance_ = 0.0;
    ShadowCascades shadows_;
};

}  // namespace tumble
