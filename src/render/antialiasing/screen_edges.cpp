#include "render/antialiasing/screen_edges.h"

#include "render/antialiasing/surface_ids.h"
#include "render/camera/convex_hull_2d.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace tumble {
namespace {

// Largest deviation of a ball's outline polygon from the circle.
constexpr double circle_error = 0.03;  // pixels

// Below this size, a step between a box's own faces is a pixel or two long and invisible.
constexpr double inner_edge_pixels = 3.0;  // of its longest edge

// A face narrower than this on the screen may cover no pixel center along a part of its edge.
constexpr double narrow_pixels = 1.0;

// A mesh edge is a crease if the cosine between the normals of its faces is below this.
constexpr double crease_cosine = 0.9;

// True if a point is nearer than a distance to the line through two others.
bool within(double distance, const ScreenPoint& a, const ScreenPoint& b, const ScreenPoint& point) {
    const double area = turn(a, b, point);
    return area * area < distance * distance * (b - a).squaredNorm();
}

bool before_eye(const Vec3& point, const Camera& view) { return point.dot(view.forward()) > 1e-3 * point.norm(); }

// With the point `inside` on the inner side.
ScreenEdge directed(const ScreenPoint& a, const ScreenPoint& b, const ScreenPoint& inside, std::uint8_t inner,
                    std::uint8_t outer) {
    const ScreenPoint &from = turn(a, b, inside) >= 0.0 ? a : b, &to = &from == &a ? b : a;
    return {float(from.x()), float(from.y()), float(to.x()), float(to.y()), inner, outer};
}

}  // namespace

MeshEdges::MeshEdges(const TriangleMesh& mesh) {
    struct Half {
        std::uint32_t low, high;
        std::int32_t triangle;
    };
    std::vector<Half> halves;
    std::vector<Vec3> normals;
    for (const auto& t : mesh.triangles) {
        const Vec3 &a = mesh.vertices[t[0]], &b = mesh.vertices[t[1]], &c = mesh.vertices[t[2]];
        for (std::size_t k = 0; k < 3; ++k) {
            const std::uint32_t u = t[k], v = t[(k + 1) % 3];
            halves.push_back({std::min(u, v), std::max(u, v), std::int32_t(normals.size())});
        }
        normals.push_back((b - a).cross(c - a).normalized());
    }
    std::sort(halves.begin(), halves.end(), [](const Half& a, const Half& b) {
        return std::tie(a.low, a.high, a.triangle) < std::tie(b.low, b.high, b.triangle);
    });
    for (std::size_t i = 0; i < halves.size();) {
        std::size_t end = i;
        while (end < halves.size() && halves[end].low == halves[i].low && halves[end].high == halves[i].high) ++end;
        Edge edge{halves[i].low, halves[i].high, halves[i].triangle, -1, true};
        if (end - i >= 2) {  // more than two triangles at an edge: the further ones coincide closely enough
            edge.right = halves[i + 1].triangle;
            edge.crease = normals[std::size_t(edge.left)].dot(normals[std::size_t(edge.right)]) < crease_cosine;
        }
        edges.push_back(edge);
        i = end;
    }
}

const std::vector<ScreenEdge>& EdgeFinder::find(const FrameContext& frame, const std::vector<char>& drawn,
                                                const Visibility& visible) {
    frame_ = &frame;
    found_.clear();
    rods_.clear();
    for (std::size_t i = 0; i < frame.planes.size(); ++i)
        for (std::size_t j = i + 1; j < frame.planes.size(); ++j) add_corner(frame.planes[i], frame.planes[j]);
    for (std::size_t i = 0; i < frame.scene.bodies.size(); ++i) {
        if (drawn[i] == 0 || !visible.bodies[i]) continue;
        const RenderBody& proxy = frame.scene.bodies[i];
        const DrawableBounds& bounds = frame.drawables.bodies[i];
        if (proxy.kind == DrawKind::box) add_box(i, bounds, visible.faces[i]);
        if (proxy.kind == DrawKind::ball) add_ball(i, bounds);
        if (proxy.kind == DrawKind::mesh) add_mesh(i, frame.snapshot.bodies[i], bounds);
    }
    return found_;
}

void EdgeFinder::add_box(std::size_t body, const DrawableBounds& item, std::uint8_t faces) {
    const std::array<Vec3, 8> places = item.corners();
    std::array<ScreenPoint, 8> corners;
    bool before = true;  // all corners are in front of the eye
    for (std::size_t i = 0; i < 8 && before; ++i) {
        before = before_eye(places[i], frame_->camera);
        if (before) corners[i] = frame_->camera.pixel(places[i]);
    }
    if (before && is_rod(frame_->scene.bodies[body].half_size / (frame_->camera.pixel_size() * item.center.norm())))
        return add_rod(body, item);
    const double depth = item.center.dot(frame_->camera.forward());
    const bool inner_edges =
        2.0 * frame_->scene.bodies[body].half_size.maxCoeff() > inner_edge_pixels * depth * frame_->camera.pixel_size();
    std::array<bool, 6> front{};  // facing the eye, though perhaps hidden
    for (std::size_t face = 0; face < 6; ++face) {
        const std::size_t bit = std::size_t(1) << (face / 2);
        const Vec3& on_face = places[face % 2 == 1 ? bit : 0];
        front[face] = (places[bit] - places[0]).dot(on_face) * (face % 2 == 1 ? 1.0 : -1.0) < 0.0;
    }
    const std::size_t first = found_.size();
    bool narrow = false;
    for (std::size_t axis = 0; axis < 3; ++axis) {
        const std::size_t along = std::size_t(1) << axis, a = (axis + 1) % 3, b = (axis + 2) % 3;
        for (std::size_t sides = 0; sides < 4; ++sides) {
            std::size_t face = 2 * a + (sides & 1), other = 2 * b + (sides >> 1);
            std::size_t bit = std::size_t(1) << b;  // across `face`, away from the edge
            if (!front[face]) {
                std::swap(face, other);
                bit = std::size_t(1) << a;
            }
            if (!front[face]) continue;
            const bool both = front[other];
            if (both && !inner_edges) continue;
            if ((faces >> face & 1) == 0 && !(both && (faces >> other & 1) != 0)) continue;
            const std::size_t corner = (sides & 1) << a | (sides >> 1) << b;
            const std::uint8_t inner = surface_id(body, face), outer = both ? surface_id(body, other) : 0;
            if (!before) {
                add_clipped(places[corner], places[corner | along], places[corner ^ bit], inner, outer);
                continue;
            }
            const ScreenPoint &from = corners[corner], &to = corners[corner | along];
            // A face seen edge-on has no side of its own; the center is within every outline.
            const ScreenPoint inside = both ? corners[corner ^ bit] : frame_->camera.pixel(item.center);
            found_.push_back(directed(from, to, inside, inner, outer));
            if (both || !within(narrow_pixels, from, to, corners[corner ^ bit])) continue;
            found_.back().whole_box = narrow = true;
            found_.back().face = std::uint8_t(face);
        }
    }
    // A pixel is first filled with the box's own faces, then blended with its surroundings.
    if (narrow)
        std::stable_partition(found_.begin() + std::ptrdiff_t(first), found_.end(),
                              [](const ScreenEdge& e) { return e.outer != 0; });
}

// Uses the longest axis, and at both ends the extent of the other axes perpendicular to it on the screen.
void EdgeFinder::add_rod(std::size_t body, const DrawableBounds& item) {
    Eigen::Index longest = 0;
    frame_->scene.bodies[body].half_size.maxCoeff(&longest);
    const Vec3 axis = item.half_axes.col(longest);
    std::array<ScreenPoint, 2> ends{frame_->camera.pixel(item.center - axis), frame_->camera.pixel(item.center + axis)};
    const ScreenPoint way = ends[1] - ends[0];
    const ScreenPoint to = way.norm() > 1e-6 ? ScreenPoint(way.normalized()) : ScreenPoint(1.0, 0.0),
                      across(-to.y(), to.x());
    std::array<double, 2> half{};
    for (std::size_t end = 0; end < 2; ++end) {
        const Vec3 at = item.center + (end == 0 ? -1.0 : 1.0) * axis;
        const ScreenPoint middle = ends[end];
        double beyond = 0.0;
        for (const Eigen::Index other : {(longest + 1) % 3, (longest + 2) % 3}) {
            const ScreenPoint side = frame_->camera.pixel(at + item.half_axes.col(other)) - middle;
            half[end] += std::abs(across.dot(side));
            beyond += std::abs(to.dot(side));
        }
        ends[end] = middle + (end == 0 ? -beyond : beyond) * to;
    }
    rods_.push_back({ends[0].x(), ends[0].y(), ends[1].x(), ends[1].y(), half[0], half[1], surface_id(body, 0)});
}

// The outline of a ball is a circle in space, where rays from the eye are tangent.
void EdgeFinder::add_ball(std::size_t body, const DrawableBounds& item) {
    const double radius = frame_->scene.bodies[body].half_size.x(), distance = item.center.norm();
    if (distance < 1.001 * radius) return;
    const Vec3 axis = item.center / distance;
    const double share = radius / distance, circle = radius * std::sqrt(1.0 - share * share);
    const Vec3 middle = item.center - axis * (radius * share);
    const Vec3 u = axis.unitOrthogonal() * circle, v = axis.cross(u);
    const double pixels = circle / (middle.norm() * frame_->camera.pixel_size());
    const int count = std::clamp(int(std::numbers::pi * std::sqrt(0.5 * pixels / circle_error)) + 1, 8, 1000);
    const bool before = before_eye(item.center, frame_->camera);
    const ScreenPoint inside = frame_->camera.pixel(item.center);
    Vec3 last;
    for (int i = 0; i <= count; ++i) {
        const double angle = 2.0 * std::numbers::pi * (i % count) / count;
        const Vec3 point = middle + u * std::cos(angle) + v * std::sin(angle);
        if (i > 0 && before && before_eye(last, frame_->camera) && before_eye(point, frame_->camera))
            found_.push_back(
                directed(frame_->camera.pixel(last), frame_->camera.pixel(point), inside, surface_id(body, 0), 0));
        else if (i > 0)
            add_clipped(last, point, item.center, surface_id(body, 0), 0);
        last = point;
    }
}

// Uses the level of detail that is drawn.
void EdgeFinder::add_mesh(std::size_t body, const BodyState& state, const DrawableBounds& item) {
    const RenderBody& proxy = frame_->scene.bodies[body];
    const std::size_t level = level_in_view(proxy, frame_->scene, item.center, frame_->camera);
    const TriangleMesh& surface =
        level == 0 ? frame_->scene.meshes[proxy.mesh].asset->mesh : lods_->at(proxy.mesh, level).surface;
    const auto is_as_before = [&](const Seen& seen) {
        return seen.level == level && seen.origin == state.origin &&
               seen.orientation.coeffs() == state.orientation.coeffs() && seen.eye == frame_->camera.eye() &&
               seen.forward == frame_->camera.forward() && seen.right == frame_->camera.right() &&
               seen.pixel_size == frame_->camera.pixel_size();
    };
    const auto seen = seen_.find(body);
    if (seen != seen_.end() && is_as_before(seen->second)) {
        found_.insert(found_.end(), seen->second.edges.begin(), seen->second.edges.end());
        return;
    }
    const std::size_t first = found_.size();
    const std::pair key(proxy.mesh, level);
    auto edges = meshes_.find(key);
    if (edges == meshes_.end()) edges = meshes_.emplace(key, MeshEdges(surface)).first;
    add_outline(body, state, surface, edges->second);
    seen_[body] = {state.origin,
                   frame_->camera.eye(),
                   frame_->camera.forward(),
                   frame_->camera.right(),
                   state.orientation,
                   frame_->camera.pixel_size(),
                   level,
                   {found_.begin() + std::ptrdiff_t(first), found_.end()}};
}

void EdgeFinder::add_outline(std::size_t body, const BodyState& state, const TriangleMesh& surface,
                             const MeshEdges& edges) {
    const Vec3 origin = frame_->camera.relative(state.origin);
    const Vec3 eye = state.orientation.conjugate() * -origin;  // in the mesh's frame
    const Mat3 axes = state.orientation.toRotationMatrix();
    const auto place = [&](std::uint32_t vertex) -> Vec3 { return origin + axes * surface.vertices[vertex]; };
    std::vector<ScreenPoint> points;
    for (std::uint32_t i = 0; i < surface.vertices.size() && points.size() == i; ++i)
        if (const Vec3 at = place(i); before_eye(at, frame_->camera)) points.push_back(frame_->camera.pixel(at));
    const bool before = points.size() == surface.vertices.size();
    std::vector<char> front;
    for (const auto& t : surface.triangles) {
        const Vec3& a = surface.vertices[t[0]];
        const Vec3 normal = (surface.vertices[t[1]] - a).cross(surface.vertices[t[2]] - a);
        front.push_back(normal.dot(eye - a) > 0.0 ? 1 : 0);
    }
    const std::uint8_t id = surface_id(body, 0);
    const auto is_front = [&](std::int32_t triangle) { return triangle >= 0 && front[std::size_t(triangle)] != 0; };
    for (const MeshEdges::Edge& edge : edges.edges) {
        const bool left = is_front(edge.left), right = is_front(edge.right), open = edge.right < 0;
        const bool outline = open || left != right;
        if (!outline && !(edge.crease && left)) continue;
        const auto& t = surface.triangles[std::size_t(left || open ? edge.left : edge.right)];
        if (!before) {
            const std::uint32_t third = t[0] + t[1] + t[2] - edge.from - edge.to;
            add_clipped(place(edge.from), place(edge.to), place(third), id, id);
            if (outline) add_clipped(place(edge.from), place(edge.to), place(third), id, 0);
            continue;
        }
        const ScreenPoint inside = (points[t[0]] + points[t[1]] + points[t[2]]) / 3.0;
        // A mesh in front of itself has one id on both sides, as at a crease; visible edges are blended.
        found_.push_back(directed(points[edge.from], points[edge.to], inside, id, id));
        if (outline) found_.push_back(directed(points[edge.from], points[edge.to], inside, id, 0));
    }
}

void EdgeFinder::add_clipped(Vec3 a, Vec3 b, const Vec3& c, std::uint8_t inner, std::uint8_t outer) {
    for (const Vec3& side : frame_->camera.sides()) {
        const double at_a = side.dot(a), at_b = side.dot(b);
        if (at_a < 0.0 && at_b < 0.0) return;
        if (at_a < 0.0)
            a += (b - a) * (at_a / (at_a - at_b));
        else if (at_b < 0.0)
            b += (a - b) * (at_b / (at_b - at_a));
    }
    constexpr double inward = 1e-3;  // of the way to c, which may be behind the eye
    const Vec3 middle = 0.5 * (a + b), inside = middle + inward * (c - middle);
    if (!before_eye(a, frame_->camera) || !before_eye(b, frame_->camera) || !before_eye(inside, frame_->camera)) return;
    found_.push_back(
        directed(frame_->camera.pixel(a), frame_->camera.pixel(b), frame_->camera.pixel(inside), inner, outer));
}

// The intersection of two planes: the part of the line in front of the eye.
void EdgeFinder::add_corner(const PlanePatch& a, const PlanePatch& b) {
    const Vec3 along = a.normal.cross(b.normal);
    if (along.norm() < 1e-6) return;
    // n_a . p = -h_a, n_b . p = -h_b, along . p = 0
    Mat3 rows;
    rows << a.normal.transpose(), b.normal.transpose(), along.transpose();
    const Vec3 point = rows.inverse() * Vec3(-a.height, -b.height, 0.0);
    double low = -1e6 * point.norm(), high = -low;
    const auto clip = [&](const Vec3& normal) {  // to normal . p > 0
        const double at = normal.dot(point), slope = normal.dot(along);
        if (slope > 0.0) low = std::max(low, -at / slope);
        if (slope < 0.0) high = std::min(high, -at / slope);
        if (slope == 0.0 && at < 0.0) high = low;
    };
    for (const Vec3& side : frame_->camera.sides()) clip(side);
    if (!(low < high)) return;
    const Vec3 from = point + along * low, to = point + along * high;
    if (!before_eye(from, frame_->camera) || !before_eye(to, frame_->camera)) return;
    const ScreenPoint p = frame_->camera.pixel(from), q = frame_->camera.pixel(to);
    // The visible plane has the larger reciprocal depth.
    const ScreenPoint across = ScreenPoint(p.y() - q.y(), q.x() - p.x()).normalized(), beside = 0.5 * (p + q) + across;
    const Vec3 ray = frame_->camera.ray(beside.x(), beside.y());
    const bool a_there = -a.normal.dot(ray) / a.height > -b.normal.dot(ray) / b.height;
    found_.push_back(
        directed(p, q, beside, surface_id(a_there ? a.body : b.body, 0), surface_id(a_there ? b.body : a.body, 0)));
}

}  // namespace tumble
