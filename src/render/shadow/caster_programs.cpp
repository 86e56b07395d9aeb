#include "render/shadow/caster_programs.h"

#include "render/gl/uniform_blocks.h"
#include "render/mesh/texture_cache.h"

#include <utility>

namespace tumble {

CasterPrograms::CasterPrograms(GlDevice& device, const std::filesystem::path& shaders, std::vector<std::string> defines)
    : device_(&device), shaders_(shaders), defines_(std::move(defines)), solid_(make("", {})) {}

const ShaderProgram& CasterPrograms::make(const char* fragment, const std::vector<std::string>& more) const {
    std::vector<std::string> all = defines_;
    all.insert(all.end(), more.begin(), more.end());
    const ShaderProgram& made = device_->program(shaders_, {"shadow.vert", fragment, std::move(all)});
    made.set_block("Frame", frame_block);
    made.set_block("Lamps", lamp_block);
    made.set_sampler("mesh_texture", GLint(paint_unit));
    return made;
}

void CasterPrograms::draw(const GpuMeshCache& meshes, const std::vector<Batch>& casters, int far_map) const {
    const ShaderProgram* used = nullptr;
    for (const Batch& batch : casters) {
        const bool sieved = (batch.features & surface_feature::sieved) != 0;
        if (sieved && !sieves_)
            sieves_.emplace(Sieves{make("shadow.frag", {"SIEVED"}), make("shadow.frag", {"SIEVED", "PAINTED"})});
        const ShaderProgram& program = !sieved ? solid_ : batch.painted ? sieves_->painted : sieves_->plain;
        if (&program != used) {
            program.use();
            device_->gl().Uniform1i(program.uniform("far_map"), far_map);
            used = &program;
        }
        meshes.draw(batch);
    }
}

}  // namespace tumble
