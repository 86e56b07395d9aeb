// Expands compounds: each part becomes a body of its own, so that all further code handles single shapes.
#pragma once

#include "scene/description/description.h"
#include "sim/snapshot/snapshot.h"

#include <cstddef>
#include <memory>
#include <set>
#include <vector>

namespace tumble {

class CompoundExpansion {
public:
    explicit CompoundExpansion(const SceneDescription& scene);

    /// The scene with every compound replaced by its parts, in place; cords are attached to the first part.
    const SceneDescription& scene() const { return scene_; }
    /// Frees the bodies of scene(); meshes stay. For callers that need the bodies no longer: 30 MB for 100,000 bodies.
    void forget_bodies();
    /// The expanded snapshot. Valid until the next call, or as long as the argument.
    const Snapshot& snapshot(const Snapshot& whole);

private:
    struct Part {
        std::size_t body;              // index in the original scene
        Vec3 position = Vec3::Zero();  // body frame
        Quat rotation = Quat::Identity();
    };
    SceneDescription scene_;
    std::set<std::shared_ptr<const MeshAsset>> assets_;  // of freed bodies
    std::vector<Part> parts_;                            // one per drawn body; empty without compounds
    Snapshot snapshot_;
};

}  // namespace tumble
