// The occluder grid as buffer textures.
#pragma once

#include "render/gl_object.h"
#include "render/occluders.h"

namespace tumble {

class OcclusionBuffers {
public:
    explicit OcclusionBuffers(const GlFunctions& gl);

    void upload(const OccluderGrid& grid) const;

    /// Binds the textures of occluders and cells to two texture units.
    void bind(GLuint occluders_unit, GLuint cells_unit) const;

private:
    const GlFunctions* gl_;
    GlObject occluders_, cells_, occluders_texture_, cells_texture_;
};

}  // namespace tumble
