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

class BodyOcclusion {
public:
    /// Stores visibilities of the texels from (x, y) on, row after row; true when any of them changes.
    using Store = std::function<bool(int x, int y, int width, int height, const float* open)>;

    /// `detail`: 0 (one value per face, a few for a ball or mesh) to 1 (all texels).
    explicit BodyOcclusion(const RenderScene& scene) : scene_(&scene) {}

    /// Updates the wanted faces (bits as in Visibility): tiles in the order of make_box()'s faces, with the center of a
    /// texel at each corner of a face. Returns the faces that changed.
    std::uint8_t make_box(const RenderBody& proxy, const OcclusionPlace& place, const BodyPlace& body,
                          const Surroundings& around, std::uint8_t requested, float detail, const Store& store);

    /// True if any texel changed.
    bool make_ball(const RenderBody& proxy, const OcclusionPlace& place, const BodyPlace& body,
                   const Surroundings& around, float detail, const Store& store);
    bool make_mesh(const RenderBody& proxy, const OcclusionPlace& place, const BodyPlace& body,
                   const Surroundings& around, float detail, const Store& store);

private:
    void occlude_part(const Occluder& occluder, const Eigen::Vector3f& corner, const Eigen::Vector3f& across,
                      const Eigen::Vector3f& along, const Eigen::Vector3f& normal, int size, float ao_radius);
    void occlude_points(const Surroundings& around, double ao_radius);

    const RenderScene* scene_;
    TexelGrid face_, part_;
    SurfacePoints points_;
    std::vector<float> coarse_, stretched_;
};

}  // namespace tumble
