// The shaders that draw casters into a shadow map.
#pragma once

#include "render/gl/gl_device.h"
#include "render/mesh/gpu_mesh_cache.h"

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace tumble {

class CasterPrograms {
public:
    /// `defines`: of the map's kind.
    CasterPrograms(GlDevice& device, const std::filesystem::path& shaders, std::vector<std::string> defines);

    /// The shader of opaque casters.
    const ShaderProgram& solid() const { return solid_; }

    /// Draws the casters; sets `far_map`, where the shaders have it.
    void draw(const GpuMeshCache& meshes, const std::vector<Batch>& casters, int far_map) const;

private:
    const ShaderProgram& make(const char* fragment, const std::vector<std::string>& more) const;

    GlDevice* device_;
    std::filesystem::path shaders_;
    std::vector<std::string> defines_;
    const ShaderProgram& solid_;
    struct Sieves {
        const ShaderProgram &plain, &painted;
    };
    mutable std::optional<Sieves> sieves_;  // of casters that light passes in part; made at their first use
};

}  // namespace tumble
