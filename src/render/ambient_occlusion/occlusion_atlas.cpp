#include "render/ambient_occlusion/occlusion_atlas.h"

#include "render/ambient_occlusion/atlas_layout.h"
#include "render/ambient_occlusion/body_occlusion.h"
#include "render/ambient_occlusion/lightmap_occlusion.h"
#include "render/ambient_occlusion/plane_occlusion.h"
#include "render/scene/plane_patch.h"

#include <algorithm>
#include <cmath>
#include <optional>

namespace tumble {
namespace {

// Size on the screen, in pixels, of a body's longest edge or of a mesh's bounding ball: below the first value its AO is
// coarse, above the second fine.
struct Sizes {
    double few, all;
};
constexpr Sizes box_sizes{4.0, 8.0}, ball_sizes{6.0, 12.0}, mesh_sizes{24.0, 48.0};

// Where more than this share of the bodies moved, all are checked again: a search for their neighbors would cost more.
constexpr double most_moved = 0.25;

int level(float open) { return int(255.0f * open + 0.5f); }

// Texels per side of the parts in which changes of a large receiver's face are reported.
constexpr int receiver_part = 8;

}  // namespace

double occlusion_lod(double pixels, double few, double all) {
    const double t = std::clamp((pixels - few) / (all - few), 0.0, 1.0);
    return t * t * (3.0 - 2.0 * t);
}

struct AmbientOcclusion::State {
    // The state that a body's texels were made from, apart from the bodies around it.
    struct Made {
        std::uint8_t faces = 0;  // up to date; 1 for shapes without faces
        float lod = 0.0f;
    };

    State(const RenderScene& s, const Vec3& r) : scene(s), reference(r), made(s.bodies.size()) {
        lay_out_places(scene, atlas);
        body_rows = atlas.height;
        atlas.texels.resize(std::size_t(atlas.height) * OcclusionAtlas::width, 255);
        lightmaps.resize(scene.lightmaps.empty() ? 0 : scene.bodies.size());
    }

    void follow(const FrameContext& frame);
    void find_planes(const FrameContext& frame);
    bool same_piece(std::size_t a, std::size_t b) const;
    void forget_touched(const Visibility& visible, const OccluderFinder& movers);
    void update_plane_tiles(const FrameContext& frame);
    void update_body(std::size_t body, std::uint8_t visible_faces, const FrameContext& frame);
    void update_lightmap(std::size_t body, const BodyPlace& pose, const OccluderFinder& movers);
    bool store(int x, int y, int width, int height, int stride, const float* open);
    void store_receiver_face(std::size_t body, int x, int y, int size, const float* open);

    Vec3 center_of(std::size_t body) const {  // of the bounding ball
        return Vec3(snapshot->bodies[body].origin - reference) +
               snapshot->bodies[body].orientation * scene.bodies[body].bound_center;
    }
    BodyPlace pose_of(std::size_t body) const {
        const BodyState& state = snapshot->bodies[body];
        return {state.origin - reference, center_of(body), state.orientation.toRotationMatrix()};
    }

    bool behind_plane(const Occluder& o) const {
        return std::any_of(planes.begin(), planes.end(), [&](const PlaneInView& plane) {
            const float reach = (o.to_local * plane.normal).cwiseAbs().dot(o.half_size) + o.radius;
            return plane.normal.dot(o.center) + plane.height <= -reach;
        });
    }

    const RenderScene& scene;
    const Vec3 reference;
    OcclusionAtlas atlas;
    int body_rows = 1;  // of the atlas; plane tiles are below them
    OcclusionChanges changes;
    const Snapshot* snapshot = nullptr;      // of the current update
    std::vector<Occluder> occluders, moved;  // of all bodies; of bodies that moved, at both poses
    std::vector<std::uint32_t> first;        // first occluder of each body, and the end
    OccluderFinder finder{{}};
    bool anew = true;  // everything is to be recomputed
    bool moved_much = false;
    std::vector<Made> made;
    std::vector<PlaneInView> planes, near_planes;
    PlaneOcclusion plane_occlusion;
    BodyOcclusion body_occlusion{scene};
    std::vector<std::size_t> found;                           // possible occluders of the current body
    std::vector<std::optional<LightmapOcclusion>> lightmaps;  // made when first visible
};

// True for a body itself, and for cells of a body that stand as they did in it: there is no gap between them.
bool AmbientOcclusion::State::same_piece(std::size_t a, std::size_t b) const {
    if (a == b) return true;
    const std::size_t whole = scene.bodies[a].whole;
    if (whole == RenderBody::no_whole || whole != scene.bodies[b].whole) return false;
    const BodyState &of_a = snapshot->bodies[a], &of_b = snapshot->bodies[b];
    return of_a.origin == of_b.origin && of_a.orientation.coeffs() == of_b.orientation.coeffs();
}

// Rebuilds the occluders of the bodies that moved, and finds these.
void AmbientOcclusion::State::follow(const FrameContext& frame) {
    snapshot = &frame.snapshot;
    const std::size_t bodies = scene.bodies.size();
    moved.clear();
    moved_much = false;
    if (first.empty()) {
        for (std::size_t i = 0; i < bodies; ++i) {
            first.push_back(std::uint32_t(occluders.size()));
            add_occluders(scene, i, snapshot->bodies[i], reference, occluders);
        }
        first.push_back(std::uint32_t(occluders.size()));
        finder = OccluderFinder(occluders);
        return;
    }
    const auto count = std::count(frame.moved.begin(), frame.moved.end(), char(1));
    if (count == 0) return;
    moved_much = double(count) > most_moved * double(bodies);
    std::vector<Occluder> now;
    for (std::size_t i = 0; i < bodies; ++i) {
        if (frame.moved[i] == 0) continue;
        made[i].faces = 0;
        now.clear();
        add_occluders(scene, i, snapshot->bodies[i], reference, now);
        const auto place = occluders.begin() + first[i];
        if (!moved_much) {
            moved.insert(moved.end(), place, place + std::ptrdiff_t(now.size()));
            moved.insert(moved.end(), now.begin(), now.end());
        }
        std::copy(now.begin(), now.end(), place);
    }
    finder = OccluderFinder(occluders);
}

void AmbientOcclusion::State::find_planes(const FrameContext& frame) {
    std::vector<PlaneInView> now;
    for (const std::size_t i : scene.planes) {
        const PlaneShape plane = plane_in_world(scene.bodies[i], snapshot->bodies[i]);
        if (plane.normal.dot(frame.camera.eye()) - plane.offset > 0.0)
            now.push_back({i, plane.normal.cast<float>(), float(plane.normal.dot(reference) - plane.offset)});
    }
    if (now != planes) anew = true;
    planes = std::move(now);
}

// Marks the bodies near an occluder that moved.
void AmbientOcclusion::State::forget_touched(const Visibility& visible, const OccluderFinder& movers) {
    if (anew || moved_much) {
        for (Made& body : made) body.faces = 0;
        return;
    }
    if (moved.empty()) return;
    for (std::size_t i = 0; i < made.size(); ++i)  // hidden bodies are updated when they become visible
        if (made[i].faces != 0 &&
            (!visible.bodies[i] || (scene.bodies[i].lightmap < 0 &&
                                    movers.any(center_of(i).cast<float>(), float(scene.bodies[i].bound_radius)))))
            made[i].faces = 0;
}

void AmbientOcclusion::State::update_plane_tiles(const FrameContext& frame) {
    ShelfPacker shelves(body_rows, OcclusionAtlas::most_rows);
    std::vector<PlaneOcclusionTile> tiles;
    const FrameOccluders around{frame, reference, occluders, moved, anew || moved_much};
    const auto keep = [&](int x, int y, int width, int height, int stride, const float* open) {
        const int needed = y + height;
        if (needed > atlas.height) {
            atlas.height = needed;
            atlas.texels.resize(std::size_t(needed) * OcclusionAtlas::width, 255);
        }
        store(x, y, width, height, stride, open);
    };
    for (const PlaneInView& plane : planes) {
        const auto known = std::find_if(atlas.plane_tiles.begin(), atlas.plane_tiles.end(),
                                        [&](const PlaneOcclusionTile& t) { return t.body == plane.body; });
        const PlaneOcclusionTile* last = known == atlas.plane_tiles.end() ? nullptr : &*known;
        if (const auto tile = plane_occlusion.update(plane, around, last, shelves, keep)) tiles.push_back(*tile);
    }
    changes.plane_tiles_moved = tiles != atlas.plane_tiles;
    atlas.plane_tiles = std::move(tiles);
}

// `stride`: distance between rows of the visibilities.
bool AmbientOcclusion::State::store(int x, int y, int width, int height, int stride, const float* open) {
    bool any = false;
    for (int row = y; row < y + height; ++row, open += stride) {
        std::uint8_t* to = &atlas.texels[std::size_t(row) * OcclusionAtlas::width + std::size_t(x)];
        int changed = 0;
        for (int i = 0; i < width; ++i) {
            const int value = level(open[i]);
            changed |= to[i] ^ value;
            to[i] = std::uint8_t(value);
        }
        if (changed == 0) continue;
        any = true;
        changes.first_row = std::min(changes.first_row, row);
        changes.end_row = std::max(changes.end_row, row + 1);
    }
    return any;
}

// Stores a face of a box part by part.
void AmbientOcclusion::State::store_receiver_face(std::size_t body, int x, int y, int size, const float* open) {
    const int face = (x - atlas.places[body].x) / size, axis = face / 2;
    const Vec3& half_size = scene.bodies[body].half_size;
    // A texel affects the surface as far as the centers of its neighbors.
    const auto on_face = [&](double column, double row) {
        const auto along = [&](double texel) { return std::clamp(2.0 * texel / (size - 1) - 1.0, -1.0, 1.0); };
        Vec3 at;
        at[axis] = face % 2 == 0 ? -1.0 : 1.0;
        at[(axis + 1) % 3] = along(column);
        at[(axis + 2) % 3] = along(row);
        return Vec3(at.cwiseProduct(half_size));
    };
    const auto differs = [&](int column, int row) {
        return atlas.texels[std::size_t(y + row) * OcclusionAtlas::width + std::size_t(x + column)] !=
               level(open[row * size + column]);
    };
    for (int j = 0; j < size; j += receiver_part)
        for (int i = 0; i < size; i += receiver_part) {
            int i0 = size, i1 = -1, j0 = size, j1 = -1;  // bounds of the texels that change
            for (int row = j; row < std::min(j + receiver_part, size); ++row)
                for (int column = i; column < std::min(i + receiver_part, size); ++column)
                    if (differs(column, row)) {
                        i0 = std::min(i0, column);
                        i1 = std::max(i1, column);
                        j0 = std::min(j0, row);
                        j1 = std::max(j1, row);
                    }
            if (i0 > i1) continue;
            store(x + i0, y + j0, i1 - i0 + 1, j1 - j0 + 1, size, open + j0 * size + i0);
            Bounds bounds;
            bounds.add(on_face(i0 - 1.1, j0 - 1.1));
            bounds.add(on_face(i1 + 1.1, j1 + 1.1));
            changes.patches.push_back({body, bounds});
        }
}

void AmbientOcclusion::State::update_body(std::size_t body, std::uint8_t visible_faces, const FrameContext& frame) {
    const RenderBody& proxy = scene.bodies[body];
    const Sizes& sizes = proxy.kind == DrawKind::box    ? box_sizes
                         : proxy.kind == DrawKind::ball ? ball_sizes
                                                        : mesh_sizes;
    const Vec3 middle = center_of(body);
    const double size = 2.0 * (proxy.kind == DrawKind::mesh ? proxy.bound_radius : proxy.half_size.maxCoeff());
    const double distance = std::max((middle + reference - frame.camera.eye()).norm(), 1e-30);
    const double pixels = size / (distance * frame.camera.pixel_size());
    const float lod = scene.bodies.size() < large_scene ? 1.0f : float(occlusion_lod(pixels, sizes.few, sizes.all));
    Made& known = made[body];
    if (known.lod != lod) known = {0, lod};
    const std::uint8_t requested = proxy.kind == DrawKind::box ? visible_faces : std::uint8_t(1);
    const auto missing = std::uint8_t(requested & ~known.faces);
    if (missing == 0) return;
    known.faces |= missing;

    const Eigen::Vector3f center = middle.cast<float>();
    finder.find(center, float(proxy.bound_radius), found);
    // A body does not occlude itself, nor others from behind a plane.
    std::erase_if(found,
                  [&](std::size_t i) { return same_piece(occluders[i].body, body) || behind_plane(occluders[i]); });
    near_planes.clear();
    for (const PlaneInView& plane : planes)
        if (plane.normal.dot(center) + plane.height < proxy.bound_radius + 2.0 * proxy.ao_radius)
            near_planes.push_back(plane);
    const Receiver receiver{proxy, atlas.places[body], pose_of(body), {occluders, found, near_planes}, lod};
    const auto keep = [&](int x, int y, int width, int height, const float* open) {
        return store(x, y, width, height, width, open);
    };
    const auto keep_receiver = [&](int x, int y, int width, int, const float* open) {
        store_receiver_face(body, x, y, width, open);
        return false;  // already in the changes
    };
    std::uint8_t faces = 0;
    bool changed = false;
    switch (proxy.kind) {
        case DrawKind::box:
            faces = body_occlusion.make_box(
                receiver, missing,
                proxy.large_receiver ? BodyOcclusion::Store(keep_receiver) : BodyOcclusion::Store(keep));
            changed = faces != 0;
            break;
        case DrawKind::ball:
            changed = body_occlusion.make_ball(receiver, keep);
            break;
        default:
            changed = body_occlusion.make_mesh(receiver, keep);
    }
    if (changed) changes.bodies.push_back({body, faces});
}

// forget_touched() has marked the bodies near occluders that moved, or all if many moved.
void AmbientOcclusion::State::update_lightmap(std::size_t body, const BodyPlace& pose, const OccluderFinder& movers) {
    const RenderBody& proxy = scene.bodies[body];
    Made& known = made[body];
    if (known.faces != 0 && moved.empty()) return;
    std::optional<LightmapOcclusion>& occlusion = lightmaps[body];
    const bool all = known.faces == 0;
    if (!occlusion || all) {
        if (!occlusion) occlusion.emplace();
        occlusion->place(
            {body, &scene.lightmaps[std::size_t(proxy.lightmap)], pose.origin, pose.axes, proxy.ao_radius});
    }
    known.faces = 1;
    const OcclusionPlace& at = atlas.places[body];
    occlusion->update(occluders, finder, all ? nullptr : &movers, planes,
                      [&](const OcclusionLightmap::Block& block, const float* open) {
                          if (store(at.x + block.x, at.y + block.y, block.width, block.height, block.width, open))
                              changes.patches.push_back({body, block.bounds});
                      });
}

AmbientOcclusion::AmbientOcclusion(const RenderScene& scene, const Vec3& reference)
    : state_(std::make_unique<State>(scene, reference)) {}
AmbientOcclusion::~AmbientOcclusion() = default;

const OcclusionAtlas& AmbientOcclusion::atlas() const { return state_->atlas; }
const OcclusionChanges& AmbientOcclusion::changes() const { return state_->changes; }

void AmbientOcclusion::update(const FrameContext& frame, const Visibility& visible) {
    State& s = *state_;
    s.changes = {};
    s.changes.first_row = OcclusionAtlas::most_rows;
    s.follow(frame);
    s.find_planes(frame);
    const OccluderFinder movers(s.moved);
    s.forget_touched(visible, movers);
    s.update_plane_tiles(frame);
    for (std::size_t i = 0; i < s.made.size(); ++i) {
        if (!visible.bodies[i] || s.atlas.places[i].size == 0) continue;
        if (s.scene.bodies[i].lightmap >= 0)
            s.update_lightmap(i, s.pose_of(i), movers);
        else
            s.update_body(i, visible.faces[i], frame);
    }
    s.anew = false;
    if (!frame.anew) return;
    s.changes.first_row = 0;  // changes before an exception were not uploaded
    s.changes.end_row = s.atlas.height;
}

}  // namespace tumble
