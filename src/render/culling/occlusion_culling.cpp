#include "render/culling/occlusion_culling.h"

#include "render/camera/convex_hull_2d.h"
#include "render/culling/software_depth_buffer.h"
#include "render/scene/drawable_bounds.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

namespace tumble {
namespace {

using Point = ScreenPoint;

// Rasterization rounds to 1/256 pixel; one pixel is a safe distance from a silhouette.
constexpr double cell_margin = 1.0;  // pixels

struct Projected {
    std::array<Point, 8> points;                                               // as many as were given
    double nearest = std::numeric_limits<double>::infinity(), furthest = 0.0;  // along the axis, m
    double x0 = nearest, y0 = nearest, x1 = -nearest, y1 = -nearest;           // pixels
};

// False if a corner is beside or behind the eye.
bool project(std::span<const Vec3> corners, const Camera& view, Projected& result) {
    for (std::size_t i = 0; i < corners.size(); ++i) {
        const double depth = corners[i].dot(view.forward());
        if (!(depth > 1e-2 * corners[i].norm())) return false;
        const Point p = view.pixel(corners[i]);
        result.points[i] = p;
        result.nearest = std::min(result.nearest, depth);
        result.furthest = std::max(result.furthest, depth);
        result.x0 = std::min(result.x0, p.x());
        result.x1 = std::max(result.x1, p.x());
        result.y0 = std::min(result.y0, p.y());
        result.y1 = std::max(result.y1, p.y());
    }
    return true;
}

int first_cell(double pixel) { return int(std::floor(std::max(pixel, 0.0) / CoarseDepthBuffer::cell)); }
int last_cell(double pixel, int count) {
    return int(std::floor(std::min(pixel, double(count * CoarseDepthBuffer::cell) - 1.0) / CoarseDepthBuffer::cell));
}

// Faces that are turned to the eye and not hidden.
std::uint8_t visible_faces(const CoarseDepthBuffer::Corners& corners, const CoarseDepthBuffer& cover) {
    std::uint8_t faces = 0;
    for (std::size_t axis = 0; axis < 3; ++axis)
        for (std::size_t side = 0; side < 2; ++side) {
            std::array<Vec3, 4> points;
            std::size_t count = 0;
            for (std::size_t i = 0; i < 8; ++i)
                if ((i >> axis & 1) == side) points[count++] = corners[i];
            const std::size_t other = std::size_t(1) << axis;  // the corner opposite to corner 0 along the axis
            const Vec3 outward = (corners[other] - corners[0]) * (side == 1 ? 1.0 : -1.0);
            if (outward.dot(points[0]) < 0.0 && !cover.hides(points)) faces |= std::uint8_t(1u << (2 * axis + side));
        }
    return faces;
}

}  // namespace

CoarseDepthBuffer::CoarseDepthBuffer(const Camera& view)
    : view_(&view),
      columns_((view.width() + cell - 1) / cell),
      rows_((view.height() + cell - 1) / cell),
      depths_(std::size_t(columns_) * std::size_t(rows_), std::numeric_limits<double>::infinity()) {}

void CoarseDepthBuffer::add(const Corners& corners) {
    Projected box;
    if (!project(corners, *view_, box)) return;
    FewPoints points;
    for (const Point& p : box.points) points.push_back(p);
    const FewPoints hull = convex_hull(points);
    if (hull.size() < 3) return;
    // The hull, less its margin, is an interval on each line between rows of cells; a cell is covered if it is inside
    // both of its intervals.
    const auto interval = [&](double y, double& left, double& right) {
        left = -std::numeric_limits<double>::infinity();
        right = -left;
        for (std::size_t i = 0; i < hull.size(); ++i) {
            const Point &a = hull[i], edge = hull[(i + 1) % hull.size()] - a;
            // turn(a, b, (x, y)) >= cell_margin |edge|, solved for x
            const double rest = edge.x() * (y - a.y()) + edge.y() * a.x() - cell_margin * edge.norm();
            if (edge.y() > 0.0) right = std::min(right, rest / edge.y());
            if (edge.y() < 0.0) left = std::max(left, rest / edge.y());
            if (edge.y() == 0.0 && rest < 0.0) left = std::numeric_limits<double>::infinity();
        }
    };
    const int first = first_cell(box.y0);
    double above_left, above_right, left, right;
    interval(first * cell, above_left, above_right);
    for (int row = first; row <= last_cell(box.y1, rows_); ++row, above_left = left, above_right = right) {
        interval((row + 1) * cell, left, right);
        const double from = std::max({above_left, left, 0.0}), to = std::min(above_right, right);
        const double end = std::min(std::floor(to / cell), double(columns_));
        for (int column = int(std::ceil(std::min(from, 1e9) / cell)); column < end; ++column) {
            double& depth = depths_[std::size_t(row * columns_ + column)];
            depth = std::min(depth, box.furthest);
        }
    }
}

bool CoarseDepthBuffer::hides(std::span<const Vec3> corners) const {
    Projected body;
    if (!project(corners, *view_, body)) return false;
    for (int row = first_cell(body.y0 - cell_margin); row <= last_cell(body.y1 + cell_margin, rows_); ++row)
        for (int column = first_cell(body.x0 - cell_margin); column <= last_cell(body.x1 + cell_margin, columns_);
             ++column)
            if (!(depth(column, row) < body.nearest)) return false;
    return true;
}

namespace {

// In scenes of many bodies, smaller ones are culled per pixel.
constexpr double small = 48.0;  // size on the screen, pixels

struct Candidate {
    std::uint32_t body;
    float distance;  // m; of the bounding ball
};

// True if a plane that is seen from its open side hides all of a body. A face in the plane would flicker through it.
bool behind_plane(const FrameContext& frame, std::size_t body) {
    const DrawableBounds& bounds = frame.drawables.bodies[body];
    const bool box = frame.scene.bodies[body].kind == DrawKind::box;
    return std::any_of(frame.planes.begin(), frame.planes.end(), [&](const PlanePatch& plane) {
        const double reach =
            box ? (bounds.half_axes.transpose() * plane.normal).cwiseAbs().sum() : double(bounds.radius);
        constexpr double rounding = 1e-6;
        return plane.normal.dot(bounds.center) + plane.height <= rounding * bounds.radius - reach;
    });
}

std::vector<Candidate> find_candidates(const FrameContext& frame) {
    std::vector<Candidate> candidates;
    for (std::size_t i = 0; i < frame.drawables.bodies.size(); ++i) {
        const DrawableBounds& bounds = frame.drawables.bodies[i];
        if (bounds.exists() && frame.camera.sees(bounds.center, bounds.radius) && !behind_plane(frame, i))
            candidates.push_back({std::uint32_t(i), float(bounds.center.norm())});
    }
    std::sort(candidates.begin(), candidates.end(), [](const Candidate& a, const Candidate& b) {
        return a.distance != b.distance ? a.distance < b.distance : a.body < b.body;
    });
    return candidates;
}

// Adds the faces of a small box to the depth buffer. Returns the faces that may be visible.
std::uint8_t add_faces(const CoarseDepthBuffer::Corners& corners, const Projected& box, const Camera& view,
                       SoftwareDepthBuffer& cover) {
    std::uint8_t faces = 0;
    std::array<double, 8> inverse_depths;
    for (std::size_t i = 0; i < 8; ++i) inverse_depths[i] = 1.0 / corners[i].dot(view.forward());
    for (std::size_t axis = 0; axis < 3; ++axis) {
        const std::size_t bit = std::size_t(1) << axis, a = std::size_t(1) << (axis + 1) % 3,
                          b = std::size_t(1) << (axis + 2) % 3;
        const Vec3 along = corners[bit] - corners[0];
        for (std::size_t side = 0; side < 2; ++side) {
            const std::size_t first = side == 1 ? bit : 0;
            if (!(along.dot(corners[first]) * (side == 1 ? 1.0 : -1.0) < 0.0)) continue;
            std::array<SoftwareDepthBuffer::Corner, 4> face;
            std::size_t k = 0;
            for (const std::size_t i : {first, first | a, first | a | b, first | b})
                face[k++] = {box.points[i], inverse_depths[i]};
            if (cover.add(face)) faces |= std::uint8_t(1u << (2 * axis + side));
        }
    }
    return faces;
}

}  // namespace

Visibility find_visible(const FrameContext& frame) {
    const RenderScene& scene = frame.scene;
    const Camera& view = frame.camera;
    Mat3 view_axes;
    view_axes << view.right(), view.up(), view.forward();
    Visibility result{CoarseDepthBuffer(view), std::vector<bool>(scene.bodies.size(), false),
                      std::vector<std::uint8_t>(scene.bodies.size(), 0)};
    const std::vector<Candidate> candidates = find_candidates(frame);
    const bool by_pixel = frame.one_sample && candidates.size() >= large_scene;
    const auto is_box = [&](const Candidate& c) { return scene.bodies[c.body].kind == DrawKind::box; };
    const auto corners_of = [&](const Candidate& c) {
        const DrawableBounds& bounds = frame.drawables.bodies[c.body];
        return is_box(c) ? box_corners(bounds.center, frame.snapshot.bodies[c.body].orientation.toRotationMatrix(),
                                       scene.bodies[c.body].half_size)
                         : box_corners(bounds.center, view_axes, Vec3::Constant(bounds.radius));
    };
    const auto covers = [&](const Candidate& c) { return is_box(c) && !scene.bodies[c.body].translucent(); };
    const auto is_small = [&](const Candidate& c) {
        const double distance = double(c.distance) - scene.bodies[c.body].bound_radius;
        return by_pixel && distance > 0.0 &&
               2.0 * scene.bodies[c.body].bound_radius < small * distance * view.pixel_size();
    };
    for (const Candidate& candidate : candidates) {  // nearest first: a hidden candidate need not cover other bodies
        if (!covers(candidate) || is_small(candidate)) continue;
        const CoarseDepthBuffer::Corners corners = corners_of(candidate);
        if (!result.cover.hides(corners)) result.cover.add(corners);
    }
    std::optional<SoftwareDepthBuffer> pixels;
    if (by_pixel) pixels.emplace(view, result.cover);
    for (const Candidate& candidate : candidates) {
        const CoarseDepthBuffer::Corners corners = corners_of(candidate);
        Projected seen;
        const bool small_one = is_small(candidate) && project(corners, view, seen);
        if (is_box(candidate)) {
            std::uint8_t& faces = result.faces[candidate.body];
            if (!small_one || !covers(candidate))
                faces = visible_faces(corners, result.cover);
            else if (!pixels->hides(seen.x0, seen.y0, seen.x1, seen.y1, seen.nearest))
                faces = add_faces(corners, seen, view, *pixels);
            result.bodies[candidate.body] = faces != 0;
        } else if (small_one) {
            result.bodies[candidate.body] = !pixels->hides(seen.x0, seen.y0, seen.x1, seen.y1, seen.nearest);
        } else {
            result.bodies[candidate.body] = !result.cover.hides(corners);
        }
    }
    return result;
}

Visibility everything_visible(const FrameContext& frame) {
    Visibility all{CoarseDepthBuffer(frame.camera), {}, {}};
    for (const RenderBody& proxy : frame.scene.bodies) {
        all.bodies.push_back(proxy.solid());
        all.faces.push_back(proxy.kind == DrawKind::box ? 0x3f : 0);
    }
    return all;
}

}  // namespace tumble
