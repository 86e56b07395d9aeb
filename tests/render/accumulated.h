// The picture that a frame should be: the mean of many with one sample a pixel, each displaced by a part of a pixel. It
// has the same shading, so that it differs where a picture is aliased.
#pragma once

#include "core/image.h"
#include "scene/description/description.h"
#include "sim/snapshot/snapshot.h"

#include <array>

namespace tumble {

/// The mean of side x side pictures.
Image accumulated(const SceneDescription& scene, const Snapshot& snapshot, int side);

struct Unlikeness {
    double mean_flip = 0.0;
    int largest = 0;             // difference of a channel, levels of 255
    std::array<int, 3> above{};  // pixels that differ by more than 16, 32 and 64 levels
    static constexpr std::array<int, 3> limits{16, 32, 64};
};
Unlikeness unlikeness(const Image& reference, const Image& picture);

}  // namespace tumble
