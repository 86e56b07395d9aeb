#include "render/passes/body_pass.h"

#include "render/environment/environment_textures.h"
#include "render/gl/uniform_blocks.h"
#include "render/passes/scene_defines.h"
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
    if (look.has_image()) return {"PLAIN", "IMAGE"};
    if (look.pattern == Pattern::plain) return {"PLAIN"};
    return {"PLAIN", fmt::format("TWO_COLORS {}", int(look.pattern))};
}

std::vector<std::string> feature_defines(unsigned features) {
    std::vector<std::string> all;
    const auto add = [&](unsigned bit, const char* define) {
        if ((features & bit) != 0) all.emplace_back(define);
    };
    add(SurfaceMaps::with_normal, "NORMAL_MAP");
    add(SurfaceMaps::with_surface, "SURFACE_MAP");
    add(SurfaceMaps::with_emission, "EMISSION_MAP");
    add(surface_feature::glowing | surface_feature::translucent, "GLOWING");
    add(surface_feature::translucent, "TRANSLUCENT");
    return all;
}

unsigned features_of(const RenderBody& proxy, const RenderScene& scene) {
    unsigned features = scene.looks[proxy.look].image.maps.bits();
    if (proxy.kind == DrawKind::mesh && scene.meshes[proxy.mesh].paint)
        features |= scene.meshes[proxy.mesh].paint->map_bits();
    if (proxy.glows()) features |= surface_feature::glowing;
    if (proxy.translucent()) features |= surface_feature::translucent;
    return features;
}

void connect(const ShaderProgram& program) {
    program.set_block("Frame", frame_block);
    program.set_block("Environment", environment_block);
    program.set_sampler("shadow_map", GLint(shadow_unit));
    program.set_sampler("lamp_shadow_map", GLint(lamp_shadow_unit));
    program.set_sampler("occlusion_atlas", GLint(occlusion_unit));
    program.set_block("Lamps", lamp_block);
    program.set_sampler("mesh_texture", GLint(paint_unit));
    constexpr std::array names{"normal_map", "surface_map", "emission_map"};
    for (std::size_t i = 0; i < names.size(); ++i) program.set_sampler(names[i], GLint(map_units[i]));
    program.set_sampler("environment_map", GLint(mirror_unit));
    program.set_sampler("background_image", GLint(background_unit));
    program.set_sampler("reflection_image", GLint(reflection_unit));
}

BodyPass::BodyPass(GlDevice& device, const std::filesystem::path& shaders, const RenderScene& scene,
                   const ShadowFilter& filter)
    : device_(&device),
      shaders_(shaders),
      shadows_(scene.light.shadows),
      filter_(filter),
      looks_(scene.looks),
      scene_defines_(scene_defines(scene)) {
    for (const RenderBody& proxy : scene.bodies)
        if (proxy.kind == DrawKind::box && proxy.metallic > 0.0f) metal_boxes_ = true;
    for (const RenderBody& proxy : scene.bodies)
        if (proxy.solid() && features_of(proxy, scene) == 0)
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
    return {kind,          batch.patterned, batch.lit,  batch.spans_cascades,
            batch.charted, batch.painted,   batch.look, batch.features};
}

std::size_t BodyPass::index_of(const Variant& variant) const {
    const std::size_t which = variant.kind == DrawKind::box ? (variant.lit ? 0 : 1)
                              : variant.kind == DrawKind::ball
                                  ? 2
                                  : 3 + (variant.charted ? 1 : 0) + (variant.painted ? 2 : 0);
    const SurfaceLook& look = looks_[variant.look];
    const std::size_t shader = variant.look == 0  ? (variant.patterned ? 1 : 0)
                               : look.has_image() ? look_shaders - 1
                                                  : 1 + std::size_t(look.pattern);
    return 2 * (look_shaders * which + shader) + (variant.spans_cascades ? 1 : 0);
}

const ShaderProgram& BodyPass::program(const Variant& variant) {
    const ShaderProgram*& made =
        variant.features == 0 ? programs_[index_of(variant)] : with_features_[{index_of(variant), variant.features}];
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
    for (const std::string& define : feature_defines(variant.features)) files.defines.push_back(define);
    files.defines.insert(files.defines.end(), scene_defines_.begin(), scene_defines_.end());
    made = &device_->program(shaders_, files);
    connect(*made);
    return *made;
}

// The share goes to the color alone: the alpha is an id of the surface.
void BodyPass::draw_over(const GpuMeshCache& meshes, const std::vector<Batch>& batches) {
    if (batches.empty()) return;
    const GlFunctions& gl = device_->gl();
    gl.Enable(GL_BLEND);
    gl.BlendFuncSeparate(GL_SRC1_ALPHA, GL_ONE_MINUS_SRC1_ALPHA, GL_ONE, GL_ZERO);
    draw(meshes, batches);
    gl.Disable(GL_BLEND);
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
            const auto first = std::find_if(batches.begin(), batches.end(), [&](const Batch& b) {
                return b.features == 0 && index_of(variant_of(b)) == i;
            });
            if (first == batches.end()) return;
            program(variant_of(*first)).use();
            Batch one = *first;
            one.count = 1;
            meshes.draw(one);
        });
    return all;
}

}  // namespace tumble
