#include "render/mesh_library.h"

#include "render/primitives.h"

namespace tumble {
namespace {

constexpr int cylinder_sides = 16;  // a cord is a few pixels wide

}  // namespace

MeshLibrary::MeshLibrary(const GlFunctions& gl, const SceneLooks& looks)
    : gl_(&gl), looks_(&looks), instances_(gl, GlKind::buffer) {
    const auto add = [&](const DrawMesh& mesh, bool closed = true) {
        meshes_.emplace_back().emplace(gl, MeshData{mesh.vertices, mesh.indices, {}, closed});
    };
    add(make_half_box(), false);   // mirrored as needed: no side of its triangles is the front
    add(make_face());
    for (std::size_t level = 0; level < ball_levels; ++level) add(make_ball(int(level)));
    add(make_cylinder(cylinder_sides));
    meshes_.resize(scene_mesh(looks.meshes.size(), 0));
}

void MeshLibrary::make(std::size_t mesh, MeshDetails& details) {
    const std::size_t which = (mesh - first_scene_mesh) / mesh_levels, level = (mesh - first_scene_mesh) % mesh_levels;
    const MeshLook& look = looks_->meshes[which];
    const Closedness form = closedness(look.asset->surface);
    const bool closed = form.closed() && form.signed_volume > 0.0;
    if (level == 0) {
        meshes_[mesh].emplace(*gl_, MeshData{look.asset->vertices, look.asset->indices, look.probe_of_vertex, closed});
    } else {
        const MeshDetail& detail = details.at(which, level);
        meshes_[mesh].emplace(*gl_, MeshData{detail.vertices, detail.indices, detail.probe_of_vertex, closed});
    }
}

void MeshLibrary::upload(const DrawList& list, MeshDetails& details) {
    for (const std::vector<Batch>* batches : {&list.visible, &list.casters})
        for (const Batch& batch : *batches)
            if (!meshes_[batch.mesh]) make(batch.mesh, details);
    const std::span<const Instance> instances(list.instances);
    gl_->BindBuffer(GL_ARRAY_BUFFER, instances_.name());
    gl_->BufferData(GL_ARRAY_BUFFER, GLsizeiptr(instances.size_bytes()), instances.data(), GL_STREAM_DRAW);
}

void MeshLibrary::draw(const Batch& batch) const {
    const MeshBuffer& mesh = *meshes_[batch.mesh];
    if (mesh.closed()) {
        gl_->Enable(GL_CULL_FACE);
    } else {
        gl_->Disable(GL_CULL_FACE);
    }
    mesh.draw(instances_.name(), batch.first, batch.count);
}

}  // namespace tumble
