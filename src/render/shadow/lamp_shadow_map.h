// Depths as seen from the second light with shadows (lamp_map.h).
#pragma once

#include "render/gl/gl_device.h"
#include "render/gl/gl_object.h"
#include "render/shadow/caster_programs.h"

#include <filesystem>

namespace tumble {

class LampShadowMap {
public:
    LampShadowMap(GlDevice& device, const std::filesystem::path& shaders);

    /// Draws all casters. The block of the lamps is bound.
    void draw(const GpuMeshCache& meshes, const std::vector<Batch>& casters) const;

    GLuint texture() const { return texture_.name(); }

private:
    const GlFunctions* gl_;
    CasterPrograms programs_;
    GlObject texture_, framebuffer_;
};

}  // namespace tumble
