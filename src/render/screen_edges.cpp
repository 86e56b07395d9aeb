#include "render/screen_edges.h"

#include "render/screen_hull.h"
#include "render/surface_ids.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace tumble {
namespace {

// A ball's outline as a polygon leaves the true one by no more than this.
constexpr double circle_error = 0.03;   // pixels

// A box that is smaller shows a step between its own faces in a pixel or two, which no one sees.
constexpr double inner_edge_pixels = 3.0;   // of its longest edge

// A mesh's edge is a crease when its faces' normals differ by more than this.
constexpr double crease_cosine = 0.9;

bool before_eye(const Vec3& point, const CameraView& view) { return point.dot(view.forward()) > 1e-3 * point.norm(); }

// With `inside` on the inner side.
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
        if (end - i >= 2) {   // more than two triangles at an edge: those that do not count are near enough
            edge.right = halves[i + 1].triangle;
            edge.crease = normals[std::size_t(edge.left)].dot(normals[std::size_t(edge.right)]) < crease_cosine;
        }
        edges.push_back(edge);
        i = end;
    }
}

EdgeFinder::EdgeFinder(const SceneLooks& looks, const CameraView& view, MeshDetails& details)
    : looks_(&looks), view_(&view), details_(&details) {}

const std::vector<ScreenEdge>& EdgeFinder::find(const Snapshot& snapshot, const std::vector<DrawnItem>& items,
                                                const std::vector<char>& wanted, const Visibility& visibility,
                                                const std::vector<PlanePatch>& planes) {
    found_.clear();
    for (std::size_t i = 0; i < planes.size(); ++i)
        for (std::size_t j = i + 1; j < planes.size(); ++j) add_corner(planes[i], planes[j]);
    for (std::size_t i = 0; i < looks_->bodies.size(); ++i) {
        if (wanted[i] == 0 || !visibility.bodies[i]) continue;
        const BodyLook& look = looks_->bodies[i];
        if (look.kind == DrawKind::box) add_box(i, items[i], visibility.faces[i]);
        if (look.kind == DrawKind::ball) add_ball(i, items[i]);
        if (look.kind == DrawKind::mesh) add_mesh(i, snapshot.bodies[i], items[i]);
    }
    return found_;
}

void EdgeFinder::add_box(std::size_t body, const DrawnItem& item, std::uint8_t faces) {
    const std::array<Vec3, 8> places = item.corners();
    std::array<ScreenPoint, 8> corners;
    for (std::size_t i = 0; i < 8; ++i) {
        if (!before_eye(places[i], *view_)) return;
        corners[i] = view_->pixel(places[i]);
    }
    const double depth = item.center.dot(view_->forward());
    const bool inner_edges = 2.0 * looks_->bodies[body].half_size.maxCoeff() > inner_edge_pixels * depth * view_->pixel_size();
    std::array<bool, 6> front{};   // turned to the eye, though perhaps hidden
    for (std::size_t face = 0; face < 6; ++face) {
        const std::size_t bit = std::size_t(1) << (face / 2);
        const Vec3& on_face = places[face % 2 == 1 ? bit : 0];
        front[face] = (places[bit] - places[0]).dot(on_face) * (face % 2 == 1 ? 1.0 : -1.0) < 0.0;
    }
    for (std::size_t axis = 0; axis < 3; ++axis) {
        const std::size_t along = std::size_t(1) << axis, a = (axis + 1) % 3, b = (axis + 2) % 3;
        for (std::size_t sides = 0; sides < 4; ++sides) {
            std::size_t face = 2 * a + (sides & 1), other = 2 * b + (sides >> 1);
            std::size_t bit = std::size_t(1) << b;   // across `face`, away from the edge
            if (!front[face]) {
                std::swap(face, other);
                bit = std::size_t(1) << a;
            }
            if (!front[face]) continue;
            const bool both = front[other];
            if (both && !inner_edges) continue;
            if ((faces >> face & 1) == 0 && !(both && (faces >> other & 1) != 0)) continue;
            const std::size_t corner = (sides & 1) << a | (sides >> 1) << b;
            found_.push_back(directed(corners[corner], corners[corner | along], corners[corner ^ bit],
                                      surface_id(body, face), both ? surface_id(body, other) : 0));
        }
    }
}

// The outline of a ball is a circle in space: where rays from the eye graze it.
void EdgeFinder::add_ball(std::size_t body, const DrawnItem& item) {
    const double radius = looks_->bodies[body].half_size.x(), distance = item.center.norm();
    if (distance < 1.001 * radius) return;
    const Vec3 axis = item.center / distance;
    const double share = radius / distance, circle = radius * std::sqrt(1.0 - share * share);
    const Vec3 middle = item.center - axis * (radius * share);
    const Vec3 u = axis.unitOrthogonal() * circle, v = axis.cross(u);
    const double pixels = circle / (middle.norm() * view_->pixel_size());
    const int count = std::clamp(int(std::numbers::pi * std::sqrt(0.5 * pixels / circle_error)) + 1, 8, 1000);
    const ScreenPoint inside = view_->pixel(item.center);
    ScreenPoint last;
    for (int i = 0; i <= count; ++i) {
        const double angle = 2.0 * std::numbers::pi * (i % count) / count;
        const Vec3 point = middle + u * std::cos(angle) + v * std::sin(angle);
        if (!before_eye(point, *view_)) return;
        const ScreenPoint at = view_->pixel(point);
        if (i > 0) found_.push_back(directed(last, at, inside, surface_id(body, 0), 0));
        last = at;
    }
}

// Of the level that is drawn.
void EdgeFinder::add_mesh(std::size_t body, const BodyState& state, const DrawnItem& item) {
    const BodyLook& look = looks_->bodies[body];
    const std::size_t level = level_in_view(look, *looks_, item.center, *view_);
    const TriangleMesh& surface =
        level == 0 ? looks_->meshes[look.mesh].asset->surface : details_->at(look.mesh, level).surface;
    const std::pair key(look.mesh, level);
    auto edges = meshes_.find(key);
    if (edges == meshes_.end()) edges = meshes_.emplace(key, MeshEdges(surface)).first;
    add_outline(body, state, surface, edges->second);
}

void EdgeFinder::add_outline(std::size_t body, const BodyState& state, const TriangleMesh& surface, const MeshEdges& edges) {
    const Vec3 origin = view_->relative(state.origin);
    const Vec3 eye = state.orientation.conjugate() * -origin;   // in the mesh's frame
    const Mat3 axes = state.orientation.toRotationMatrix();
    std::vector<ScreenPoint> points;
    for (const Vec3& vertex : surface.vertices) {
        const Vec3 at = origin + axes * vertex;
        if (!before_eye(at, *view_)) return;
        points.push_back(view_->pixel(at));
    }
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
        const ScreenPoint inside = (points[t[0]] + points[t[1]] + points[t[2]]) / 3.0;
        // The mesh before itself has one number on both sides, as at a crease; where both are in sight they are blended.
        found_.push_back(directed(points[edge.from], points[edge.to], inside, id, id));
        if (outline) found_.push_back(directed(points[edge.from], points[edge.to], inside, id, 0));
    }
}

// Where two planes meet: the part of the line before the eye.
void EdgeFinder::add_corner(const PlanePatch& a, const PlanePatch& b) {
    const Vec3 along = a.normal.cross(b.normal);
    if (along.norm() < 1e-6) return;
    // n_a . p = -h_a, n_b . p = -h_b, along . p = 0
    Mat3 rows;
    rows << a.normal.transpose(), b.normal.transpose(), along.transpose();
    const Vec3 point = rows.inverse() * Vec3(-a.height, -b.height, 0.0);
    double low = -1e6 * point.norm(), high = -low;
    const auto clip = [&](const Vec3& normal) {   // to normal . p > 0
        const double at = normal.dot(point), slope = normal.dot(along);
        if (slope > 0.0) low = std::max(low, -at / slope);
        if (slope < 0.0) high = std::min(high, -at / slope);
        if (slope == 0.0 && at < 0.0) high = low;
    };
    for (const Vec3& side : view_->sides()) clip(side);
    if (!(low < high)) return;
    const Vec3 from = point + along * low, to = point + along * high;
    if (!before_eye(from, *view_) || !before_eye(to, *view_)) return;
    const ScreenPoint p = view_->pixel(from), q = view_->pixel(to);
    // One over the depth is largest for the plane that is seen.
    const ScreenPoint across = ScreenPoint(p.y() - q.y(), q.x() - p.x()).normalized(), beside = 0.5 * (p + q) + across;
    const Vec3 ray = view_->ray(beside.x(), beside.y());
    const bool a_there = -a.normal.dot(ray) / a.height > -b.normal.dot(ray) / b.height;
    found_.push_back(directed(p, q, beside, surface_id(a_there ? a.body : b.body, 0), surface_id(a_there ? b.body : a.body, 0)));
}

}  // namespace tumble
