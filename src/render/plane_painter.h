// Draws the infinite planes, and the sky where nothing else is.
#pragma once

#include "render/gl_object.h"
#include "render/plane_patch.h"
#include "render/shader_program.h"

#include <filesystem>

namespace tumble {

class PlanePainter {
public:
    PlanePainter(const GlFunctions& gl, const std::filesystem::path& shaders);

    void draw(const SceneLooks& looks, const Snapshot& snapshot, const CameraView& view, double near_distance) const;
    void draw_sky() const;

private:
    void draw_patch(const PlanePatch& patch, const BodyLook& look) const;

    const GlFunctions* gl_;
    ShaderProgram plane_, sky_;
    GlObject array_, corners_;
};

}  // namespace tumble
