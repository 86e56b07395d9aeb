#include "render/surface_programs.h"

#include "render/shadow_map.h"

#include <fmt/format.h>

#include <algorithm>

namespace tumble {
namespace {

std::size_t index_of(DrawKind kind, bool patterned, bool lit) {
    const std::size_t which = kind == DrawKind::box ? (lit ? 0 : 1) : kind == DrawKind::ball ? 2 : 3;
    return 2 * which + (patterned ? 1 : 0);
}

std::size_t index_of(const Batch& batch) {
    const DrawKind kind = batch.mesh == face_mesh      ? DrawKind::box
                          : batch.mesh < cylinder_mesh ? DrawKind::ball
                                                       : DrawKind::mesh;
    return index_of(kind, batch.patterned, batch.lit);
}

}  // namespace

std::string shadow_size() { return fmt::format("SHADOW_TEXELS {}.0", shadow_map_texels); }

void connect(const ShaderProgram& program) {
    program.set_block("Frame", frame_block);
    program.set_sampler("shadow_map", GLint(shadow_unit));
    program.set_sampler("occlusion_atlas", GLint(occlusion_unit));
}

SurfacePrograms::SurfacePrograms(const GlFunctions& gl, const std::filesystem::path& shaders, const SceneLooks& looks,
                                 bool has_cords, bool multisample, bool shadows)
    : multisample_(multisample), shadows_(shadows) {
    for (const BodyLook& look : looks.bodies)
        if (look.kind == DrawKind::box || look.kind == DrawKind::ball || look.kind == DrawKind::mesh)
            for (const bool lit : {true, false}) add(gl, shaders, look.kind, look.pattern != Pattern::plain, lit);
    if (has_cords) add(gl, shaders, DrawKind::mesh, false, true);
}

void SurfacePrograms::add(const GlFunctions& gl, const std::filesystem::path& shaders, DrawKind kind, bool patterned,
                          bool lit) {
    auto& program = programs_[index_of(kind, patterned, lit)];
    if (program) return;
    ShaderFiles files = {"body.vert", "mesh.frag", {"MESH"}};
    if (kind == DrawKind::box) files = {"body.vert", "box.frag", {"BOX"}};
    if (kind == DrawKind::ball) files = {"body.vert", "ball.frag", {"BALL"}};
    files.defines.push_back(shadow_size());
    if (multisample_) files.defines.emplace_back("MULTISAMPLE");
    if (kind != DrawKind::box || lit) {
        files.defines.emplace_back("SUNLIT");
        if (shadows_) files.defines.emplace_back("SHADOWED");
    }
    if (patterned) files.defines.emplace_back("PATTERNED");
    program.emplace(gl, shaders, files);
    connect(*program);
}

void SurfacePrograms::draw(const MeshLibrary& meshes, const std::vector<Batch>& batches) const {
    for (const Batch& batch : batches) {
        programs_[index_of(batch)]->use();
        meshes.draw(batch);
    }
}

std::vector<std::function<void()>> SurfacePrograms::compilations(const MeshLibrary& meshes,
                                                                 const std::vector<Batch>& batches) const {
    std::vector<std::function<void()>> all;
    for (std::size_t i = 0; i < programs_.size(); ++i)
        all.emplace_back([this, &meshes, &batches, i] {
            const auto first = std::find_if(batches.begin(), batches.end(), [&](const Batch& b) { return index_of(b) == i; });
            if (first == batches.end()) return;
            programs_[i]->use();
            Batch one = *first;
            one.count = 1;
            meshes.draw(one);
        });
    return all;
}

}  // namespace tumble
