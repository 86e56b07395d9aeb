#include "render/mesh/mesh_buffer.h"

#include <cstddef>

namespace tumble {
namespace {

// Attribute locations as in shaders/instance.glsl.
constexpr GLuint first_instance_attribute = 2, instance_attributes = sizeof(Instance) / sizeof(glm::vec4);
constexpr GLuint sample_attribute = first_instance_attribute + instance_attributes;
constexpr GLuint texel_attribute = sample_attribute + 1;

const void* offset(std::size_t bytes) { return reinterpret_cast<const void*>(bytes); }

template <class T>
void fill(const GlFunctions& gl, GLenum target, const GlObject& buffer, std::span<const T> values) {
    gl.BindBuffer(target, buffer.name());
    gl.BufferData(target, GLsizeiptr(values.size_bytes()), values.data(), GL_STATIC_DRAW);
}

}  // namespace

MeshBuffer::MeshBuffer(const GlFunctions& gl, const MeshData& data)
    : gl_(&gl),
      array_(gl, GlKind::vertex_array),
      vertices_(gl, GlKind::buffer),
      indices_(gl, GlKind::buffer),
      samples_(gl, GlKind::buffer),
      texels_(gl, GlKind::buffer),
      index_count_(GLsizei(data.indices.size())),
      closed_(data.closed) {
    using Vertex = MeshAsset::Vertex;
    gl.BindVertexArray(array_.name());
    fill(gl, GL_ELEMENT_ARRAY_BUFFER, indices_, data.indices);
    fill(gl, GL_ARRAY_BUFFER, vertices_, data.vertices);
    gl.EnableVertexAttribArray(0);
    gl.VertexAttribPointer(0, 3, GL_FLOAT, GL_FALSE, sizeof(Vertex), offset(offsetof(Vertex, position)));
    gl.EnableVertexAttribArray(1);
    gl.VertexAttribPointer(1, 3, GL_FLOAT, GL_FALSE, sizeof(Vertex), offset(offsetof(Vertex, normal)));
    if (!data.sample_of_vertex.empty()) {
        fill(gl, GL_ARRAY_BUFFER, samples_, data.sample_of_vertex);
        gl.EnableVertexAttribArray(sample_attribute);
        gl.VertexAttribIPointer(sample_attribute, 1, GL_UNSIGNED_INT, sizeof(std::uint32_t), nullptr);
    }
    if (!data.texels.empty()) {
        fill(gl, GL_ARRAY_BUFFER, texels_, data.texels);
        gl.EnableVertexAttribArray(texel_attribute);
        gl.VertexAttribPointer(texel_attribute, 2, GL_FLOAT, GL_FALSE, sizeof(std::array<float, 2>), nullptr);
    }
    for (GLuint i = 0; i < instance_attributes; ++i) {
        gl.EnableVertexAttribArray(first_instance_attribute + i);
        gl.VertexAttribDivisor(first_instance_attribute + i, 1);
    }
    gl.BindVertexArray(0);
}

void MeshBuffer::draw(GLuint instances, std::size_t first, std::size_t count) const {
    gl_->BindVertexArray(array_.name());
    // Set once, because Mesa recompiles a vertex shader for an array with changing pointers.
    if (instances != instances_) {
        gl_->BindBuffer(GL_ARRAY_BUFFER, instances);
        for (GLuint i = 0; i < instance_attributes; ++i)
            gl_->VertexAttribPointer(first_instance_attribute + i, 4, GL_FLOAT, GL_FALSE, sizeof(Instance),
                                     offset(i * sizeof(glm::vec4)));
        instances_ = instances;
    }
    gl_->DrawElementsInstancedBaseInstance(GL_TRIANGLES, index_count_, GL_UNSIGNED_INT, nullptr, GLsizei(count),
                                           GLuint(first));
    gl_->BindVertexArray(0);
}

}  // namespace tumble
