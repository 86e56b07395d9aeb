// The scenes of a clip and the times that its frames show, as a command or a plan asks for them.
#pragma once

#include "app/composition/frame_layout.h"
#include "render/aov/aov_kind.h"
#include "scene/keys/overrides.h"

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace tumble {

struct ClipRequest {
    std::vector<std::filesystem::path> scenes;  // a panel for each
    std::optional<std::string> text;            // of the only scene, instead of its file's
    std::vector<std::string> vary;              // "PATH=VALUE,VALUE": a panel for each
    std::vector<std::string> labels;            // of the panels; empty: made from the names and values
    AovSet aovs;
    SceneOverrides overrides;
    PanelArrangement arrangement = PanelArrangement::automatic;
    std::optional<std::string> frames_range;  // "1-10,30-40:2": frames that are drawn; otherwise all
    double start = 0.0;                       // s, scene time; earlier frames are not drawn
    double speed = 1.0;                       // of the motion in the clip: 0.25 is slow motion
    bool own_speed = true;                    // with the changes of speed of the scenes
    bool sound = false;                       // the clip has the sound of its impacts
    int frame_step = 1;  // of the scene's frames one in so many is in the clip; the motion is the same
};

}  // namespace tumble
