// Compounds as what is drawn of them: each part becomes a body of its own, so that everything behind draws single shapes.
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

    /// The scene with every compound replaced by its parts, at its own place in the list; cords are hung to the first.
    const SceneDescription& scene() const { return scene_; }
    /// Frees what scene() says of bodies; meshes live on. For whoever has made what it needs of them: 30 MB for 100,000.
    void forget_bodies();
    /// The snapshot that goes with it. Valid until the next call, or as long as the argument.
    const Snapshot& snapshot(const Snapshot& whole);

private:
    struct Part {
        std::size_t body;   // of the scene it was made from
        Vec3 position = Vec3::Zero();       // body frame
        Quat rotation = Quat::Identity();
    };
    SceneDescription scene_;
    std::set<std::shared_ptr<const MeshAsset>> assets_;   // of forgotten bodies
    std::vector<Part> parts_;   // one a drawn body; empty when there are no compounds
    Snapshot snapshot_;
};

}  // namespace tumble
