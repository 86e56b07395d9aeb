// The state of a clip just before one of its frames is made: all that the frame and its successors depend on.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

namespace tumble {

struct ClipState {
    std::int64_t frame = 0;                      // the next one
    std::vector<std::vector<std::byte>> panels;  // PanelRun, at that frame or at the panel's last one
    std::vector<std::vector<std::byte>> poses;   // by panel: PoseFilter

    template <class Archive, class Self>
    static void visit(Archive& archive, Self& self) {
        auto& [frame, panels, poses] = self;
        archive.keep(frame, panels, poses);
    }
};

}  // namespace tumble
