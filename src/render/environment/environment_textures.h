// The light and background of a scene's environment in GPU memory.
#pragma once

#include "render/gl/gl_object.h"
#include "render/scene/render_scene.h"

#include <optional>

namespace tumble {

/// Uniform block and texture units of shaders/environment.glsl.
inline constexpr GLuint environment_block = 1;
inline constexpr GLuint mirror_unit = 9, background_unit = 10;

class EnvironmentTextures {
public:
    /// Fills the block and textures, if the scene has an environment.
    EnvironmentTextures(const GlFunctions& gl, const RenderScene& scene);

    /// For the draws that follow.
    void bind() const;

private:
    const GlFunctions* gl_;
    std::optional<GlObject> values_, mirror_, background_;
};

}  // namespace tumble
