// A picture over all frames of a clip, in one of their corners.
#pragma once

#include "scene/description/frame_corner.h"
#include "scene/description/mesh_paint.h"

#include <memory>

namespace tumble {

struct LogoDescription {
    std::shared_ptr<const Texture> image;  // never null
    FrameCorner corner = FrameCorner::top_right;
    double width = 0.15;   // share of the width of the frame
    double margin = 0.03;  // to the edges of the frame, share of its height
    double opacity = 1.0;
};

}  // namespace tumble
