// The occlusion atlas on the graphics side.
#pragma once

#include "render/gl/gl_object.h"
#include "render/ambient_occlusion/occlusion_atlas.h"

#include <vector>

namespace tumble {

class OcclusionTexture {
public:
    explicit OcclusionTexture(const GlFunctions& gl);

    /// Sends the rows that changed since the last time (all of them, when there are more rows than ever).
    void upload(const OcclusionAtlas& atlas, int first_row, int end_row);

    GLuint name() const { return texture_.name(); }

    /// Rows that the texture has: at least the last atlas' height.
    int height() const { return height_; }

private:
    void send(const OcclusionAtlas& atlas, int first_row, int end_row, int columns);

    const GlFunctions* gl_;
    GlObject texture_;
    int height_ = 0, filled_ = 0;  // rows
    int columns_ = 0;              // of the windows, that were sent
    std::vector<float> shares_;    // on their way
};

}  // namespace tumble
