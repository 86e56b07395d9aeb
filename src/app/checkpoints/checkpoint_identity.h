// The clip that checkpoints belong to: the scene and all settings of the clip that its state depends on, by name, so that a run
// that they do not fit says what differs.
#pragma once

#include <string>
#include <utility>
#include <vector>

namespace tumble {

struct ClipSetting {
    std::string name, value;  // as in "the size", "1280x720"; names are unique
    bool operator==(const ClipSetting&) const = default;

    template <class Archive, class Self>
    static void visit(Archive& archive, Self& self) {
        auto& [name, value] = self;
        archive.keep(name, value);
    }
};

/// The most telling ones first; the last one is a sum over all of the scene.
using CheckpointIdentity = std::vector<ClipSetting>;

/// "the size: 640x360 there, 1280x720 here" of the first setting that differs; empty if all are equal.
std::string difference(const CheckpointIdentity& there, const CheckpointIdentity& here);

}  // namespace tumble
