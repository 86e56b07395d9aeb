// Differences between the bodies of two records of a panel.
#pragma once

#include "app/causes/motion_record.h"
#include "app/causes/panel_view.h"

#include <string>
#include <utility>
#include <vector>

namespace tumble {

// -- Differences of described values.

struct ValueDifference {
    std::string key, before, after;  // empty: the value is missing
};

std::vector<ValueDifference> value_differences(const ValueMap& before, const ValueMap& after);

/// "0.5 to 0.8"; "changed" for values that cannot be shown.
std::string value_change_text(const std::string& before, const std::string& after);

// A cause of a difference between two images.

struct Cause {
    std::string text;     // "crate.17 moved by 3 px (first differing frame 41)"
    double pixels = 0.0;  // estimate of the pixels that it changes: the order of causes
};

/// The bodies of two panels, by name.
struct BodyPairs {
    BodyPairs(const PanelRecord& before, const PanelRecord& after);
    std::vector<std::pair<std::size_t, std::size_t>> both;  // indices before and after
    std::vector<std::size_t> removed, added;
};

/// Bodies that are added or removed, and differences of shape, color, ...
std::vector<Cause> appearance_changes(const PanelView& before, const PanelView& after, const BodyPairs& pairs);

/// Differences of mass, restitution, friction, velocities of the start, ...: they have an effect only by the motion.
std::vector<Cause> matter_changes(const PanelView& before, const PanelView& after, const BodyPairs& pairs);

/// "crate.17 moved by 3 px (first differing frame 41, first differing contact at 0.68 s)", of each body that moved.
std::vector<Cause> motion_changes(const PanelView& before, const PanelView& after, const BodyPairs& pairs);

/// The same of bodies whose motion differs anywhere: "crate.17 moves differently (...)".
std::vector<Cause> run_changes(const PanelView& before, const PanelView& after, const BodyPairs& pairs);

}  // namespace tumble
