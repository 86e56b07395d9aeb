// The state of a clip just before one of its frames is made: all that the frame and its successors depend on.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

namespace tumble {

/// The state of a panel. A panel that has ended keeps the state before its last frame; only its poses go on.
struct PanelState {
    std::vector<std::byte> simulation;  // World, FrameSequence
    std::vector<std::byte> overlay;     // OverlayBuilder; none without an overlay
    std::vector<std::byte> poses;       // PoseFilter

    template <class Archive, class Self>
    static void visit(Archive& archive, Self& self) {
        auto& [simulation, overlay, poses] = self;
        archive.keep(simulation, overlay, poses);
    }
};

struct ClipState {
    std::int64_t frame = 0;  // the next one
    std::vector<PanelState> panels;

    template <class Archive, class Self>
    static void visit(Archive& archive, Self& self) {
        auto& [frame, panels] = self;
        archive.any(frame);
        archive.keep(panels);
    }
};

}  // namespace tumble
