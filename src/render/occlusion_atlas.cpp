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
constexpr int window_step = 16;       // texels; a window that moves has the whole plane drawn anew
constexpr int most_rows = 8192;       // OpenGL 4.1 grants 16384

struct PlaneInView {
    std::size_t body;
    Eigen::Vector3f normal;
    float height;  // of the point that positions are relative to, above it, m
};

// The unit vector of a point in [-1, 1]^2. Meyer et al. 2010, On Floating-Point Normal Vectors: octahedral map.
Eigen::Vector3f octahedral(float x, float y) {
    const float z = 1.0f - std::abs(x) - std::abs(y);
    if (z >= 0.0f) return Eigen::Vector3f(x, y, z).normalized();
    return Eigen::Vector3f((1.0f - std::abs(y)) * (x >= 0.0f ? 1.0f : -1.0f),
                           (1.0f - std::abs(x)) * (y >= 0.0f ? 1.0f : -1.0f), z)
        .normalized();
}

int box_tile(const BodyLook& look, int coarser) {
    const double edge = 2.0 * look.half_size.maxCoeff();
    return std::clamp(int(std::ceil(texels_per_reach * edge / look.reach / coarser)) + 1, least_tile, most_tile);
}

// Shelves: a rectangle goes to the right of the last one where it fits under the same roof, else on a new shelf.
class Shelves {
public:
    explicit Shelves(int first_row) : row_(first_row) {}

    bool take(int width, int height, int& x, int& y) {
        if (width > OcclusionAtlas::width) return false;
        if (x_ + width > OcclusionAtlas::width || height > height_) {
            if (row_ + height_ + height > most_rows) return false;
            row_ += height_;
            x_ = 0;
            height_ = height;
        }
        x = x_;
        y = row_;
        x_ += width;
        return true;
    }
    int end() const { return row_ + height_; }

private:
    int row_, x_ = 0, height_ = 0;
};

class AtlasMaker {
public:
    AtlasMaker(const SceneLooks& looks, const Snapshot& snapshot, const CameraView& view, const Vec3& reference,
               OcclusionAtlas& atlas, const std::vector<std::uint32_t>& versions,
               std::vector<std::vector<std::uint64_t>>& neighbours, OcclusionChanges& changes)
        : looks_(looks),
          snapshot_(snapshot),
          reference_(reference),
          occluders_(make_occluders(looks, snapshot, view, reference)),
          finder_(occluders_),
          atlas_(atlas),
          versions_(versions),
          neighbours_(neighbours),
          changes_(changes) {
        for (std::size_t i = 0; i < looks.bodies.size(); ++i) {
            if (looks.bodies[i].kind != DrawKind::plane) continue;
            const PlaneShape plane = plane_in_world(looks.bodies[i], snapshot.bodies[i]);
            if (plane.normal.dot(view.eye()) - plane.offset > 0.0)
                planes_.push_back({i, plane.normal.cast<float>(), float(plane.normal.dot(reference) - plane.offset)});
        }
    }

    void make(const Visibility& visibility, int first_window_row) {
        Shelves shelves(first_window_row);
        atlas_.windows.clear();
        for (const PlaneInView& plane : planes_) add_window(plane, shelves);
        for (std::size_t i = 0; i < looks_.bodies.size(); ++i)
            if (visibility.bodies[i] && atlas_.places[i].size > 0)
                add_body(i, center_of(i), visibility.faces[i]);
    }

private:
    void grow(int height) {
        atlas_.height = std::max(atlas_.height, height);
        atlas_.texels.resize(std::size_t(atlas_.height) * OcclusionAtlas::width, 255);
    }
    void store(int x, int y, int width, int first) {
        for (int i = 0; i < width; ++i) {
            const auto value = std::uint8_t(255.0f * points_.open[std::size_t(first + i)] + 0.5f);
            std::uint8_t& at = texel(x + i, y);
            if (at == value) continue;
            at = value;
            changed_ = true;
            changes_.first_row = std::min(changes_.first_row, y);
            changes_.end_row = std::max(changes_.end_row, y + 1);
        }
    }
    std::uint8_t& texel(int x, int y) { return atlas_.texels[std::size_t(y) * OcclusionAtlas::width + std::size_t(x)]; }
    /// Of the ball around a body.
    Vec3 center_of(std::size_t body) const {
        const BodyState& state = snapshot_.bodies[body];
        return Vec3(state.origin - reference_) + state.orientation * looks_.bodies[body].bound_center;
    }
    // Are the body's neighbours those of the last time, in the same poses? Notes them down.
    bool as_before(std::size_t body, std::uint8_t visible) {
        key_.assign(1, visible);
        const auto add = [&](std::size_t other) {
            const std::uint64_t entry = std::uint64_t(other) << 32 | versions_[other];
            if (key_.empty() || key_.back() != entry) key_.push_back(entry);
        };
        add(body);
        for (const std::size_t i : found_) add(occluders_[i].body);
        for (const PlaneInView& plane : near_planes_) add(plane.body);
        if (neighbours_[body] == key_) return true;
        neighbours_[body] = key_;
        return false;
    }
    void darken_by(const std::vector<std::size_t>& near, double reach) {
        for (const std::size_t i : near) darken(points_, occluders_[i], float(reach));
        for (const PlaneInView& plane : near_planes_) darken(points_, plane.normal, plane.height, float(reach));
    }

    void add_body(std::size_t body, const Vec3& ball_center, std::uint8_t visible) {
        const BodyLook& look = looks_.bodies[body];
        const Eigen::Vector3f center = ball_center.cast<float>();
        finder_.find(center, float(look.bound_radius), found_);
        std::erase_if(found_, [&](std::size_t i) { return occluders_[i].body == body; });  // not by itself
        near_planes_.clear();
        for (const PlaneInView& plane : planes_)
            if (plane.normal.dot(center) + plane.height < look.bound_radius + 2.0 * look.reach) near_planes_.push_back(plane);
        if (as_before(body, visible)) return;
        changed_ = false;
        std::uint8_t faces = 0;
        if (look.kind == DrawKind::box) faces = add_box(body, ball_center, visible);
        if (look.kind == DrawKind::ball) add_ball(body, center);
        if (look.kind == DrawKind::mesh) add_mesh(body);
        if (changed_) changes_.bodies.push_back({body, faces});
    }

    // Tiles in the order of make_box()'s faces; a texel's centre at each corner of a face.
    // Returns the faces that changed.
    std::uint8_t add_box(std::size_t body, const Vec3& center, std::uint8_t visible) {
        const BodyLook& look = looks_.bodies[body];
        const OcclusionPlace& place = atlas_.places[body];
        const int size = place.size;
        std::uint8_t faces = 0;
        const Mat3 axes = snapshot_.bodies[body].orientation.toRotationMatrix();
        for (int face = 0; face < 6; ++face) {
            const int axis = face / 2;
            const double side = face % 2 == 0 ? -1.0 : 1.0;
            const Vec3 normal = side * axes.col(axis);
            const Vec3 middle = center + normal * look.half_size[axis];
            if ((visible >> face & 1) == 0) continue;
            const int a = (axis + 1) % 3, b = (axis + 2) % 3;
            const Vec3 u = axes.col(a) * look.half_size[a], v = axes.col(b) * look.half_size[b];
            points_.set_lattice((middle - u - v).cast<float>(), (2.0 * u / (size - 1)).cast<float>(),
                                (2.0 * v / (size - 1)).cast<float>(), normal.cast<float>(), size, size);
            const float radius = float(std::hypot(look.half_size[a], look.half_size[b]));
            near_face_.clear();
            for (const std::size_t i : found_)
                if (may_darken(occluders_[i], middle.cast<float>(), normal.cast<float>(), radius, float(look.reach)))
                    near_face_.push_back(i);
            darken_by(near_face_, look.reach);
            changed_ = false;
            for (int j = 0; j < size; ++j) store(place.x + face * size, place.y + j, size, j * size);
            if (changed_) faces |= std::uint8_t(1u << face);
        }
        changed_ = faces != 0;
        return faces;
    }

    void add_ball(std::size_t body, const Eigen::Vector3f& center) {
        const BodyLook& look = looks_.bodies[body];
        const OcclusionPlace& place = atlas_.places[body];
        const Eigen::Matrix3f axes = snapshot_.bodies[body].orientation.toRotationMatrix().cast<float>();
        points_.clear();
        for (int j = 0; j < ball_tile; ++j)
            for (int i = 0; i < ball_tile; ++i) {
                const float s = 2.0f * float(i) / (ball_tile - 1) - 1.0f, t = 2.0f * float(j) / (ball_tile - 1) - 1.0f;
                const Eigen::Vector3f normal = axes * octahedral(s, t);
                points_.add(center + normal * float(look.half_size.x()), normal);
            }
        darken_by(found_, look.reach);
        for (int j = 0; j < ball_tile; ++j) store(place.x, place.y + j, ball_tile, j * ball_tile);
    }

    // A run of texels, row after row over the atlas' whole width.
    void add_mesh(std::size_t body) {
        const BodyLook& look = looks_.bodies[body];
        const std::vector<MeshProbe>& probes = looks_.meshes[look.mesh].probes;
        const int count = int(probes.size()), rows = (count + OcclusionAtlas::width - 1) / OcclusionAtlas::width;
        const OcclusionPlace& place = atlas_.places[body];
        const BodyState& state = snapshot_.bodies[body];
        const Mat3 axes = state.orientation.toRotationMatrix();
        const Vec3 origin = state.origin - reference_;
        points_.clear();
        for (const MeshProbe& probe : probes)
            points_.add((origin + axes * probe.position).cast<float>(), (axes * probe.normal).cast<float>());
        darken_by(found_, look.reach);
        for (int row = 0; row < rows; ++row)
            store(place.x, place.y + row, std::min(OcclusionAtlas::width, count - row * OcclusionAtlas::width),
                  row * OcclusionAtlas::width);
    }

    void add_window(const PlaneInView& plane, Shelves& shelves);

    const SceneLooks& looks_;
    const Snapshot& snapshot_;
    const Vec3 reference_;
    std::vector<Occluder> occluders_;
    OccluderFinder finder_;
    std::vector<PlaneInView> planes_, near_planes_;
    OcclusionAtlas& atlas_;
    const std::vector<std::uint32_t>& versions_;
    std::vector<std::vector<std::uint64_t>>& neighbours_;
    OcclusionChanges& changes_;
    bool changed_ = false;                       // some texel of the tile at hand
    std::vector<std::uint64_t> key_;
    SurfacePoints points_;                       // of the tile at hand
    std::vector<std::size_t> found_, near_face_;  // what may darken it
};

// Every occluder near the plane darkens the texels around its foot; they multiply, as everywhere.
void AtlasMaker::add_window(const PlaneInView& plane, Shelves& shelves) {
    const BodyState& state = snapshot_.bodies[plane.body];
    const PlaneAxes axes = plane_axes(looks_.bodies[plane.body].plane.normal);
    const Vec3 u = state.orientation * axes.u, v = state.orientation * axes.v;
    const Vec3 origin = state.origin - reference_;  // the plane's coordinates count from here
    OcclusionWindow window;
    window.body = plane.body;
    // A power of two, and the window on whole cells: texels stay where they are while bodies move.
    window.cell = window_cell(looks_);

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
        // Whole steps: it seldom moves. Room for an open texel on either side.
        low = window_step * std::floor((least / window.cell - 1.0) / window_step);
        count = std::min(largest_window,
                         window_step * int(std::ceil((std::ceil(most / window.cell) - low + 2.0) / window_step)));
    };
    range([](const Foot& foot) { return foot.a; }, window.low_a, window.width);
    range([](const Foot& foot) { return foot.b; }, window.low_b, window.height);
    if (!shelves.take(window.width, window.height, window.x, window.y)) return;
    grow(shelves.end());
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
        const Vec3 on_plane = origin + looks_.bodies[plane.body].plane.offset * plane.normal.cast<double>();
        const Vec3 corner = on_plane + u * ((window.low_a + i0) * window.cell) + v * ((window.low_b + j0) * window.cell);
        points_.set_lattice(corner.cast<float>(), (u * window.cell).cast<float>(), (v * window.cell).cast<float>(),
                            plane.normal, i1 - i0 + 1, j1 - j0 + 1);
        darken(points_, *foot.occluder, foot.occluder->reach);
        for (int j = j0, k = 0; j <= j1; ++j)
            for (int i = i0; i <= i1; ++i, ++k) open[std::size_t(j * width + i)] *= points_.open[std::size_t(k)];
    }
    points_.open = std::move(open);
    for (int j = 0; j < window.height; ++j) store(window.x, window.y + j, width, j * width);
    atlas_.windows.push_back(window);
}

}  // namespace

double window_cell(const SceneLooks& looks) {
    return std::exp2(std::floor(std::log2(looks.typical_reach / texels_per_reach)));
}

OcclusionMaker::OcclusionMaker(const SceneLooks& looks, const Vec3& reference)
    : looks_(&looks), reference_(reference), versions_(looks.bodies.size(), 0), neighbours_(looks.bodies.size()) {
    for (int coarser = 1; coarser <= 64; coarser *= 2) {
        lay_out(coarser);
        if (2 * body_rows_ <= most_rows) break;   // else coarser: the windows need room as well
    }
    atlas_.texels.resize(std::size_t(atlas_.height) * OcclusionAtlas::width, 255);
}

void OcclusionMaker::lay_out(int coarser) {
    Shelves shelves(1);   // texel 0, 0 is open, for whoever has no place
    atlas_.places.assign(looks_->bodies.size(), {});
    for (std::size_t i = 0; i < looks_->bodies.size(); ++i) {
        const BodyLook& look = looks_->bodies[i];
        OcclusionPlace place;
        bool fits = false;
        if (look.kind == DrawKind::box) {
            place.size = box_tile(look, coarser);
            fits = shelves.take(6 * place.size, place.size, place.x, place.y);
        } else if (look.kind == DrawKind::ball) {
            place.size = ball_tile;
            fits = shelves.take(ball_tile, ball_tile, place.x, place.y);
        } else if (look.kind == DrawKind::mesh) {
            const int count = int(looks_->meshes[look.mesh].probes.size());
            const int rows = (count + OcclusionAtlas::width - 1) / OcclusionAtlas::width;
            place.size = 1;
            fits = shelves.take(rows == 1 ? count : OcclusionAtlas::width, rows, place.x, place.y);
        }
        if (fits) atlas_.places[i] = place;
    }
    body_rows_ = shelves.end();
    atlas_.height = body_rows_;
}

void OcclusionMaker::note_movements(const Snapshot& snapshot) {
    if (poses_.empty()) {
        for (const BodyState& state : snapshot.bodies) poses_.push_back({state.origin, state.orientation});
        return;
    }
    for (std::size_t i = 0; i < poses_.size(); ++i) {
        const BodyState& state = snapshot.bodies[i];
        if (poses_[i].origin == state.origin && poses_[i].orientation.coeffs() == state.orientation.coeffs()) continue;
        poses_[i] = {state.origin, state.orientation};
        ++versions_[i];
    }
}

const OcclusionChanges& OcclusionMaker::update(const Snapshot& snapshot, const CameraView& view,
                                               const Visibility& visibility) {
    const std::vector<OcclusionWindow> windows = atlas_.windows;
    changes_ = {};
    changes_.first_row = most_rows;
    note_movements(snapshot);
    AtlasMaker(*looks_, snapshot, view, reference_, atlas_, versions_, neighbours_, changes_).make(visibility, body_rows_);
    changes_.windows_moved = windows != atlas_.windows;
    return changes_;
}

}  // namespace tumble
