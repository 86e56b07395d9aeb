// The values that a reader of a live page may change: sliders and choices, checked before the page is written.
#pragma once

#include "scene/keys/overrides.h"

#include <filesystem>
#include <span>
#include <string>
#include <vector>

namespace tumble {

/// A slider, or a choice where it has `choices`. Numbers are decimal text: they reach the scene as they are shown.
struct LiveControl {
    std::string key;             // as of --set
    std::string label;           // empty: made from the key
    std::string unit;            // empty: that of a known key
    std::string min, max, step;  // all empty: made from the value of the scene
    std::vector<std::string> choices;
    std::string value;  // of the recorded run; empty: the scene does not give it
};

/// "KEY", "KEY=MIN:MAX:STEP" or "KEY=VALUE,VALUE...". Throws InputError.
LiveControl parse_live_control(const std::string& text);

/// Fills in empty members, and reads the scene with the ends, or with each choice. Throws InputError where it is not
/// valid with one of them, or where a control needs a range.
void complete_live_controls(std::span<LiveControl> controls, const std::string& scene_text,
                            const std::filesystem::path& file, const SceneOverrides& overrides);

struct LivePage {
    std::string name;                   // of the scene file, as the page shows it
    int source = 0;                     // index of the scene's text in the sources of the clip
    std::vector<std::string> settings;  // PATH=VALUE of the recorded run
    std::vector<LiveControl> controls;
    bool editor = true;  // the reader may change the scene's text
};

/// The attribute data-live of a player.
std::string live_json(const LivePage& page);

}  // namespace tumble
