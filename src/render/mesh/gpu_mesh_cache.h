// All meshes of a scene on the graphics side, by the numbers of batch.h.
#pragma once

#include "render/mesh/batch.h"
#include "render/mesh/mesh_buffer.h"

#include <optional>
#include <vector>

namespace tumble {

class GpuMeshCache {
public:
    GpuMeshCache(const GlFunctions& gl, const RenderScene& looks);

    /// Sends the frame's instances, which the batches drawn next refer to, and meshes that they are the first to need.
    void upload(const DrawList& list, MeshLods& details);

    /// Draws a batch; back faces of closed meshes are left out.
    void draw(const Batch& batch) const;

    /// The same into the picture. Of open meshes back faces lie a little farther away than they are: where the surface is seen
    /// edge-on, in folds finer than a pixel, depths round to either side, and specks of the underside would show.
    void draw_in_view(const Batch& batch) const;

private:
    void make(std::size_t mesh, MeshLods& details);
    void make_primitive(std::size_t mesh);

    const GlFunctions* gl_;
    const RenderScene* looks_;
    std::vector<std::optional<MeshBuffer>> meshes_;
    GlObject instances_;
};

}  // namespace tumble
