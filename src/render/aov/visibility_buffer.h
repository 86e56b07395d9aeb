// The visibility buffer: the nearest surface under each pixel center, from which all AOVs of a frame are computed. It
// is found by intersecting rays in double precision, shape by shape: balls are exact, edges of boxes are accurate to
// 1e-13 pixels, and OpenGL has no influence.
#pragma once

#include "render/aov/pinhole_camera.h"
#include "render/aov/shape_instance.h"
#include "render/shapes/drawn_shape.h"

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
    std::vector<std::uint32_t> surface;   // index: the parts, then the cords, then the water; or `nothing`
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

class VisibilityBufferRenderer : private RayTarget {
public:
    /// Both must outlive it.
    VisibilityBufferRenderer(std::span<const ShapeInstance> parts, std::span<const CordDescription> cords);

    /// If two surfaces have the same depth, the first in order is taken.
    VisibilityBuffer& find(const ScenePlaces& places, const PinholeCamera& camera);

private:
    void add_rows(std::span<const Vec3> hull, const Depths& depths) override;
    void add_triangles(std::span<const Vec3> vertices, std::span<const std::uint32_t> indices) override;
    void cast_cord(const CordPlace& place, double radius);

    std::span<const ShapeInstance> parts_;
    std::span<const CordDescription> cords_;
    VisibilityBuffer map_;
    const PinholeCamera* camera_ = nullptr;  // of the present call
    std::size_t surface_ = 0;                // index of the surface that is added
    std::vector<double> ray_x_;              // of each column
    std::vector<double> depths_;             // of one row
};

}  // namespace tumble
