// Damage: the tiles of the frame that movements since the previous frame may have changed. A moved body damages:
// - the tiles at its old and new pose;
// - the planes in its old and new shadow and within its AO radius;
// - every body behind it as seen from the sun;
// - every surface with changed AO.
// Large receivers and bodies with lightmaps are damaged only in the shadows on them (receiver_damage.h) and in the
// changed texels. A change of the depth range, of the cascades or of a plane damages the whole frame. The
// damage is conservative: the frame has the bytes of a full redraw.
#pragma once

#include "render/ambient_occlusion/occlusion_atlas.h"
#include "render/culling/occlusion_culling.h"
#include "render/damage/dirty_tiles.h"
#include "render/frame/frame_context.h"

#include <optional>
#include <vector>

namespace tumble {

struct Damage {
    explicit Damage(const FrameContext& frame) : tiles(frame.camera), shadow_tiles(frame.cascades) {}

    DirtyTiles tiles;
    ShadowDirtyTiles shadow_tiles;
    bool background = true;           // the planes or the depth range changed
    std::vector<Rectangle> changed;   // the dirty tiles
    std::vector<Rectangle> previous;  // tiles that were dirty in the previous frame and are not in this one
    DrawableMask drawn;               // drawables to draw again: they touch a dirty tile
    DrawableMask casters;             // drawables to draw again into the shadow maps
    std::vector<std::vector<Rectangle>> plane_regions;  // of each plane in view, see find_dirty_regions()
};

struct DamageOptions {
    bool full_redraw = false;   // everything is damaged in every frame
    bool keep_casters = false;  // without culling of shadow casters
};

class DamageTracker {
public:
    explicit DamageTracker(const DamageOptions& options = {}) : options_(options) {}

    /// Compares with the frame of the previous call, and stores this one. `visible`: the drawn bodies. `reflected`:
    /// where the image of mirrored bodies changed.
    Damage find(const FrameContext& frame, const Visibility& visible, const AmbientOcclusion& occlusion,
                const std::vector<Rectangle>& reflected = {});

private:
    void find_moved(const FrameContext& frame, Damage& damage);
    void mark_tiles(const FrameContext& frame, const Visibility& visible, const OcclusionChanges& occlusion,
                    DirtyTiles& tiles) const;
    void mark_moved(const FrameContext& frame, DirtyTiles& tiles) const;
    void mark_occlusion(const FrameContext& frame, const OcclusionChanges& occlusion, DirtyTiles& tiles) const;
    void mark_shadow_receivers(const FrameContext& frame, const Visibility& visible, DirtyTiles& tiles) const;
    void select(const FrameContext& frame, Damage& damage) const;

    DamageOptions options_;
    DrawableMask moved_;  // of this frame
    PerDrawable<DrawableBounds> previous_drawables_;
    std::optional<DirtyTiles> previous_tiles_;
    double previous_near_distance_ = 0.0;  // m
    ShadowCascades previous_cascades_;
};

}  // namespace tumble
