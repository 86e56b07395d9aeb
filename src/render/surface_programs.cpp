#include "render/surface_programs.h"

namespace tumble {

void connect(const ShaderProgram& program) {
    program.set_block("Frame", frame_block);
    program.set_sampler("shadow_map", GLint(shadow_unit));
    program.set_sampler("occluders", GLint(occluders_unit));
    program.set_sampler("occluder_cells", GLint(cells_unit));
}

SurfacePrograms::SurfacePrograms(const GlFunctions& gl, const std::filesystem::path& shaders)
    : box_(gl, shaders, {"body.vert", "box.frag", {}}),
      ball_(gl, shaders, {"body.vert", "sphere.frag", {}}),
      mesh_(gl, shaders, {"body.vert", "mesh.frag", {}}) {
    for (const ShaderProgram* program : {&box_, &ball_, &mesh_}) connect(*program);
}

void SurfacePrograms::draw(const MeshLibrary& meshes, const std::vector<Batch>& batches) const {
    for (const Batch& batch : batches) {
        const ShaderProgram& program = batch.mesh == box_mesh ? box_ : batch.mesh < cylinder_mesh ? ball_ : mesh_;
        program.use();
        meshes.draw(batch);
    }
}

}  // namespace tumble
