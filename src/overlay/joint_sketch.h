// The sketch of a joint for overlays: its anchor, axes and limits, as points that are fixed in bodies. Made once for a
// scene.
#pragma once

#include "overlay/overlay_frame.h"
#include "scene/description/description.h"
#include "sim/snapshot/snapshot.h"

#include <cstddef>
#include <optional>
#include <vector>

namespace tumble {

/// A point of a body (m, from its origin in its frame), or of the world.
struct SketchPoint {
    std::optional<std::size_t> body;
    Vec3 at;
    Vec3 in_world(const Snapshot& snapshot) const {
        if (!body) return at;
        const BodyState& state = snapshot.bodies[*body];
        return state.origin + state.orientation * at;
    }
};

struct SketchLine {
    std::vector<SketchPoint> points;
    bool limit = false;  // of a limit, otherwise of an axis
};

struct JointSketch {
    std::size_t joint = 0;
    MarkerShape marker = MarkerShape::disc;
    SketchPoint anchor;  // of the second body
    std::vector<SketchLine> lines;
    float allowance = 0.0f;  // m: surfaces of the joined bodies do not hide it
};

/// Sketches of all joints but gears that hold a body which overlays show.
std::vector<JointSketch> sketch_joints(const SceneDescription& scene);

}  // namespace tumble
