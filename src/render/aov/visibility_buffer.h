// The nearest surface under each pixel's center: what all values of a frame are worked out from. Found by rays in double
// precision, shape by shape, so that a ball is round, a box's edge is where it is to 1e-13 of a pixel, and nothing depends
// on OpenGL.
#pragma once

#include "render/aov/pinhole_camera.h"
#include "render/aov/shape_instance.h"

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace tumble {

/// One value a pixel, top row first.
struct VisibilityBuffer {
    static constexpr std::uint32_t nothing = ~0u;

    int width = 0, height = 0;
    std::vector<double> depth;             // m along the camera's axis; infinity: nothing
    std::vector<std::uint32_t> surface;    // index: the parts, then the cords; or `nothing`
    std::vector<std::uint32_t> triangle;   // of a mesh; means nothing elsewhere

    std::size_t at(int column, int row) const { return std::size_t(row) * std::size_t(width) + std::size_t(column); }
    void clear(int new_width, int new_height);
};

/// Where everything is as the camera sees it.
struct ScenePlaces {
    std::vector<PartPlace> parts;
    std::vector<CordPlace> cords;
};
ScenePlaces make_places(std::span<const ShapeInstance> parts, std::span<const CordDescription> cords,
                        const Snapshot& snapshot, const PinholeCamera& camera);

class VisibilityBufferRenderer {
public:
    /// Both must outlive it.
    VisibilityBufferRenderer(std::span<const ShapeInstance> parts, std::span<const CordDescription> cords);

    /// Of two surfaces at the same depth the first in order is taken.
    const VisibilityBuffer& find(const ScenePlaces& places, const PinholeCamera& camera);

private:
    void find_shape(const PlaneShape& plane, std::size_t index, const PartPlace& place, const PinholeCamera& camera);
    void find_shape(const BoxShape& box, std::size_t index, const PartPlace& place, const PinholeCamera& camera);
    void find_shape(const SphereShape& ball, std::size_t index, const PartPlace& place, const PinholeCamera& camera);
    void find_shape(const MeshShape& mesh, std::size_t index, const PartPlace& place, const PinholeCamera& camera);
    void find_shape(const CompoundShape&, std::size_t, const PartPlace&, const PinholeCamera&) {}   // taken apart before
    void find_cord(std::size_t index, const CordPlace& place, const PinholeCamera& camera);

    /// Of the pixels within the hull of the points: those nearer than what was found before. `depths_of` fills a row.
    template <class Depths>
    void find_rows(std::span<const Vec3> hull, std::size_t index, const PinholeCamera& camera, const Depths& depths_of);

    std::span<const ShapeInstance> parts_;
    std::span<const CordDescription> cords_;
    VisibilityBuffer map_;
    std::vector<double> ray_x_;      // of each column
    std::vector<double> depths_;     // of one row
    std::vector<Vec3> vertices_;     // of one mesh, in the camera's frame
};

}  // namespace tumble
