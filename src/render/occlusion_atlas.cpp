#include "render/occlusion_atlas.h"

#include "render/draw_list.h"
#include "render/plane_axes.h"
#include "render/plane_patch.h"

#include <algorithm>
#include <cmath>

namespace tumble {
namespace {

constexpr double texels_per_reach = 4.0;  // how finely a body's darkening is sampled
constexpr int least_tile = 5, most_tile = 64;
constexpr int ball_tile = 16;
constexpr int largest_window = 1024;  // texels; bodies beyond it leave the plane open
constexpr int most_rows = 8192;       // OpenGL 4.1 grants 16384

struct PlaneInView {
    std::size_t body;
    Eigen::Vector3f normal;
    float height;  // of the eye above it, m
};

// The unit vector of a point in [-1, 1]^2. Meyer et al. 2010, On Floating-Point Normal Vectors: octahedral map.
Eigen::Vector3f octahedral(float x, float y) {
    const float z = 1.0f - std::abs(x) - std::abs(y);
    if (z >= 0.0f) return Eigen::Vector3f(x, y, z).normalized();
    return Eigen::Vector3f((1.0f - std::abs(y)) * (x >= 0.0f ? 1.0f : -1.0f),
                           (1.0f - std::abs(x)) * (y >= 0.0f ? 1.0f : -1.0f), z)
        .normalized();
}

class AtlasMaker {
public:
    AtlasMaker(const SceneLooks& looks, const Snapshot& snapshot, const CameraView& view)
        : looks_(looks),
          snapshot_(snapshot),
          view_(view),
          occluders_(make_occluders(looks, snapshot, view)),
          finder_(occluders_) {
        atlas_.places.resize(looks.bodies.size());
        for (std::size_t i = 0; i < looks.bodies.size(); ++i) {
            if (looks.bodies[i].kind != DrawKind::plane) continue;
            const PlaneShape plane = plane_in_world(looks.bodies[i], snapshot.bodies[i]);
            const double height = plane.normal.dot(view.eye()) - plane.offset;
            if (height > 0.0) planes_.push_back({i, plane.normal.cast<float>(), float(height)});
        }
    }

    OcclusionAtlas make(const Visibility& visibility) {
        grow(1);  // texel 0, 0 is open, for whoever has no place
        row_ = 1;
        for (const PlaneInView& plane : planes_) add_window(plane);
        for (std::size_t i = 0; i < looks_.bodies.size(); ++i) {
            if (visibility.bodies[i]) add_body(i, bounding_ball(looks_.bodies[i], snapshot_.bodies[i], view_));
        }
        return std::move(atlas_);
    }

private:
    void grow(int height) {
        atlas_.height = std::max(atlas_.height, height);
        atlas_.texels.resize(std::size_t(atlas_.height) * OcclusionAtlas::width, 255);
    }

    // Room for a rectangle: to the right of the last one where it fits under the same roof, else on a new shelf.
    bool take(int width, int height, int& x, int& y) {
        if (width > OcclusionAtlas::width) return false;
        if (shelf_x_ + width > OcclusionAtlas::width || height > shelf_height_) {
            row_ += shelf_height_;
            shelf_x_ = 0;
            shelf_height_ = height;
        }
        if (row_ + height > most_rows) return false;
        x = shelf_x_;
        y = row_;
        shelf_x_ += width;
        grow(row_ + height);
        return true;
    }

    void store(int x, int y, int width, int first) {
        for (int i = 0; i < width; ++i)
            texel(x + i, y) = std::uint8_t(255.0f * points_.open[std::size_t(first + i)] + 0.5f);
    }

    std::uint8_t& texel(int x, int y) { return atlas_.texels[std::size_t(y) * OcclusionAtlas::width + std::size_t(x)]; }

    void darken_by(const std::vector<std::size_t>& near, double reach) {
        for (const std::size_t i : near) darken(points_, occluders_[i], float(reach));
        for (const PlaneInView& plane : near_planes_) darken(points_, plane.normal, plane.height, float(reach));
    }

    void add_body(std::size_t body, const BoundingBall& ball) {
        const BodyLook& look = looks_.bodies[body];
        const Eigen::Vector3f center = ball.center.cast<float>();
        finder_.find(center, float(ball.radius), near_);
        std::erase_if(near_, [&](std::size_t i) { return occluders_[i].body == body; });  // not by itself
        near_planes_.clear();
        for (const PlaneInView& plane : planes_)
            if (plane.normal.dot(center) + plane.height < ball.radius + 2.0 * look.reach) near_planes_.push_back(plane);
        if (near_.empty() && near_planes_.empty()) return;
        if (look.kind == DrawKind::box) add_box(body, ball.center);
        if (look.kind == DrawKind::ball) add_ball(body, center);
        if (look.kind == DrawKind::mesh) add_mesh(body);
    }

    // Tiles in the order of make_box()'s faces; a texel's centre at each corner of a face.
    void add_box(std::size_t body, const Vec3& center) {
        const BodyLook& look = looks_.bodies[body];
        const double edge = 2.0 * look.half_size.maxCoeff();
        const int size = std::clamp(int(std::ceil(texels_per_reach * edge / look.reach)) + 1, least_tile, most_tile);
        OcclusionPlace place;
        if (!take(6 * size, size, place.x, place.y)) return;
        place.size = size;
        atlas_.places[body] = place;
        const Mat3 axes = snapshot_.bodies[body].orientation.toRotationMatrix();
        for (int face = 0; face < 6; ++face) {
            const int axis = face / 2;
            const double side = face % 2 == 0 ? -1.0 : 1.0;
            const Vec3 normal = side * axes.col(axis);
            const Vec3 middle = center + normal * look.half_size[axis];
            if (normal.dot(middle) >= 0.0) continue;  // turned away from the eye
            const int a = (axis + 1) % 3, b = (axis + 2) % 3;
            const Vec3 u = axes.col(a) * look.half_size[a], v = axes.col(b) * look.half_size[b];
            points_.clear();
            for (int j = 0; j < size; ++j)
                for (int i = 0; i < size; ++i) {
                    const double s = 2.0 * i / (size - 1) - 1.0, t = 2.0 * j / (size - 1) - 1.0;
                    points_.add((middle + s * u + t * v).cast<float>(), normal.cast<float>());
                }
            const float radius = float(std::hypot(look.half_size[a], look.half_size[b]));
            near_face_.clear();
            for (const std::size_t i : near_)
                if (may_darken(occluders_[i], middle.cast<float>(), normal.cast<float>(), radius, float(look.reach)))
                    near_face_.push_back(i);
            darken_by(near_face_, look.reach);
            for (int j = 0; j < size; ++j) store(place.x + face * size, place.y + j, size, j * size);
        }
    }

    void add_ball(std::size_t body, const Eigen::Vector3f& center) {
        const BodyLook& look = looks_.bodies[body];
        OcclusionPlace place;
        if (!take(ball_tile, ball_tile, place.x, place.y)) return;
        place.size = ball_tile;
        atlas_.places[body] = place;
        const Eigen::Matrix3f axes = snapshot_.bodies[body].orientation.toRotationMatrix().cast<float>();
        points_.clear();
        for (int j = 0; j < ball_tile; ++j)
            for (int i = 0; i < ball_tile; ++i) {
                const float s = 2.0f * float(i) / (ball_tile - 1) - 1.0f, t = 2.0f * float(j) / (ball_tile - 1) - 1.0f;
                const Eigen::Vector3f normal = axes * octahedral(s, t);
                points_.add(center + normal * float(look.half_size.x()), normal);
            }
        darken_by(near_, look.reach);
        for (int j = 0; j < ball_tile; ++j) store(place.x, place.y + j, ball_tile, j * ball_tile);
    }

    // A run of texels, row after row over the atlas' whole width.
    void add_mesh(std::size_t body) {
        const BodyLook& look = looks_.bodies[body];
        const std::vector<MeshProbe>& probes = looks_.meshes[look.mesh].probes;
        const int count = int(probes.size()), rows = (count + OcclusionAtlas::width - 1) / OcclusionAtlas::width;
        OcclusionPlace place;
        if (!take(rows == 1 ? count : OcclusionAtlas::width, rows, place.x, place.y)) return;
        place.size = 1;
        atlas_.places[body] = place;
        const BodyState& state = snapshot_.bodies[body];
        const Mat3 axes = state.orientation.toRotationMatrix();
        const Vec3 origin = view_.relative(state.origin);
        points_.clear();
        for (const MeshProbe& probe : probes)
            points_.add((origin + axes * probe.position).cast<float>(), (axes * probe.normal).cast<float>());
        darken_by(near_, look.reach);
        for (int row = 0; row < rows; ++row)
            store(place.x, place.y + row, std::min(OcclusionAtlas::width, count - row * OcclusionAtlas::width),
                  row * OcclusionAtlas::width);
    }

    void add_window(const PlaneInView& plane);

    const SceneLooks& looks_;
    const Snapshot& snapshot_;
    const CameraView& view_;
    std::vector<Occluder> occluders_;
    OccluderFinder finder_;
    std::vector<PlaneInView> planes_, near_planes_;
    OcclusionAtlas atlas_;
    int row_ = 0, shelf_x_ = 0, shelf_height_ = 0;
    SurfacePoints points_;                       // of the tile at hand
    std::vector<std::size_t> near_, near_face_;  // what may darken it
};

// Every occluder near the plane darkens the texels around its foot; they multiply, as everywhere.
void AtlasMaker::add_window(const PlaneInView& plane) {
    const BodyState& state = snapshot_.bodies[plane.body];
    const PlaneAxes axes = plane_axes(looks_.bodies[plane.body].plane.normal);
    const Vec3 u = state.orientation * axes.u, v = state.orientation * axes.v;
    const Vec3 origin = view_.relative(state.origin);  // the plane's coordinates count from here
    OcclusionWindow window;
    window.body = plane.body;
    // A power of two, and the window on whole cells: texels stay where they are while bodies move.
    window.cell = std::exp2(std::floor(std::log2(looks_.typical_reach / texels_per_reach)));

    struct Foot {
        const Occluder* occluder;
        double a, b, radius;
    };  // m
    std::vector<Foot> feet;
    for (const Occluder& o : occluders_) {
        const double height = double(plane.normal.dot(o.center)) + double(plane.height);
        if (height > double(o.bound_radius) + 2.0 * double(o.reach) || height < -double(o.bound_radius)) continue;
        const Vec3 from_origin = o.center.cast<double>() - origin;
        feet.push_back({&o, u.dot(from_origin), v.dot(from_origin), double(o.bound_radius) + double(o.reach)});
    }
    if (feet.empty()) return;

    const auto range = [&](auto coordinate, double& low, int& count) {
        double least = std::numeric_limits<double>::infinity(), most = -least;
        for (const Foot& foot : feet) {
            least = std::min(least, coordinate(foot) - foot.radius);
            most = std::max(most, coordinate(foot) + foot.radius);
        }
        if ((most - least) / window.cell > largest_window - 4) {  // keep the part where most of them are
            std::vector<double> middles;
            for (const Foot& foot : feet) middles.push_back(coordinate(foot));
            const auto middle = middles.begin() + std::ptrdiff_t(middles.size() / 2);
            std::nth_element(middles.begin(), middle, middles.end());
            least = *middle - 0.5 * (largest_window - 4) * window.cell;
            most = *middle + 0.5 * (largest_window - 4) * window.cell;
        }
        low = std::floor(least / window.cell) - 1.0;
        count = int(std::ceil(most / window.cell) - low) + 2;
    };
    range([](const Foot& foot) { return foot.a; }, window.low_a, window.width);
    range([](const Foot& foot) { return foot.b; }, window.low_b, window.height);
    if (!take(window.width, window.height, window.x, window.y)) return;

    const int width = window.width;
    std::vector<float> open(std::size_t(width) * std::size_t(window.height), 1.0f);
    for (const Foot& foot : feet) {
        const auto first = [&](double at, double low) {
            return std::max(1, int(std::floor((at - foot.radius) / window.cell - low)));
        };
        const auto last = [&](double at, double low, int count) {
            return std::min(count - 2, int(std::ceil((at + foot.radius) / window.cell - low)));
        };
        const int i0 = first(foot.a, window.low_a), i1 = last(foot.a, window.low_a, window.width);
        const int j0 = first(foot.b, window.low_b), j1 = last(foot.b, window.low_b, window.height);
        if (i0 > i1 || j0 > j1) continue;
        points_.clear();
        const Vec3 on_plane = origin + looks_.bodies[plane.body].plane.offset * plane.normal.cast<double>();
        for (int j = j0; j <= j1; ++j)
            for (int i = i0; i <= i1; ++i)
                points_.add((on_plane + u * ((window.low_a + i) * window.cell) + v * ((window.low_b + j) * window.cell))
                                .cast<float>(),
                            plane.normal);
        darken(points_, *foot.occluder, foot.occluder->reach);
        for (int j = j0, k = 0; j <= j1; ++j)
            for (int i = i0; i <= i1; ++i, ++k) open[std::size_t(j * width + i)] *= points_.open[std::size_t(k)];
    }
    for (int j = 0; j < window.height; ++j)
        for (int i = 0; i < width; ++i)
            texel(window.x + i, window.y + j) = std::uint8_t(255.0f * open[std::size_t(j * width + i)] + 0.5f);
    atlas_.windows.push_back(window);
}

}  // namespace

OcclusionAtlas make_occlusion_atlas(const SceneLooks& looks, const Snapshot& snapshot, const CameraView& view,
                                    const Visibility& visibility) {
    return AtlasMaker(looks, snapshot, view).make(visibility);
}

}  // namespace tumble
