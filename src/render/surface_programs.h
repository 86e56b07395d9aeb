// The shaders of bodies by kind of mesh, and the places where all shaders find what they share.
#pragma once

#include "render/mesh_library.h"
#include "render/shader_program.h"

#include <filesystem>
#include <vector>

namespace tumble {

/// The uniform block and the texture units of everything drawn.
inline constexpr GLuint frame_block = 0;
inline constexpr GLuint shadow_unit = 0, occluders_unit = 1, cells_unit = 2;

/// Ties a program's samplers and blocks to them.
void connect(const ShaderProgram& program);

class SurfacePrograms {
public:
    SurfacePrograms(const GlFunctions& gl, const std::filesystem::path& shaders);

    void draw(const MeshLibrary& meshes, const std::vector<Batch>& batches) const;

private:
    ShaderProgram box_, ball_, mesh_;
};

}  // namespace tumble
