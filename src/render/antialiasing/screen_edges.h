// The edges that can be seen in a picture: where a surface ends before another one. They are known exactly, from the
// bodies' shapes: edges and outlines of boxes, circles of balls, outlines and creases of meshes, where planes meet.
#pragma once

#include "render/scene/drawable_bounds.h"
#include "render/mesh/mesh_lod.h"
#include "render/scene/plane_patch.h"
#include "render/antialiasing/thin_geometry_aa.h"
#include "render/culling/occlusion_culling.h"

#include <array>
#include <cstdint>
#include <map>
#include <vector>

namespace tumble {

struct ScreenEdge {
    float x0, y0, x1, y1;    // pixels from the top left corner
    std::uint8_t inner;      // the surface (surface_ids.h) on the side to which the way from 0 to 1 turns from x to y
    std::uint8_t outer;      // the one on the other side; 0: anything that is not `inner`
    bool whole_box = false;  // the inner side is any face of the box that `inner` is one of: it may show in no pixel itself
    std::uint8_t face = 0;   // which of them it is
};

/// A mesh's edges with the triangles on both sides; made once.
struct MeshEdges {
    struct Edge {
        std::uint32_t from, to;         // vertices
        std::int32_t left, right;       // triangles; -1: none
        bool crease;                    // sharp enough to be seen where both sides are
    };
    explicit MeshEdges(const TriangleMesh& mesh);
    std::vector<Edge> edges;
};

class EdgeFinder {
public:
    /// All of them must outlive it.
    EdgeFinder(const RenderScene& looks, const Camera& view, MeshLods& details);

    /// Of the items that are wanted, in scene order. Valid until the next call.
    const std::vector<ScreenEdge>& find(const Snapshot& snapshot, const std::vector<DrawableBounds>& items,
                                        const std::vector<char>& wanted, const Visibility& visibility,
                                        const std::vector<PlanePatch>& planes);

    /// The boxes among them that are thinner than a pixel and have no edges. Valid as long.
    const std::vector<ScreenRod>& rods() const { return rods_; }

private:
    void add_rod(std::size_t body, const DrawableBounds& item);
    void add_box(std::size_t body, const DrawableBounds& item, std::uint8_t faces);
    void add_ball(std::size_t body, const DrawableBounds& item);
    void add_mesh(std::size_t body, const BodyState& state, const DrawableBounds& item);
    void add_outline(std::size_t body, const BodyState& state, const TriangleMesh& surface, const MeshEdges& edges);
    void add_corner(const PlanePatch& a, const PlanePatch& b);
    /// What is in view of the edge from a to b of a body that comes beside the eye, all relative to it; c lies on the inner side.
    void add_clipped(Vec3 a, Vec3 b, const Vec3& c, std::uint8_t inner, std::uint8_t outer);

    const RenderScene* looks_;
    const Camera* view_;
    MeshLods* details_;
    /// A mesh's edges in the picture, and from where it was seen so.
    struct Seen {
        Vec3 origin, eye, forward, right;
        Quat orientation;
        double pixel_size = 0.0;
        std::size_t level = 0;
        std::vector<ScreenEdge> edges;
    };

    std::map<std::pair<std::size_t, std::size_t>, MeshEdges> meshes_;   // by mesh and level; made when needed
    std::map<std::size_t, Seen> seen_;   // by body: a hill of 40,000 vertices that lies still is looked at once
    std::vector<ScreenEdge> found_;
    std::vector<ScreenRod> rods_;
};

}  // namespace tumble
