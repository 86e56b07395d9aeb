#include "render/ambient_occlusion/overhang_heights.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace tumble {
namespace {

constexpr float no_overhang = std::numeric_limits<float>::infinity();

// The texels from low to high within 0 .. count - 1.
std::pair<int, int> texels(double low, double high, int count) {
    return {int(std::clamp(std::ceil(low), 0.0, double(count))),
            int(std::clamp(std::floor(high), -1.0, double(count - 1)))};
}

}  // namespace

Vec3 OverhangHeights::on_frame(const Vec3& point) const {
    const Vec3 from = point - frame_.corner;
    return {frame_.u.dot(from) / frame_.cell, frame_.v.dot(from) / frame_.cell, frame_.normal.dot(from)};
}

// Triangle parts behind the plane have heights below 0.
void OverhangHeights::lower(int i, int j, double height) {
    if (!(height >= 0.0)) return;
    if (height_.empty()) height_.assign(std::size_t(frame_.width) * std::size_t(frame_.height), no_overhang);
    float& known = height_[std::size_t(j) * std::size_t(frame_.width) + std::size_t(i)];
    known = std::min(known, float(height));
}

void OverhangHeights::add_triangle(const Vec3& a, const Vec3& b, const Vec3& c) {
    const Vec3 p = on_frame(a), pq = on_frame(b) - p, pr = on_frame(c) - p;
    const double area = pq.x() * pr.y() - pq.y() * pr.x();
    if (area == 0.0) return;  // a vertical triangle
    const auto [i0, i1] =
        texels(p.x() + std::min({0.0, pq.x(), pr.x()}), p.x() + std::max({0.0, pq.x(), pr.x()}), frame_.width);
    const auto [j0, j1] =
        texels(p.y() + std::min({0.0, pq.y(), pr.y()}), p.y() + std::max({0.0, pq.y(), pr.y()}), frame_.height);
    constexpr double edge = 1e-9;  // relative to the triangle: a point on an edge belongs to both triangles
    for (int j = j0; j <= j1; ++j)
        for (int i = i0; i <= i1; ++i) {
            const double x = i - p.x(), y = j - p.y();
            const double s = (x * pr.y() - y * pr.x()) / area, t = (pq.x() * y - pq.y() * x) / area;
            if (s >= -edge && t >= -edge && s + t <= 1.0 + edge) lower(i, j, p.z() + s * pq.z() + t * pr.z());
        }
}

void OverhangHeights::add_ball(const Vec3& center, double radius) {
    const Vec3 c = on_frame(center);
    const double half_width = radius / frame_.cell;
    const auto [i0, i1] = texels(c.x() - half_width, c.x() + half_width, frame_.width);
    const auto [j0, j1] = texels(c.y() - half_width, c.y() + half_width, frame_.height);
    for (int j = j0; j <= j1; ++j)
        for (int i = i0; i <= i1; ++i) {
            const double x = (i - c.x()) * frame_.cell, y = (j - c.y()) * frame_.cell;
            const double half_chord = std::sqrt(std::max(radius * radius - x * x - y * y, 0.0));
            lower(i, j, c.z() - half_chord);
            lower(i, j, c.z() + half_chord);
        }
}

void OverhangHeights::update(const PlaneFrame& frame, const RenderScene& scene, const Snapshot& snapshot) {
    if (frame == frame_) return;
    frame_ = frame;
    height_.clear();
    for (std::size_t i = 0; i < scene.bodies.size(); ++i) {
        const RenderBody& proxy = scene.bodies[i];
        if (!proxy.fixed) continue;
        const BodyState& state = snapshot.bodies[i];
        const auto in_world = [&](const Vec3& point) { return Vec3(state.origin + state.orientation * point); };
        if (proxy.kind == DrawKind::ball) add_ball(state.origin, proxy.half_size.x());
        if (proxy.kind == DrawKind::mesh) {
            const TriangleMesh& mesh = scene.meshes[proxy.mesh].asset->mesh;
            for (const auto& t : mesh.triangles)
                add_triangle(in_world(mesh.vertices[t[0]]), in_world(mesh.vertices[t[1]]),
                             in_world(mesh.vertices[t[2]]));
        }
        if (proxy.kind != DrawKind::box) continue;
        for (int axis = 0; axis < 3; ++axis)
            for (const double side : {-1.0, 1.0}) {
                Vec3 middle = Vec3::Zero(), across = Vec3::Zero(), along = Vec3::Zero();
                middle[axis] = side * proxy.half_size[axis];
                across[(axis + 1) % 3] = proxy.half_size[(axis + 1) % 3];
                along[(axis + 2) % 3] = proxy.half_size[(axis + 2) % 3];
                const Vec3 corners[4] = {in_world(middle - across - along), in_world(middle + across - along),
                                         in_world(middle + across + along), in_world(middle - across + along)};
                add_triangle(corners[0], corners[1], corners[2]);
                add_triangle(corners[0], corners[2], corners[3]);
            }
    }
}

float OverhangHeights::open_share(double a, double b, double radius, double height) const {
    if (height_.empty()) return 1.0f;
    const double half_width = std::max(radius / frame_.cell, 1.0);
    const auto [i0, i1] = texels(a - half_width, a + half_width, frame_.width);
    const auto [j0, j1] = texels(b - half_width, b + half_width, frame_.height);
    double open = 0.0, all = 0.0;
    for (int j = j0; j <= j1; ++j)
        for (int i = i0; i <= i1; ++i) {
            // The weight falls towards the edge of the disc, so that the share is continuous as the disc moves over the
            // texels.
            const double weight = 1.0 - ((i - a) * (i - a) + (j - b) * (j - b)) / (half_width * half_width);
            if (!(weight > 0.0)) continue;
            all += weight;
            if (double(height_[std::size_t(j) * std::size_t(frame_.width) + std::size_t(i)]) >= height) open += weight;
        }
    return all > 0.0 ? float(open / all) : 1.0f;
}

}  // namespace tumble
