// The labels of a frame: their texts with the values of the bodies, and their places in the scene.
#pragma once

#include "overlay/overlay_frame.h"
#include "scene/description/description.h"
#include "sim/snapshot/snapshot.h"

#include <string>
#include <vector>

namespace tumble {

class BodyLabels {
public:
    /// `scene` must outlive it.
    explicit BodyLabels(const SceneDescription& scene);

    /// Appends the labels that are shown at the snapshot's time.
    void add(const Snapshot& snapshot, std::vector<OverlayCallout>& callouts) const;

private:
    struct Label {
        const LabelDescription* description;
        std::vector<LabelPiece> pieces;
        double above;  // m, from the center of mass, where the description has no offset
    };
    const SceneDescription* scene_;
    std::vector<Label> labels_;
};

/// The text at a moment. `name`: of the body; `time`: s.
std::string label_text(const std::vector<LabelPiece>& pieces, const BodyState& body, const std::string& name,
                       double time);

}  // namespace tumble
