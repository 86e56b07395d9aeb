// The visible edges of a frame, where one surface ends in front of another. They are computed from the shapes: edges
// and outlines of boxes, circles of balls, outlines and creases of meshes, intersections of planes.
#pragma once

#include "render/antialiasing/thin_geometry_aa.h"
#include "render/culling/occlusion_culling.h"
#include "render/frame/frame_context.h"
#include "render/mesh/mesh_lod.h"

#include <array>
#include <cstdint>
#include <map>
#include <vector>

namespace tumble {

struct ScreenEdge {
    float x0, y0, x1, y1;  // pixels from the top left corner
    std::uint8_t inner;  // surface id (surface_ids.h) on the side to which the direction from 0 to 1 turns from x to y
    std::uint8_t outer;  // surface id on the other side; 0: any that is not `inner`
    bool whole_box = false;  // the inner side is any face of the box of `inner`, which may cover no pixel center itself
    std::uint8_t face = 0;   // index of the box's face
};

/// Edges of a mesh with the triangles on both sides; made once.
struct MeshEdges {
    struct Edge {
        std::uint32_t from, to;    // vertices
        std::int32_t left, right;  // triangles; -1: none
        bool crease;               // sharp enough to be visible between two visible faces
    };
    explicit MeshEdges(const TriangleMesh& mesh);
    std::vector<Edge> edges;
};

class EdgeFinder {
public:
    /// `lods` must outlive it.
    explicit EdgeFinder(MeshLods& lods) : lods_(&lods) {}

    /// Edges of the drawn bodies, in scene order. Valid until the next call.
    const std::vector<ScreenEdge>& find(const FrameContext& frame, const std::vector<char>& drawn,
                                        const Visibility& visible);

    /// Boxes among them that are thinner than a pixel, which have no edges. Valid as long.
    const std::vector<ScreenRod>& rods() const { return rods_; }

private:
    void add_rod(std::size_t body, const DrawableBounds& item);
    void add_box(std::size_t body, const DrawableBounds& item, std::uint8_t faces);
    void add_ball(std::size_t body, const DrawableBounds& item);
    void add_mesh(std::size_t body, const BodyState& state, const DrawableBounds& item);
    void add_outline(std::size_t body, const BodyState& state, const TriangleMesh& surface, const MeshEdges& edges);
    void add_corner(const PlanePatch& a, const PlanePatch& b);
    /// Adds the part in front of the eye of the edge from a to b of a body beside the eye, all relative to the eye; c
    /// is on the inner side.
    void add_clipped(Vec3 a, Vec3 b, const Vec3& c, std::uint8_t inner, std::uint8_t outer);

    const FrameContext* frame_ = nullptr;  // of the current call
    MeshLods* lods_;
    /// A mesh's edges on the screen, and the view that they were computed for.
    struct Seen {
        Vec3 origin, eye, forward, right;
        Quat orientation;
        double pixel_size = 0.0;
        std::size_t level = 0;
        std::vector<ScreenEdge> edges;
    };

    std::map<std::pair<std::size_t, std::size_t>, MeshEdges> meshes_;  // by mesh and level; made on first use
    std::map<std::size_t, Seen> seen_;  // by body: a resting mesh of 40,000 vertices is processed once
    std::vector<ScreenEdge> found_;
    std::vector<ScreenRod> rods_;
};

}  // namespace tumble
