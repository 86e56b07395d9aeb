// What the fixed bodies keep from a plane. Darkening multiplies body by body, as if nothing stood between: what lies in a bowl or on
// a table would darken the floor below through it. So of each texel of a plane's window the lowest fixed surface above it is kept,
// and what moves darkens the plane by the share of its middle that has no such roof below it.
#pragma once

#include "render/scene/render_scene.h"
#include "render/ambient_occlusion/occlusion_atlas.h"
#include "sim/snapshot/snapshot.h"

#include <vector>

namespace tumble {

/// A plane's window in the world: the texel (i, j) lies at corner + i across + j along.
struct PlaneFrame {
    Vec3 corner = Vec3::Zero(), u = Vec3::UnitX(), v = Vec3::UnitY(), normal = Vec3::UnitZ();   // m; unit, in the plane and out of it
    double cell = 1.0;           // m
    int width = 0, height = 0;   // texels
    friend bool operator==(const PlaneFrame&, const PlaneFrame&) = default;
};

class OverhangHeights {
public:
    /// Builds it anew where the frame is another one. Fixed bodies stay where they are, in every snapshot.
    void update(const PlaneFrame& frame, const RenderScene& looks, const Snapshot& snapshot);

    /// The share (0 to 1) of a disc that has no roof below `height` (m, of its middle above the plane). (a, b): its middle, in texels
    /// from the corner; `radius`: m, at least a texel.
    float open_share(double a, double b, double radius, double height) const;

private:
    void add_triangle(const Vec3& a, const Vec3& b, const Vec3& c);
    void add_ball(const Vec3& center, double radius);
    void lower(int i, int j, double height);
    Vec3 on_frame(const Vec3& point) const;   // texels, texels, m above the plane

    PlaneFrame frame_{};
    std::vector<float> height_;   // m; empty: no roof anywhere
};

}  // namespace tumble
