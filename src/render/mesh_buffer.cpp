#include "render/mesh_buffer.h"

namespace tumble {
namespace {

constexpr GLuint first_instance_attribute = 2;   // as in shaders/instance.glsl
constexpr GLuint instance_attributes = 5;        // vec4 each
static_assert(sizeof(Instance) == instance_attributes * sizeof(glm::vec4));

const void* offset(std::size_t bytes) { return reinterpret_cast<const void*>(bytes); }

}  // namespace

MeshBuffer::MeshBuffer(const GlFunctions& gl, std::span<const MeshAsset::Vertex> vertices,
                       std::span<const std::uint32_t> indices, bool closed)
    : gl_(&gl), array_(gl, GlKind::vertex_array), vertices_(gl, GlKind::buffer), indices_(gl, GlKind::buffer),
      index_count_(GLsizei(indices.size())), closed_(closed) {
    using Vertex = MeshAsset::Vertex;
    gl.BindVertexArray(array_.name());
    gl.BindBuffer(GL_ARRAY_BUFFER, vertices_.name());
    gl.BufferData(GL_ARRAY_BUFFER, GLsizeiptr(vertices.size_bytes()), vertices.data(), GL_STATIC_DRAW);
    gl.BindBuffer(GL_ELEMENT_ARRAY_BUFFER, indices_.name());
    gl.BufferData(GL_ELEMENT_ARRAY_BUFFER, GLsizeiptr(indices.size_bytes()), indices.data(), GL_STATIC_DRAW);
    gl.EnableVertexAttribArray(0);
    gl.VertexAttribPointer(0, 3, GL_FLOAT, GL_FALSE, sizeof(Vertex), offset(offsetof(Vertex, position)));
    gl.EnableVertexAttribArray(1);
    gl.VertexAttribPointer(1, 3, GL_FLOAT, GL_FALSE, sizeof(Vertex), offset(offsetof(Vertex, normal)));
    for (GLuint i = 0; i < instance_attributes; ++i) {
        gl.EnableVertexAttribArray(first_instance_attribute + i);
        gl.VertexAttribDivisor(first_instance_attribute + i, 1);
    }
    gl.BindVertexArray(0);
}

void MeshBuffer::draw(GLuint instances, std::size_t first, std::size_t count) const {
    gl_->BindVertexArray(array_.name());
    gl_->BindBuffer(GL_ARRAY_BUFFER, instances);
    for (GLuint i = 0; i < instance_attributes; ++i)
        gl_->VertexAttribPointer(first_instance_attribute + i, 4, GL_FLOAT, GL_FALSE, sizeof(Instance),
                                 offset(first * sizeof(Instance) + i * sizeof(glm::vec4)));
    gl_->DrawElementsInstanced(GL_TRIANGLES, index_count_, GL_UNSIGNED_INT, nullptr, GLsizei(count));
    gl_->BindVertexArray(0);
}

}  // namespace tumble
