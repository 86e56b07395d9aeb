// Which tiles of the picture the movements since the last frame may have changed. A moved body is drawn anew where it was
// and where it is; so is the ground under its old and new shadow and within its darkening, every body that lies behind it
// as the sun sees it, and every surface whose darkening has other values than before. Of grounds and of what has a fine
// surface not the whole, but the shadows on them (face_marks.h, volume_marks.h) and the texels that changed. What holds for
// the whole picture (the depths' range, the shadow maps' place, a plane that moved) changes everything.
// Only ever too much is marked: the frame has the bytes of a full redraw.
#pragma once

#include "render/scene/drawable_bounds.h"
#include "render/damage/face_damage.h"
#include "render/ambient_occlusion/occlusion_atlas.h"
#include "render/scene/plane_patch.h"
#include "render/shadow/shadow_cascades.h"
#include "render/damage/shadow_dirty_tiles.h"
#include "render/damage/dirty_tiles.h"

#include <vector>

namespace tumble {

/// What of a frame can change.
struct FrameState {
    const Snapshot& snapshot;
    std::vector<DrawableBounds> items;
    double near_distance = 0.0;   // m
    ShadowCascades shadows;
    std::vector<PlanePatch> planes;
    bool one_sample = false;   // a pixel: what it shows lies at its middle
};

class DamageTracker {
public:
    DamageTracker(const SceneDescription& scene, const RenderScene& looks, const Camera& view);

    /// Are all poses those of the last find()? Then the picture is the same.
    bool unmoved(const Snapshot& snapshot) const;

    /// The next find() finds everything changed, as the first one does: the view is another.
    void forget() { first_ = true; }

    /// Compares with the state of the call before, and remembers this one.
    DirtyTiles find(const FrameState& now, const OcclusionChanges& occlusion, const Visibility& visibility);

    /// What of the shadow maps the last find() found changed.
    const ShadowDirtyTiles& shadow_marks() const { return shadow_marks_; }
    /// Did the planes or the depths' range?
    bool background_changed() const { return background_changed_; }

private:
    struct Pose {
        Vec3 origin;
        Quat orientation;
    };
    bool moved(const Snapshot& snapshot, std::size_t body) const;
    void mark_on_planes(const DrawableBounds& item, std::size_t number, const FrameState& now, DirtyTiles& marks) const;
    bool too_near(const FrameState& now) const;
    void mark_shadowed(const std::vector<char>& item_moved, const FrameState& now, const Visibility& visibility,
                       DirtyTiles& marks) const;

    const SceneDescription* scene_;
    const RenderScene* looks_;
    const Camera* view_;
    bool first_ = true, background_changed_ = true;
    ShadowDirtyTiles shadow_marks_{ShadowCascades()};
    std::vector<Pose> poses_;
    std::vector<DrawableBounds> items_;
    double near_distance_ = 0.0;
    ShadowCascades shadows_;
};

}  // namespace tumble
