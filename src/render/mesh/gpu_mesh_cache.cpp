#include "render/mesh/gpu_mesh_cache.h"

#include "render/shapes/primitive_meshes.h"

namespace tumble {
namespace {

constexpr int cylinder_sides = 16;  // a cord is a few pixels wide

}  // namespace

GpuMeshCache::GpuMeshCache(const GlFunctions& gl, const RenderScene& scene)
    : gl_(&gl), scene_(&scene), textures_(gl), instances_(gl, GlKind::buffer) {
    meshes_.resize(scene_mesh(scene.meshes.size(), 0));
    look_textures_.resize(scene.looks.size());
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
    if (level > 0) {
        const MeshLod& detail = details.at(which, level);
        meshes_[mesh].emplace(*gl_,
                              MeshData{detail.vertices, detail.indices, detail.sample_of_vertex, {}, proxy.closed});
        return;
    }
    const MeshData plain =
        proxy.charts ? MeshData{proxy.charts->vertices, proxy.charts->indices, {}, proxy.charts->texels, proxy.closed}
                     : MeshData{proxy.asset->vertices, proxy.asset->indices, proxy.sample_of_vertex, {}, proxy.closed};
    if (proxy.paint)
        make_painted(mesh, *proxy.paint, plain);
    else
        meshes_[mesh].emplace(*gl_, plain);
}

namespace {

template <class T>
std::vector<T> picked(std::span<const T> values, const std::vector<std::uint32_t>& places) {
    std::vector<T> result;
    if (values.empty()) return result;
    for (const std::uint32_t place : places) result.push_back(values[place]);
    return result;
}

}  // namespace

void GpuMeshCache::make_painted(std::size_t mesh, const MeshPaint& paint, const MeshData& plain) {
    const PaintedMesh painted = paint_mesh(plain.indices, paint);
    const auto vertices = picked(plain.vertices, painted.source);
    const auto samples = picked(plain.sample_of_vertex, painted.source);
    const auto texels = picked(plain.texels, painted.source);
    std::vector<TextureRange> ranges;
    for (const PaintedMesh::Range& range : painted.ranges)
        ranges.push_back({textures_.names_of(*range.material, paint.map_bits()), range.material->translucent(),
                          range.first, range.count});
    meshes_[mesh].emplace(*gl_,
                          MeshData{vertices, painted.indices, samples, texels, plain.closed, painted.paint, ranges});
}

void GpuMeshCache::upload(const DrawList& list, MeshLods& details) {
    for (const std::vector<Batch>* batches : {&list.visible, &list.translucent, &list.casters})
        for (const Batch& batch : *batches)
            if (!meshes_[batch.mesh]) make(batch.mesh, details);
    for (const std::vector<Batch>* batches : {&list.visible, &list.translucent})
        for (const Batch& batch : *batches)
            if (const SurfaceLook& look = scene_->looks[batch.look]; look.has_image())
                look_textures_[batch.look] = textures_.names_of(look.image, look.image.maps.bits());
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
    mesh.draw(instances_.name(), batch.first, batch.count, batch.part);
}

void GpuMeshCache::draw_in_view(const Batch& batch) const {
    const MeshBuffer& mesh = *meshes_[batch.mesh];
    look_textures_[batch.look].bind(*gl_);
    gl_->Enable(GL_CULL_FACE);
    mesh.draw(instances_.name(), batch.first, batch.count, batch.part);
    if (mesh.closed()) return;
    gl_->CullFace(GL_FRONT);
    gl_->Enable(GL_POLYGON_OFFSET_FILL);
    gl_->PolygonOffset(1.0f, 8.0f);  // slope of the depth per pixel, plus eight steps of the depth buffer
    mesh.draw(instances_.name(), batch.first, batch.count, batch.part);
    gl_->Disable(GL_POLYGON_OFFSET_FILL);
    gl_->CullFace(GL_BACK);
}

}  // namespace tumble
