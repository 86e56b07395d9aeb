// Sky visibility of bodies past their neighbors and the planes near them: the tiles of the AO atlas.
#pragma once

#include "render/ambient_occlusion/occlusion_atlas.h"
#include "render/ambient_occlusion/plane_occlusion.h"
#include "render/ambient_occlusion/texel_grid.h"

#include <functional>

namespace tumble {

/// Pose of a body, relative to the same point as occluders.
struct BodyPlace {
    Vec3 origin, center;  // m; origin of the body's frame, and center of its bounding ball
    Mat3 axes;            // columns
};

/// Possible occluders of a body.
struct Surroundings {
    const std::vector<Occluder>& occluders;
    const std::vector<std::size_t>& near;  // indices of the nearby ones
    const std::vector<PlaneInView>& planes;
};

/// A body to compute.
struct Receiver {
    const RenderBody& proxy;
    OcclusionPlace texels;
    BodyPlace pose;
    Surroundings around;
    float lod;  // 0 (one value per face, a few for a ball or mesh) to 1 (all texels)
};

class BodyOcclusion {
public:
    /// Stores visibilities of the texels from (x, y) on, row after row; true when any of them changes.
    using Store = std::function<bool(int x, int y, int width, int height, const float* open)>;

    explicit BodyOcclusion(const RenderScene& scene) : scene_(&scene) {}

    /// Updates faces of a box (bits as in Visibility): tiles in the order of the bits, with the center of a texel at
    /// each corner of a face. Returns the faces that changed.
    std::uint8_t make_box(const Receiver& body, std::uint8_t faces, const Store& store);

    /// True if any texel changed.
    bool make_ball(const Receiver& body, const Store& store);
    bool make_mesh(const Receiver& body, const Store& store);

private:
    void occlude_part(const Occluder& occluder, const GridPoints& face, float ao_radius);
    void occlude_points(const Surroundings& around, double ao_radius);

    const RenderScene* scene_;
    TexelGrid face_, part_;
    SurfacePoints points_;
    std::vector<float> coarse_, stretched_;
};

}  // namespace tumble
