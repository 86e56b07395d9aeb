// From the image as drawn, with surface ids in alpha, to the result: smooth where edges are known, and opaque or with
// the coverage by bodies as straight alpha.
#pragma once

#include "core/image.h"
#include "render/antialiasing/screen_edges.h"
#include "render/damage/damage_tracker.h"

#include <vector>

namespace tumble {

class Antialiasing {
public:
    struct Options {
        bool analytic = true;      // false leaves the image as drawn, with the samples of each pixel averaged
        bool transparent = false;  // alpha is coverage: without `analytic`, it is drawn instead of surface ids
    };
    /// `lods` must outlive it.
    Antialiasing(MeshLods& lods, int width, int height, const Options& options)
        : edges_(lods), drawn_(width, height), options_(options) {}

    bool analytic() const { return options_.analytic; }

    /// The image as drawn; to be updated in the changed regions of each frame.
    Image& drawn() { return drawn_; }

    /// Updates the changed regions of the result. `visible`: with hidden bodies left out, even if they were drawn.
    /// They have no edges: surfaces share ids, and one might be mistaken for the surface in front of it.
    void apply(const FrameContext& frame, const Damage& damage, const Visibility& visible, Image& result);

private:
    EdgeFinder edges_;
    Image drawn_;
    Options options_;
};

// Images with alpha. Only bodies are drawn, on black; the alpha of a pixel is the part of it that they cover. The edges
// of color and coverage are blended alike, so that the color is premultiplied (scaled by the coverage) until the end.

/// Copies the rectangles of the drawn image to the frame. `ids`: its alpha is a surface id (surface_ids.h), which
/// becomes the coverage of the pixel's center; otherwise it is the coverage.
void copy_coverage(const Image& drawn, const std::vector<Rectangle>& rectangles, bool ids, Image& frame);

/// Divides the colors in the rectangles of the frame by their coverage.
void make_alpha_straight(const std::vector<Rectangle>& rectangles, Image& frame);

}  // namespace tumble
