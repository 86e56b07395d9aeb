// All meshes of a scene in GPU memory, by the indices of batch.h.
#pragma once

#include "render/mesh/batch.h"
#include "render/mesh/mesh_buffer.h"
#include "render/mesh/texture_cache.h"

#include <optional>
#include <vector>

namespace tumble {

class GpuMeshCache {
public:
    GpuMeshCache(const GlFunctions& gl, const RenderScene& scene);

    /// Uploads the frame's instances, which the next batches refer to, and the meshes that they are the first to use.
    void upload(const DrawList& list, MeshLods& details);

    /// Draws a batch; back faces of closed meshes are culled.
    void draw(const Batch& batch) const;

    /// The same into the frame. Back faces of open meshes are moved slightly away from the eye. Without that, rounded
    /// depths would show specks of the underside where a surface is seen edge-on, in folds finer than a pixel.
    void draw_in_view(const Batch& batch) const;

private:
    void make(std::size_t mesh, MeshLods& details);
    void make_primitive(std::size_t mesh);
    void make_painted(std::size_t mesh, const MeshPaint& paint, const MeshData& plain);

    const GlFunctions* gl_;
    const RenderScene* scene_;
    TextureCache textures_;
    std::vector<TextureNames> look_textures_;  // by RenderScene::looks; 0: none, or not yet used
    std::vector<std::optional<MeshBuffer>> meshes_;
    GlObject instances_;
};

}  // namespace tumble
