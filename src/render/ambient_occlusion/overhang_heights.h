// Heights of fixed surfaces above a plane. Occlusion is a product over bodies and ignores surfaces in between: a body
// in a bowl or on a table would darken the floor below through it. So the lowest fixed surface above each texel of a
// plane tile is stored, and a moving body occludes the plane by the share of its footprint that has no such surface
// below the body.
#pragma once

#include "render/ambient_occlusion/occlusion_atlas.h"
#include "render/scene/render_scene.h"
#include "sim/snapshot/snapshot.h"

#include <vector>

namespace tumble {

/// Place of a plane tile in the world: texel (i, j) is at corner + i across + j along.
struct PlaneFrame {
    // m; unit vectors, in the plane and out of it
    Vec3 corner = Vec3::Zero(), u = Vec3::UnitX(), v = Vec3::UnitY(), normal = Vec3::UnitZ();
    double cell = 1.0;          // m
    int width = 0, height = 0;  // texels
    friend bool operator==(const PlaneFrame&, const PlaneFrame&) = default;
};

class OverhangHeights {
public:
    /// Rebuilds the heights if the frame is a different one. Fixed bodies have the same pose in every snapshot.
    void update(const PlaneFrame& frame, const RenderScene& scene, const Snapshot& snapshot);

    /// Share (0 to 1) of a disc without a fixed surface below `height` (m, of its center above the plane). (a, b): its
    /// center, in texels from the corner; `radius`: m, at least a texel.
    float open_share(double a, double b, double radius, double height) const;

private:
    void add_triangle(const Vec3& a, const Vec3& b, const Vec3& c);
    void add_ball(const Vec3& center, double radius);
    void lower(int i, int j, double height);
    Vec3 on_frame(const Vec3& point) const;  // texels, texels, m above the plane

    PlaneFrame frame_{};
    std::vector<float> height_;  // m; empty without fixed surfaces above the plane
};

}  // namespace tumble
