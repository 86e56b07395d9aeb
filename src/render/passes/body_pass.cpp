#include "render/passes/body_pass.h"

#include "render/shadow/shadow_map.h"

#include <fmt/format.h>

#include <algorithm>

namespace tumble {
std::vector<std::string> shadow_defines(const ShadowFilter& filter) {
    std::vector<std::string> all = {fmt::format("SHADOW_TEXELS {}.0", shadow_map_texels)};
    if (filter.by_pixel)
        for (const std::string& define :
             {std::string("PIXEL_SHADOWS"), fmt::format("LEAST_STEP {:.2f}", least_pixel_step),
              fmt::format("MOST_STEP {:.2f}", most_pixel_step)})
            all.push_back(define);
    return all;
}

std::vector<std::string> look_defines(const SurfaceLook& look) {
    if (look.pattern == Pattern::panel) return {};
    if (look.image.texture) return {"PLAIN", "IMAGE"};
    if (look.pattern == Pattern::plain) return {"PLAIN"};
    return {"PLAIN", fmt::format("TWO_COLORS {}", int(look.pattern))};
}

void connect(const ShaderProgram& program) {
    program.set_block("Frame", frame_block);
    program.set_sampler("shadow_map", GLint(shadow_unit));
    program.set_sampler("occlusion_atlas", GLint(occlusion_unit));
    program.set_sampler("mesh_texture", GLint(paint_unit));
}

BodyPass::BodyPass(GlDevice& device, const std::filesystem::path& shaders, const RenderScene& scene,
                   const ShadowFilter& filter)
    : device_(&device), shaders_(shaders), shadows_(scene.light.shadows), filter_(filter), looks_(scene.looks) {
    for (const RenderBody& proxy : scene.bodies)
        if (proxy.kind == DrawKind::box && proxy.metallic > 0.0f) metal_boxes_ = true;
    for (const RenderBody& proxy : scene.bodies)
        if (proxy.solid())
            for (const bool lit : {true, false})
                program({proxy.kind, proxy.pattern != Pattern::panel, lit, false,
                         proxy.kind == DrawKind::mesh && proxy.lightmap >= 0,
                         proxy.kind == DrawKind::mesh && scene.meshes[proxy.mesh].paint != nullptr, proxy.look});
    if (!scene.cords.empty()) program({DrawKind::mesh, false, true, false, false, false, 0});
}

BodyPass::Variant BodyPass::variant_of(const Batch& batch) {
    const DrawKind kind = batch.mesh == face_mesh      ? DrawKind::box
                          : batch.mesh < cylinder_mesh ? DrawKind::ball
                                                       : DrawKind::mesh;
    return {kind, batch.patterned, batch.lit, batch.spans_cascades, batch.charted, batch.painted, batch.look};
}

std::size_t BodyPass::index_of(const Variant& variant) const {
    const std::size_t which = variant.kind == DrawKind::box ? (variant.lit ? 0 : 1)
                              : variant.kind == DrawKind::ball
                                  ? 2
                                  : 3 + (variant.charted ? 1 : 0) + (variant.painted ? 2 : 0);
    const SurfaceLook& look = looks_[variant.look];
    const std::size_t shader = variant.look == 0    ? (variant.patterned ? 1 : 0)
                               : look.image.texture ? look_shaders - 1
                                                    : 1 + std::size_t(look.pattern);
    return 2 * (look_shaders * which + shader) + (variant.spans_cascades ? 1 : 0);
}

const ShaderProgram& BodyPass::program(const Variant& variant) {
    const ShaderProgram*& made = programs_[index_of(variant)];
    if (made != nullptr) return *made;
    ShaderFiles files = {"body.vert", "mesh.frag", {"MESH"}};
    if (variant.kind == DrawKind::box) files = {"body.vert", "box.frag", {"BOX"}};
    if (variant.kind == DrawKind::ball) files = {"body.vert", "ball.frag", {"BALL"}};
    for (const std::string& define : shadow_defines(filter_)) files.defines.push_back(define);
    if (variant.kind != DrawKind::box || variant.lit) {
        files.defines.emplace_back("SUNLIT");
        if (shadows_) files.defines.emplace_back("SHADOWED");
    }
    if (variant.kind == DrawKind::box && variant.lit && metal_boxes_) files.defines.emplace_back("FILTERED");
    if (variant.patterned) files.defines.emplace_back("PATTERNED");
    if (variant.spans_cascades) files.defines.emplace_back("SPANS_CASCADES");
    if (variant.charted) files.defines.emplace_back("CHARTED");
    if (variant.painted) files.defines.emplace_back("PAINTED");
    for (const std::string& define : look_defines(looks_[variant.look])) files.defines.push_back(define);
    made = &device_->program(shaders_, files);
    connect(*made);
    return *made;
}

void BodyPass::draw(const GpuMeshCache& meshes, const std::vector<Batch>& batches) {
    for (const Batch& batch : batches) {
        program(variant_of(batch)).use();
        meshes.draw_in_view(batch);
    }
}

std::vector<std::function<void()>> BodyPass::compilations(const GpuMeshCache& meshes,
                                                          const std::vector<Batch>& batches) {
    std::vector<std::function<void()>> all;
    for (std::size_t i = 0; i < programs_.size(); ++i)
        all.emplace_back([this, &meshes, &batches, i] {
            const auto first = std::find_if(batches.begin(), batches.end(),
                                            [&](const Batch& b) { return index_of(variant_of(b)) == i; });
            if (first == batches.end()) return;
            program(variant_of(*first)).use();
            Batch one = *first;
            one.count = 1;
            meshes.draw(one);
        });
    return all;
}

}  // namespace tumble
