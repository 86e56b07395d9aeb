// Shaders of bodies by kind of mesh, and the bindings that all shaders share.
#pragma once

#include "render/gl/gl_device.h"
#include "render/mesh/gpu_mesh_cache.h"
#include "render/shadow/shadow_cascades.h"

#include <array>
#include <filesystem>
#include <functional>
#include <map>
#include <string>
#include <utility>
#include <vector>

namespace tumble {

/// Texture units of all draws.
inline constexpr GLuint shadow_unit = 0, occlusion_unit = 1, reflection_unit = 8, lamp_shadow_unit = 11;

/// Preprocessor definitions for shaders with shadow lookups.
std::vector<std::string> shadow_defines(const ShadowFilter& filter);

/// Connects a program's samplers and blocks to them.
void connect(const ShaderProgram& program);

/// Shaders by look: the shape's own look, grids and checkers that darken, then RenderScene::looks by kind.
inline constexpr std::size_t look_shaders = 11;
/// Preprocessor definitions of a look.
std::vector<std::string> look_defines(const SurfaceLook& look);
/// Preprocessor definitions of features: bits of surface_feature and SurfaceMaps.
std::vector<std::string> feature_defines(unsigned features);
/// The features of a body.
unsigned features_of(const RenderBody& proxy, const RenderScene& scene);

class BodyPass {
public:
    /// Compiles the shaders that the scene's bodies need; those for bodies that span cascades on first use.
    BodyPass(GlDevice& device, const std::filesystem::path& shaders, const RenderScene& scene,
             const ShadowFilter& filter);

    void draw(const GpuMeshCache& meshes, const std::vector<Batch>& batches);
    /// The same of translucent batches, over the surfaces that are drawn already.
    void draw_over(const GpuMeshCache& meshes, const std::vector<Batch>& batches);

    /// One draw of one instance per shader, if there is an instance, which makes the driver compile the shader. The
    /// caller must prevent it from changing the frame.
    std::vector<std::function<void()>> compilations(const GpuMeshCache& meshes, const std::vector<Batch>& batches);

private:
    struct Variant {
        DrawKind kind;
        bool patterned, lit, spans_cascades, charted, painted;
        std::size_t look;  // index into RenderScene::looks
        unsigned features = 0;
    };
    static Variant variant_of(const Batch& batch);
    std::size_t index_of(const Variant& variant) const;
    const ShaderProgram& program(const Variant& variant);

    GlDevice* device_;
    std::filesystem::path shaders_;
    bool shadows_;
    ShadowFilter filter_;
    bool metal_boxes_ = false;  // highlights on their bevels flicker without filtering
    // By kind, light, look and cascade span; null: not yet used.
    std::array<const ShaderProgram*, 14 * look_shaders> programs_{};
    std::map<std::pair<std::size_t, unsigned>, const ShaderProgram*> with_features_;  // by index and features
    std::vector<SurfaceLook> looks_;
    std::vector<std::string> scene_defines_;
};

}  // namespace tumble
