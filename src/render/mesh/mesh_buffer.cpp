#include "render/mesh/mesh_buffer.h"

#include <cstddef>

namespace tumble {
namespace {

// Attribute locations as in shaders/instance.glsl.
constexpr GLuint first_instance_attribute = 2, instance_attributes = 7;
constexpr GLuint glow_attribute = 15;  // the last of the instance
constexpr GLuint sample_attribute = first_instance_attribute + instance_attributes;
constexpr GLuint texel_attribute = sample_attribute + 1;
constexpr GLuint paint_attribute = texel_attribute + 1;  // and those after it

constexpr GLuint attribute_of(GLuint i) {
    return i < instance_attributes ? first_instance_attribute + i : glow_attribute;
}

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
      paint_(gl, GlKind::buffer),
      ranges_(data.ranges),
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
    if (!data.paint.empty()) {
        fill(gl, GL_ARRAY_BUFFER, paint_, data.paint);
        const auto add = [&](GLuint index, GLint numbers, std::size_t place) {
            gl.EnableVertexAttribArray(paint_attribute + index);
            gl.VertexAttribPointer(paint_attribute + index, numbers, GL_FLOAT, GL_FALSE, sizeof(VertexPaint),
                                   offset(place));
        };
        add(0, 2, offsetof(VertexPaint, uv));
        add(1, 3, offsetof(VertexPaint, color));
        add(2, 4, offsetof(VertexPaint, surface));
        add(3, 3, offsetof(VertexPaint, emission));
    }
    if (ranges_.empty()) ranges_.push_back({{}, false, 0, data.indices.size()});
    for (GLuint i = 0; i <= instance_attributes; ++i) {
        gl.EnableVertexAttribArray(attribute_of(i));
        gl.VertexAttribDivisor(attribute_of(i), 1);
    }
    gl.BindVertexArray(0);
}

void MeshBuffer::draw(GLuint instances, std::size_t first, std::size_t count, MeshPart part) const {
    gl_->BindVertexArray(array_.name());
    // Set once, because Mesa recompiles a vertex shader for an array with changing pointers.
    if (instances != instances_) {
        gl_->BindBuffer(GL_ARRAY_BUFFER, instances);
        for (GLuint i = 0; i <= instance_attributes; ++i)
            gl_->VertexAttribPointer(attribute_of(i), 4, GL_FLOAT, GL_FALSE, sizeof(Instance),
                                     offset(i * sizeof(glm::vec4)));
        instances_ = instances;
    }
    for (const TextureRange& range : ranges_) {
        if (part != MeshPart::whole && range.translucent != (part == MeshPart::translucent)) continue;
        range.textures.bind(*gl_);
        gl_->DrawElementsInstancedBaseInstance(GL_TRIANGLES, GLsizei(range.count), GL_UNSIGNED_INT,
                                               offset(range.first * sizeof(std::uint32_t)), GLsizei(count),
                                               GLuint(first));
    }
    gl_->BindVertexArray(0);
}

}  // namespace tumble
