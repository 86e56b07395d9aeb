// Expands compounds: each part becomes a body of its own, so that all further code handles single shapes.
#pragma once

#include "scene/description/description.h"
#include "sim/snapshot/snapshot.h"

#include <cstddef>
#include <vector>

namespace tumble {

/// The scene with every compound replaced by its parts, in place; cords are attached to the first part.
SceneDescription expand_compounds(const SceneDescription& scene);

/// The poses of the bodies of an expanded scene.
class PartPoses {
public:
    /// For scenes without compounds.
    PartPoses() = default;
    /// `scene`: not expanded.
    explicit PartPoses(const SceneDescription& scene);

    /// The expanded snapshot. Valid until the next call, or as long as the argument.
    const Snapshot& snapshot(const Snapshot& whole);

private:
    struct Part {
        std::size_t body;              // index in the original scene
        Vec3 position = Vec3::Zero();  // body frame
        Quat rotation = Quat::Identity();
    };
    std::vector<Part> parts_;  // one per body of the expanded scene; empty without compounds
    Snapshot snapshot_;
};

}  // namespace tumble
