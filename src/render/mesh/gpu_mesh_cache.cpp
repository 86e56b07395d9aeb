#include "render/mesh/gpu_mesh_cache.h"

#include "render/shapes/primitive_meshes.h"

namespace tumble {
namespace {

constexpr int cylinder_sides = 16;  // a cord is a few pixels wide

}  // namespace

GpuMeshCache::GpuMeshCache(const GlFunctions& gl, const RenderScene& scene)
    : gl_(&gl), scene_(&scene), instances_(gl, GlKind::buffer) {
    meshes_.resize(scene_mesh(scene.meshes.size(), 0));
}

void GpuMeshCache::make_primitive(std::size_t mesh) {
    const bool closed = mesh != half_box_mesh;  // it is mirrored as needed, so its winding varies
    const DrawMesh made = mesh == half_box_mesh   ? make_half_box()
                          : mesh == face_mesh     ? make_face()
                          : mesh == cylinder_mesh ? make_cylinder(cylinder_sides)
                                                  : make_ball(int(mesh - first_ball_mesh));
    meshes_[mesh].emplace(*gl_, MeshData{made.vertices, made.indices, {}, {}, closed});
}

void GpuMeshCache::make(std::size_t mesh, MeshLods& details) {
    if (mesh < first_scene_mesh) return make_primitive(mesh);
    const std::size_t which = (mesh - first_scene_mesh) / mesh_levels, level = (mesh - first_scene_mesh) % mesh_levels;
    const RenderMesh& proxy = scene_->meshes[which];
    if (proxy.charts && level == 0) {
        const ChartedMesh& charts = *proxy.charts;
        meshes_[mesh].emplace(*gl_, MeshData{charts.vertices, charts.indices, {}, charts.texels, proxy.closed});
    } else if (level == 0) {
        meshes_[mesh].emplace(
            *gl_, MeshData{proxy.asset->vertices, proxy.asset->indices, proxy.sample_of_vertex, {}, proxy.closed});
    } else {
        const MeshLod& detail = details.at(which, level);
        meshes_[mesh].emplace(*gl_,
                              MeshData{detail.vertices, detail.indices, detail.sample_of_vertex, {}, proxy.closed});
    }
}

void GpuMeshCache::upload(const DrawList& list, MeshLods& details) {
    for (const std::vector<Batch>* batches : {&list.visible, &list.casters})
        for (const Batch& batch : *batches)
            if (!meshes_[batch.mesh]) make(batch.mesh, details);
    const std::span<const Instance> instances(list.instances);
    gl_->BindBuffer(GL_ARRAY_BUFFER, instances_.name());
    gl_->BufferData(GL_ARRAY_BUFFER, GLsizeiptr(instances.size_bytes()), instances.data(), GL_STREAM_DRAW);
}

void GpuMeshCache::draw(const Batch& batch) const {
    const MeshBuffer& mesh = *meshes_[batch.mesh];
    if (mesh.closed()) {
        gl_->Enable(GL_CULL_FACE);
    } else {
        gl_->Disable(GL_CULL_FACE);
    }
    mesh.draw(instances_.name(), batch.first, batch.count);
}

void GpuMeshCache::draw_in_view(const Batch& batch) const {
    const MeshBuffer& mesh = *meshes_[batch.mesh];
    gl_->Enable(GL_CULL_FACE);
    mesh.draw(instances_.name(), batch.first, batch.count);
    if (mesh.closed()) return;
    gl_->CullFace(GL_FRONT);
    gl_->Enable(GL_POLYGON_OFFSET_FILL);
    gl_->PolygonOffset(1.0f, 8.0f);  // slope of the depth per pixel, plus eight steps of the depth buffer
    mesh.draw(instances_.name(), batch.first, batch.count);
    gl_->Disable(GL_POLYGON_OFFSET_FILL);
    gl_->CullFace(GL_BACK);
}

}  // namespace tumble
