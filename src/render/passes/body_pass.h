// The shaders of bodies by kind of mesh, and the places where all shaders find what they share.
#pragma once

#include "render/mesh/gpu_mesh_cache.h"
#include "render/gl/shader_program.h"
#include "render/shadow/shadow_cascades.h"

#include <array>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

namespace tumble {

/// The uniform block and the texture units of everything drawn.
inline constexpr GLuint frame_block = 0;
inline constexpr GLuint shadow_unit = 0, occlusion_unit = 1;

/// What the shaders that look for shadows must have defined.
std::vector<std::string> shadow_defines(const ShadowFilter& filter);

/// Ties a program's samplers and blocks to them.
void connect(const ShaderProgram& program);

class BodyPass {
public:
    /// Compiles what the scene's bodies need; the shaders of wide ones when there first is such a one.
    BodyPass(const GlFunctions& gl, const std::filesystem::path& shaders, const RenderScene& looks,
                    bool has_cords, bool shadows, const ShadowFilter& filter);

    void draw(const GpuMeshCache& meshes, const std::vector<Batch>& batches);

    /// For each shader a draw of one instance, where there is one, that has it compiled. The caller sees to it that nothing
    /// of it lands in the picture.
    std::vector<std::function<void()>> compilations(const GpuMeshCache& meshes, const std::vector<Batch>& batches);

private:
    struct Variant {
        DrawKind kind;
        bool patterned, lit, wide, charted;
    };
    static Variant variant_of(const Batch& batch);
    static std::size_t index_of(const Variant& variant);
    const ShaderProgram& program(const Variant& variant);

    const GlFunctions* gl_;
    std::filesystem::path shaders_;
    bool shadows_;
    ShadowFilter filter_;
    bool metal_boxes_ = false;   // highlights on bevels glitter where they are not filtered
    std::array<std::optional<ShaderProgram>, 20> programs_;  // by kind, pattern, light and width
};

}  // namespace tumble
