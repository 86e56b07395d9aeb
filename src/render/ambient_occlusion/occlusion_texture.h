// The AO atlas as an OpenGL texture.
#pragma once

#include "render/ambient_occlusion/occlusion_atlas.h"
#include "render/gl/gl_object.h"

#include <vector>

namespace tumble {

class OcclusionTexture {
public:
    explicit OcclusionTexture(const GlFunctions& gl);

    /// Uploads the rows that changed since the last call; all of them if the texture grew.
    void upload(const OcclusionAtlas& atlas, int first_row, int end_row);

    GLuint name() const { return texture_.name(); }

    /// Rows of the texture: at least the height of the last atlas.
    int height() const { return height_; }

private:
    void send(const OcclusionAtlas& atlas, int first_row, int end_row, int columns);

    const GlFunctions* gl_;
    GlObject texture_;
    int height_ = 0, filled_ = 0;  // rows
    int columns_ = 0;              // columns of plane tiles that were uploaded
    std::vector<float> shares_;    // staging buffer
};

}  // namespace tumble
