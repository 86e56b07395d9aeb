#include "render/occlusion_atlas.h"

#include "render/occlusion_places.h"
#include "render/plane_darkening.h"
#include "render/plane_patch.h"

#include <algorithm>
#include <cmath>

namespace tumble {
namespace {

// Pixels across the picture of a body's longest edge, or of the ball around a mesh: below the first its darkening is
// coarse, above the second fine.
struct Sizes {
    double few, all;
};
constexpr Sizes box_sizes{4.0, 8.0}, ball_sizes{6.0, 12.0}, mesh_sizes{24.0, 48.0};
constexpr int coarse_ball_tile = 4;

// Where more than this part of the bodies moved, all are looked at again: searching who is near one of them gains nothing.
constexpr double most_moved = 0.25;

// The unit vector of a point in [-1, 1]^2. Meyer et al. 2010, On Floating-Point Normal Vectors: octahedral map.
Eigen::Vector3f octahedral(float x, float y) {
    const float z = 1.0f - std::abs(x) - std::abs(y);
    if (z >= 0.0f) return Eigen::Vector3f(x, y, z).normalized();
    return Eigen::Vector3f((1.0f - std::abs(y)) * (x >= 0.0f ? 1.0f : -1.0f),
                           (1.0f - std::abs(x)) * (y >= 0.0f ? 1.0f : -1.0f), z)
        .normalized();
}

// A lattice of `from` x `from` values, stretched over one of `to` x `to` with the same corners.
void stretch(const std::vector<float>& values, int from, int to, std::vector<float>& result) {
    result.resize(std::size_t(to) * std::size_t(to));
    const float step = to > 1 ? float(from - 1) / float(to - 1) : 0.0f;
    const auto at = [&](int i, int j) { return values[std::size_t(j * from + i)]; };
    for (int j = 0, k = 0; j < to; ++j)
        for (int i = 0; i < to; ++i, ++k) {
            const float s = float(i) * step, t = float(j) * step;
            const int a = std::min(int(s), from - 2), b = std::min(int(t), from - 2);
            const float u = s - float(a), v = t - float(b);
            result[std::size_t(k)] = (at(a, b) * (1.0f - u) + at(a + 1, b) * u) * (1.0f - v) +
                                     (at(a, b + 1) * (1.0f - u) + at(a + 1, b + 1) * u) * v;
        }
}

}  // namespace

double darkening_detail(double pixels, double few, double all) {
    const double t = std::clamp((pixels - few) / (all - few), 0.0, 1.0);
    return t * t * (3.0 - 2.0 * t);
}

struct OcclusionMaker::State {
    struct Pose {
        Vec3 origin;
        Quat orientation;
    };
    // What a body's texels were made from, beside the bodies around it.
    struct Made {
        std::uint8_t faces = 0;   // up to date; 1 for what has no faces
        float detail = 0.0f;
    };

    State(const SceneLooks& l, const Vec3& r) : looks(l), reference(r), made(l.bodies.size()) {
        lay_out_places(looks, atlas);
        body_rows = atlas.height;
        atlas.texels.resize(std::size_t(atlas.height) * OcclusionAtlas::width, 255);
    }

    void follow(const Snapshot& snapshot);
    void find_planes(const Snapshot& snapshot, const CameraView& view);
    void forget_touched(const Visibility& visibility);
    void update_windows(const Snapshot& snapshot);
    void update_body(std::size_t body, std::uint8_t visible, const CameraView& view);
    std::uint8_t make_box(std::size_t body, std::uint8_t wanted, float detail);
    void make_ball(std::size_t body, float detail);
    void make_mesh(std::size_t body, float detail);
    void darken_points(const std::vector<std::size_t>& near, double reach) {
        for (const std::size_t i : near) darken(points, occluders[i], float(reach));
        for (const PlaneInView& plane : near_planes) darken(points, plane.normal, plane.height, float(reach));
    }
    bool store(int x, int y, int width, const float* open);
    Vec3 center_of(std::size_t body) const {   // of the ball around it
        return Vec3(poses[body].origin - reference) + poses[body].orientation * looks.bodies[body].bound_center;
    }

    const SceneLooks& looks;
    const Vec3 reference;
    OcclusionAtlas atlas;
    int body_rows = 1;                       // of the atlas; the windows come below
    OcclusionChanges changes;
    std::vector<Pose> poses;                 // of the last update
    std::vector<Occluder> occluders, moved;  // of all bodies; those that moved, as they were and as they are
    std::vector<std::uint32_t> first;        // occluder of each body, and the end
    OccluderFinder finder{{}};
    bool anew = true;                        // everything is to be worked out
    bool moved_much = false;
    std::vector<Made> made;
    std::vector<PlaneInView> planes, near_planes;
    PlaneDarkening plane_darkening;
    SurfacePoints points;                    // of the tile at hand
    std::vector<std::size_t> found, near_face;   // what may darken it
    std::vector<float> coarse, stretched;
};

// Takes in the new poses: the occluders, and which of them moved.
void OcclusionMaker::State::follow(const Snapshot& snapshot) {
    const std::size_t bodies = looks.bodies.size();
    moved.clear();
    moved_much = false;
    if (poses.empty()) {
        for (std::size_t i = 0; i < bodies; ++i) {
            const BodyState& state = snapshot.bodies[i];
            poses.push_back({state.origin, state.orientation});
            first.push_back(std::uint32_t(occluders.size()));
            add_occluders(looks, i, state, reference, occluders);
        }
        first.push_back(std::uint32_t(occluders.size()));
        finder = OccluderFinder(occluders);
        return;
    }
    const auto has_moved = [&](std::size_t i) {
        const BodyState& state = snapshot.bodies[i];
        return poses[i].origin != state.origin || poses[i].orientation.coeffs() != state.orientation.coeffs();
    };
    std::size_t count = 0;
    for (std::size_t i = 0; i < bodies; ++i) count += has_moved(i) ? 1 : 0;
    if (count == 0) return;
    moved_much = double(count) > most_moved * double(bodies);
    std::vector<Occluder> now;
    for (std::size_t i = 0; i < bodies; ++i) {
        if (!has_moved(i)) continue;
        const BodyState& state = snapshot.bodies[i];
        poses[i] = {state.origin, state.orientation};
        made[i].faces = 0;
        now.clear();
        add_occluders(looks, i, state, reference, now);
        const auto place = occluders.begin() + first[i];
        if (!moved_much) {
            moved.insert(moved.end(), place, place + std::ptrdiff_t(now.size()));
            moved.insert(moved.end(), now.begin(), now.end());
        }
        std::copy(now.begin(), now.end(), place);
    }
    finder = OccluderFinder(occluders);
}

void OcclusionMaker::State::find_planes(const Snapshot& snapshot, const CameraView& view) {
    std::vector<PlaneInView> now;
    for (const std::size_t i : looks.planes) {
        const PlaneShape plane = plane_in_world(looks.bodies[i], snapshot.bodies[i]);
        if (plane.normal.dot(view.eye()) - plane.offset > 0.0)
            now.push_back({i, plane.normal.cast<float>(), float(plane.normal.dot(reference) - plane.offset)});
    }
    if (now != planes) anew = true;
    planes = std::move(now);
}

// Those that something has moved near to or away from.
void OcclusionMaker::State::forget_touched(const Visibility& visibility) {
    if (anew || moved_much) {
        for (Made& body : made) body.faces = 0;
        return;
    }
    if (moved.empty()) return;
    const OccluderFinder movers(moved);
    for (std::size_t i = 0; i < made.size(); ++i)   // what is out of sight waits until it is seen
        if (made[i].faces != 0 &&
            (!visibility.bodies[i] || movers.any(center_of(i).cast<float>(), float(looks.bodies[i].bound_radius))))
            made[i].faces = 0;
}

void OcclusionMaker::State::update_windows(const Snapshot& snapshot) {
    AtlasShelves shelves(body_rows, OcclusionAtlas::most_rows);
    std::vector<OcclusionWindow> windows;
    for (const PlaneInView& plane : planes) {
        const auto known = std::find_if(atlas.windows.begin(), atlas.windows.end(),
                                        [&](const OcclusionWindow& w) { return w.body == plane.body; });
        OcclusionWindow window;
        const auto keep = [&](int x, int y, int width, const float* open) {
            const int needed = y + 1;
            if (needed > atlas.height) {
                atlas.height = needed;
                atlas.texels.resize(std::size_t(needed) * OcclusionAtlas::width, 255);
            }
            store(x, y, width, open);
        };
        if (plane_darkening.update(plane, looks.bodies[plane.body], snapshot.bodies[plane.body], reference,
                                   looks.window_cell, occluders, moved, anew || moved_much,
                                   known == atlas.windows.end() ? nullptr : &*known, shelves, window, keep))
            windows.push_back(window);
    }
    changes.windows_moved = windows != atlas.windows;
    atlas.windows = std::move(windows);
}

bool OcclusionMaker::State::store(int x, int y, int width, const float* open) {
    bool changed = false;
    std::uint8_t* to = &atlas.texels[std::size_t(y) * OcclusionAtlas::width + std::size_t(x)];
    for (int i = 0; i < width; ++i) {
        const auto value = std::uint8_t(255.0f * open[i] + 0.5f);
        changed = changed || to[i] != value;
        to[i] = value;
    }
    if (changed) {
        changes.first_row = std::min(changes.first_row, y);
        changes.end_row = std::max(changes.end_row, y + 1);
    }
    return changed;
}

void OcclusionMaker::State::update_body(std::size_t body, std::uint8_t visible, const CameraView& view) {
    const BodyLook& look = looks.bodies[body];
    const Sizes& sizes = look.kind == DrawKind::box ? box_sizes : look.kind == DrawKind::ball ? ball_sizes : mesh_sizes;
    const Vec3 middle = center_of(body);
    const double size = 2.0 * (look.kind == DrawKind::mesh ? look.bound_radius : look.half_size.maxCoeff());
    const double pixels = size / (std::max((middle + reference - view.eye()).norm(), 1e-30) * view.pixel_size());
    const float detail = looks.bodies.size() < crowd ? 1.0f : float(darkening_detail(pixels, sizes.few, sizes.all));
    Made& known = made[body];
    if (known.detail != detail) known = {0, detail};
    const std::uint8_t wanted = look.kind == DrawKind::box ? visible : std::uint8_t(1);
    const auto missing = std::uint8_t(wanted & ~known.faces);
    if (missing == 0) return;
    known.faces |= missing;

    const Eigen::Vector3f center = middle.cast<float>();
    finder.find(center, float(look.bound_radius), found);
    std::erase_if(found, [&](std::size_t i) { return occluders[i].body == body; });  // not by itself
    near_planes.clear();
    for (const PlaneInView& plane : planes)
        if (plane.normal.dot(center) + plane.height < look.bound_radius + 2.0 * look.reach) near_planes.push_back(plane);
    const int before = changes.first_row, before_end = changes.end_row;
    std::uint8_t faces = 0;
    bool changed = false;
    if (look.kind == DrawKind::box) {
        faces = make_box(body, missing, detail);
        changed = faces != 0;
    } else {
        // Whether any row changes shows in the range alone: begin with an empty one.
        changes.first_row = OcclusionAtlas::most_rows;
        changes.end_row = 0;
        look.kind == DrawKind::ball ? make_ball(body, detail) : make_mesh(body, detail);
        changed = changes.end_row > 0;
        changes.first_row = std::min(changes.first_row, before);
        changes.end_row = std::max(changes.end_row, before_end);
    }
    if (changed) changes.bodies.push_back({body, faces});
}

// Tiles in the order of make_box()'s faces; a texel's centre at each corner of a face. Returns the faces that changed.
std::uint8_t OcclusionMaker::State::make_box(std::size_t body, std::uint8_t wanted, float detail) {
    const BodyLook& look = looks.bodies[body];
    const OcclusionPlace& place = atlas.places[body];
    const int size = place.size;
    std::uint8_t faces = 0;
    const Mat3 axes = poses[body].orientation.toRotationMatrix();
    const Vec3 center = center_of(body);
    for (int face = 0; face < 6; ++face) {
        if ((wanted >> face & 1) == 0) continue;
        const int axis = face / 2;
        const Vec3 normal = (face % 2 == 0 ? -1.0 : 1.0) * axes.col(axis);
        const Vec3 middle = center + normal * look.half_size[axis];
        const Eigen::Vector3f at = middle.cast<float>(), outward = normal.cast<float>();
        points.open.assign(std::size_t(size) * std::size_t(size), 1.0f);
        if (detail > 0.0f) {
            const int a = (axis + 1) % 3, b = (axis + 2) % 3;
            const Vec3 u = axes.col(a) * look.half_size[a], v = axes.col(b) * look.half_size[b];
            points.set_lattice((middle - u - v).cast<float>(), (2.0 * u / (size - 1)).cast<float>(),
                               (2.0 * v / (size - 1)).cast<float>(), outward, size, size);
            const float radius = float(std::hypot(look.half_size[a], look.half_size[b]));
            near_face.clear();
            for (const std::size_t i : found)
                if (may_darken(occluders[i], at, outward, radius, float(look.reach))) near_face.push_back(i);
            darken_points(near_face, look.reach);
        }
        if (detail < 1.0f) {
            float open = 1.0f;
            for (const std::size_t i : found) open *= share_left(at, outward, occluders[i], float(look.reach));
            for (const PlaneInView& plane : near_planes)
                open *= share_left(at, outward, plane.normal, plane.height, float(look.reach));
            for (float& value : points.open) value = open + (value - open) * detail;
        }
        for (int j = 0; j < size; ++j)
            if (store(place.x + face * size, place.y + j, size, &points.open[std::size_t(j * size)]))
                faces |= std::uint8_t(1u << face);
    }
    return faces;
}

void OcclusionMaker::State::make_ball(std::size_t body, float detail) {
    const BodyLook& look = looks.bodies[body];
    const OcclusionPlace& place = atlas.places[body];
    const Eigen::Matrix3f axes = poses[body].orientation.toRotationMatrix().cast<float>();
    const Eigen::Vector3f center = center_of(body).cast<float>();
    const auto make = [&](int size) {
        points.clear();
        for (int j = 0; j < size; ++j)
            for (int i = 0; i < size; ++i) {
                const float s = 2.0f * float(i) / float(size - 1) - 1.0f, t = 2.0f * float(j) / float(size - 1) - 1.0f;
                const Eigen::Vector3f normal = axes * octahedral(s, t);
                points.add(center + normal * float(look.half_size.x()), normal);
            }
        darken_points(found, look.reach);
    };
    if (detail < 1.0f) {
        make(coarse_ball_tile);
        stretch(points.open, coarse_ball_tile, place.size, stretched);
    }
    if (detail > 0.0f) make(place.size);
    else points.open = stretched;
    if (detail < 1.0f)
        for (std::size_t i = 0; i < stretched.size(); ++i)
            points.open[i] = stretched[i] + (points.open[i] - stretched[i]) * detail;
    for (int j = 0; j < place.size; ++j)
        store(place.x, place.y + j, place.size, &points.open[std::size_t(j * place.size)]);
}

// A run of texels, row after row over the atlas' whole width.
void OcclusionMaker::State::make_mesh(std::size_t body, float detail) {
    const MeshLook& mesh = looks.meshes[looks.bodies[body].mesh];
    const OcclusionPlace& place = atlas.places[body];
    const Mat3 axes = poses[body].orientation.toRotationMatrix();
    const Vec3 origin = poses[body].origin - reference;
    const auto make = [&](const auto& probes) {
        points.clear();
        for (const MeshProbe& probe : probes)
            points.add((origin + axes * probe.position).cast<float>(), (axes * probe.normal).cast<float>());
        darken_points(found, looks.bodies[body].reach);
    };
    if (detail < 1.0f) {
        make(mesh.coarse_probes);
        coarse = points.open;
    }
    if (detail > 0.0f) make(mesh.probes);
    else points.open.assign(mesh.probes.size(), 1.0f);
    if (detail < 1.0f)
        for (std::size_t i = 0; i < points.open.size(); ++i) {
            const float open = coarse[mesh.coarse_of_probe[i]];
            points.open[i] = open + (points.open[i] - open) * detail;
        }
    const int count = int(points.open.size());
    for (int row = 0; row * OcclusionAtlas::width < count; ++row)
        store(place.x, place.y + row, std::min(OcclusionAtlas::width, count - row * OcclusionAtlas::width),
              &points.open[std::size_t(row * OcclusionAtlas::width)]);
}

OcclusionMaker::OcclusionMaker(const SceneLooks& looks, const Vec3& reference)
    : state_(std::make_unique<State>(looks, reference)) {}
OcclusionMaker::~OcclusionMaker() = default;

const OcclusionAtlas& OcclusionMaker::atlas() const { return state_->atlas; }

const OcclusionChanges& OcclusionMaker::update(const Snapshot& snapshot, const CameraView& view,
                                               const Visibility& visibility) {
    State& s = *state_;
    s.changes = {};
    s.changes.first_row = OcclusionAtlas::most_rows;
    s.follow(snapshot);
    s.find_planes(snapshot, view);
    s.forget_touched(visibility);
    s.update_windows(snapshot);
    for (std::size_t i = 0; i < s.made.size(); ++i)
        if (visibility.bodies[i] && s.atlas.places[i].size > 0) s.update_body(i, visibility.faces[i], view);
    s.anew = false;
    return s.changes;
}

}  // namespace tumble
