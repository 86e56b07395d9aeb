// The visibility buffer: the nearest surface under each pixel center, from which all AOVs of a frame are computed. It
// is found by intersecting rays in double precision, shape by shape: balls are exact, edges of boxes are accurate to
// 1e-13 pixels, and OpenGL has no influence.
#pragma once

#include "render/aov/pinhole_camera.h"
#include "render/aov/shape_instance.h"

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace tumble {

/// One value per pixel, top row first.
struct VisibilityBuffer {
    static constexpr std::uint32_t nothing = ~0u;

    int width = 0, height = 0;
    std::vector<double> depth;            // m along the camera axis; infinity: background
    std::vector<std::uint32_t> surface;   // index: the parts, then the cords; or `nothing`
    std::vector<std::uint32_t> triangle;  // index in a mesh; meaningless for other shapes

    std::size_t at(int column, int row) const { return std::size_t(row) * std::size_t(width) + std::size_t(column); }
    void clear(int new_width, int new_height);
};

/// Poses of all surfaces in the camera frame.
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

    /// If two surfaces have the same depth, the first in order is taken.
    const VisibilityBuffer& find(const ScenePlaces& places, const PinholeCamera& camera);

private:
    void find_shape(const PlaneShape& plane, std::size_t index, const PartPlace& place, const PinholeCamera& camera);
    void find_shape(const BoxShape& box, std::size_t index, const PartPlace& place, const PinholeCamera& camera);
    void find_shape(const SphereShape& ball, std::size_t index, const PartPlace& place, const PinholeCamera& camera);
    void find_shape(const MeshShape& mesh, std::size_t index, const PartPlace& place, const PinholeCamera& camera);
    void find_shape(const CompoundShape&, std::size_t, const PartPlace&, const PinholeCamera&) {
    }  // compounds are expanded
    void find_cord(std::size_t index, const CordPlace& place, const PinholeCamera& camera);

    /// For the pixels within the hull of the points: stores depths that are nearer than the values in the buffer.
    /// `depths_of` fills a row.
    template <class Depths>
    void find_rows(std::span<const Vec3> hull, std::size_t index, const PinholeCamera& camera, const Depths& depths_of);

    std::span<const ShapeInstance> parts_;
    std::span<const CordDescription> cords_;
    VisibilityBuffer map_;
    std::vector<double> ray_x_;   // of each column
    std::vector<double> depths_;  // of one row
    std::vector<Vec3> vertices_;  // of one mesh, in the camera frame
};

}  // namespace tumble
