// The tiles of the occlusion atlas: how the sky's light reaches a body past its neighbors and the planes near it.
#pragma once

#include "render/ambient_occlusion/occlusion_atlas.h"
#include "render/ambient_occlusion/plane_occlusion.h"
#include "render/ambient_occlusion/texel_grid.h"

#include <functional>

namespace tumble {

/// Where a body is, relative to the same point as occluders.
struct BodyPlace {
    Vec3 origin, center;   // m; of the body's frame, and of the ball around the body
    Mat3 axes;             // columns
};

/// What may darken it.
struct Surroundings {
    const std::vector<Occluder>& occluders;
    const std::vector<std::size_t>& near;    // which of them
    const std::vector<PlaneInView>& planes;
};

class BodyOcclusion {
public:
    /// Takes shares for the texels from (x, y) on, row after row; true when that changes any.
    using Store = std::function<bool(int x, int y, int width, int height, const float* open)>;

    /// `detail`: from 0, a value a face, a few for a ball or mesh, to 1, all texels.
    explicit BodyOcclusion(const RenderScene& looks) : looks_(&looks) {}

    /// Makes the wanted faces (bits as in Visibility), tiles in the order of make_box()'s faces, with a texel's center at
    /// each corner of a face. Returns those that changed.
    std::uint8_t make_box(const RenderBody& look, const OcclusionPlace& place, const BodyPlace& body,
                          const Surroundings& around, std::uint8_t wanted, float detail, const Store& store);

    /// Have any texels changed?
    bool make_ball(const RenderBody& look, const OcclusionPlace& place, const BodyPlace& body, const Surroundings& around,
                   float detail, const Store& store);
    bool make_mesh(const RenderBody& look, const OcclusionPlace& place, const BodyPlace& body, const Surroundings& around,
                   float detail, const Store& store);

private:
    void darken_part(const Occluder& occluder, const Eigen::Vector3f& corner, const Eigen::Vector3f& across,
                     const Eigen::Vector3f& along, const Eigen::Vector3f& normal, int size, float reach);
    void darken_points(const Surroundings& around, double reach);

    const RenderScene* looks_;
    TexelGrid face_, part_;
    SurfacePoints points_;
    std::vector<float> coarse_, stretched_;
};

}  // namespace tumble
