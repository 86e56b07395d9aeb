#include "render/plane_painter.h"

#include "render/glm_conversion.h"
#include "render/surface_programs.h"

#include <glm/gtc/type_ptr.hpp>

namespace tumble {

PlanePainter::PlanePainter(const GlFunctions& gl, const std::filesystem::path& shaders)
    : gl_(&gl), plane_(gl, shaders, {"plane.vert", "plane.frag", {}}), sky_(gl, shaders, {"sky.vert", "sky.frag", {}}),
      array_(gl, GlKind::vertex_array), corners_(gl, GlKind::buffer) {
    connect(plane_);
    connect(sky_);
    gl.BindVertexArray(array_.name());
    gl.BindBuffer(GL_ARRAY_BUFFER, corners_.name());
    gl.EnableVertexAttribArray(0);
    gl.VertexAttribPointer(0, 3, GL_FLOAT, GL_FALSE, sizeof(glm::vec3), nullptr);
    gl.BindVertexArray(0);
}

void PlanePainter::draw(const SceneLooks& looks, const Snapshot& snapshot, const CameraView& view,
                        double near_distance) const {
    const double cell = pattern_cell(view.target_distance());
    gl_->Disable(GL_CULL_FACE);
    for (std::size_t i = 0; i < looks.bodies.size(); ++i) {
        if (looks.bodies[i].kind != DrawKind::plane) continue;
        if (const auto patch = make_plane_patch(looks.bodies[i], snapshot.bodies[i], i, view, near_distance, cell))
            draw_patch(*patch, looks.bodies[i]);
    }
}

void PlanePainter::draw_patch(const PlanePatch& patch, const BodyLook& look) const {
    const auto set = [&](const char* name, const glm::vec4& value) {
        gl_->Uniform4fv(plane_.uniform(name), 1, glm::value_ptr(value));
    };
    plane_.use();
    set("plane_normal", to_glm(patch.normal, patch.height));
    set("plane_u", patch.u);
    set("plane_v", patch.v);
    set("plane_color", glm::vec4(look.color, look.roughness));
    const float pattern = look.pattern == Pattern::plain ? 0.0f : look.pattern == Pattern::grid ? 1.0f : 2.0f;
    set("plane_look", glm::vec4(look.metallic, pattern, 0.0f, 0.0f));
    gl_->BindVertexArray(array_.name());
    gl_->BindBuffer(GL_ARRAY_BUFFER, corners_.name());
    gl_->BufferData(GL_ARRAY_BUFFER, GLsizeiptr(patch.corners.size() * sizeof(glm::vec3)), patch.corners.data(),
                    GL_STREAM_DRAW);
    gl_->DrawArrays(GL_TRIANGLE_FAN, 0, GLsizei(patch.corners.size()));
    gl_->BindVertexArray(0);
}

void PlanePainter::draw_sky() const {
    gl_->Disable(GL_CULL_FACE);
    sky_.use();
    gl_->BindVertexArray(array_.name());
    gl_->DrawArrays(GL_TRIANGLES, 0, 3);
    gl_->BindVertexArray(0);
}

}  // namespace tumble
