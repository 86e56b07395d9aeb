#include "render/environment/environment_textures.h"

#include "scene/environment/irradiance.h"
#include "scene/environment/mirror_map.h"

#include <glm/vec4.hpp>

#include <cmath>

namespace tumble {
namespace {

/// The layout of shaders/environment_block.glsl.
struct Values {
    std::array<glm::vec4, 9> around{};
    glm::vec4 low{0.0f}, high{0.0f}, sun{1.0f};
};

glm::vec4 linear(Color color) {
    const std::array<double, 3> light = to_linear(color);
    return {float(light[0]), float(light[1]), float(light[2]), 0.0f};
}

/// Half floats: as exact as light needs to be, and wide enough for lamps.
GlObject texture_of(const GlFunctions& gl, int width, int height, GLenum format, const float* texels) {
    GlObject texture(gl, GlKind::texture);
    gl.BindTexture(GL_TEXTURE_2D, texture.name());
    const auto set = [&](GLenum parameter, GLint value) { gl.TexParameteri(GL_TEXTURE_2D, parameter, value); };
    set(GL_TEXTURE_MIN_FILTER, GL_LINEAR);
    set(GL_TEXTURE_MAG_FILTER, GL_LINEAR);
    set(GL_TEXTURE_WRAP_S, GL_REPEAT);
    set(GL_TEXTURE_WRAP_T, GL_CLAMP_TO_EDGE);
    set(GL_TEXTURE_MAX_LEVEL, 0);
    gl.TexImage2D(GL_TEXTURE_2D, 0, GL_RGBA16F, width, height, 0, format, GL_FLOAT, texels);
    return texture;
}

}  // namespace

EnvironmentTextures::EnvironmentTextures(const GlFunctions& gl, const RenderScene& scene) : gl_(&gl) {
    if (!scene.environment) return;
    const EnvironmentDescription& environment = *scene.environment;
    Values values;
    values.low = linear(environment.low);
    values.high = linear(environment.high);
    values.low.w = float(environment.rotation / 360.0 - std::floor(environment.rotation / 360.0));
    for (int c = 0; c < 3; ++c) values.sun[c] = float(environment.sun[std::size_t(c)]);
    if (environment.image) {
        const Irradiance irradiance = irradiance_of(environment);
        for (std::size_t i = 0; i < irradiance.size(); ++i)
            values.around[i] = {irradiance[i][0], irradiance[i][1], irradiance[i][2], 0.0f};
        const MirrorMap mirror = make_mirror_map(environment);
        mirror_.emplace(texture_of(gl, MirrorMap::width, MirrorMap::height, GL_RGBA, mirror.texels.front().data()));
        if (environment.background == BackgroundKind::image) {
            const EnvironmentImage image = blurred_background(environment);
            background_.emplace(texture_of(gl, image.width, image.height, GL_RGB, image.texels.front().data()));
        }
    }
    values_.emplace(gl, GlKind::buffer);
    gl.BindBuffer(GL_UNIFORM_BUFFER, values_->name());
    gl.BufferData(GL_UNIFORM_BUFFER, sizeof values, &values, GL_STATIC_DRAW);
}

void EnvironmentTextures::bind() const {
    if (!values_) return;
    gl_->BindBufferBase(GL_UNIFORM_BUFFER, environment_block, values_->name());
    const auto use = [&](GLuint unit, const std::optional<GlObject>& texture) {
        gl_->ActiveTexture(GL_TEXTURE0 + unit);
        if (texture) gl_->BindTexture(GL_TEXTURE_2D, texture->name());
    };
    use(mirror_unit, mirror_);
    use(background_unit, background_);
    gl_->ActiveTexture(GL_TEXTURE0);
}

}  // namespace tumble
