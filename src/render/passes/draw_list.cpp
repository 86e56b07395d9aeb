#include "render/passes/draw_list.h"

#include "core/vector.h"
#include "render/antialiasing/surface_ids.h"
#include "render/gl/glm_conversion.h"
#include "render/passes/body_pass.h"
#include "render/scene/cord_ends.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <tuple>

namespace tumble {
namespace {

// Largest deviation of a ball's outline from the circle.
constexpr double outline_error = 0.15;  // pixels, or texels of a shadow map

// The angle between adjacent vertices of the icosahedron; each subdivision halves it.
constexpr double icosahedron_angle = 1.10714871779409;  // rad, atan 2

constexpr float cord_roughness = 0.7f;

// Draw order: by shells around the eye, the nearest first, and within a shell by mesh and shader. Hidden pixels are
// mostly rejected, and shader changes are few.
constexpr double shells_per_doubling = 8.0;  // per doubling of the distance

constexpr double shell_offset = 100000.0;  // keeps shell numbers positive

// A face of a box, another body or a cord, before sorting.
struct Item {
    std::uint64_t order = 0;  // key by shell, mesh and shader, see ordered()
    float distance = 0.0f;    // m
    bool cord = false;        // cords come after bodies
    std::uint32_t index = 0;  // of the body or of the cord
    std::uint32_t mesh = 0;
    std::uint8_t face = 0;  // of a box
    bool patterned = false, lit = true, spans_cascades = false;
    bool charted = false, painted = false;  // given by the mesh
    std::uint32_t look = 0;
    unsigned features = 0;
    MeshPart part = MeshPart::whole;
};

Item item_of(std::size_t index, std::size_t mesh) {
    Item item;
    item.index = std::uint32_t(index);
    item.mesh = std::uint32_t(mesh);
    return item;
}

// Sets the key. Without shells, as for shadow maps, all items of a mesh form one batch.
Item ordered(Item item, double distance, bool in_shells) {
    const double shell =
        in_shells ? std::floor(shells_per_doubling * std::log2(std::max(distance, 1e-30))) + shell_offset : 0.0;
    item.order = std::uint64_t(shell) << 44 | std::uint64_t(item.mesh) << 16 | std::uint64_t(item.look) << 3 |
                 (item.spans_cascades ? 4u : 0u) | (item.patterned ? 2u : 0u) | (item.lit ? 1u : 0u);
    item.distance = float(distance);
    return item;
}

// An edge of angle a lies at most r (1 - cos(a / 2)) = r a^2 / 8 inside the circle of radius r.
std::size_t ball_mesh_for(double radius, double error) {  // m
    std::size_t level = 0;
    double angle = icosahedron_angle;
    while (level + 1 < ball_levels && radius * angle * angle / 8.0 > error) {
        ++level;
        angle *= 0.5;
    }
    return first_ball_mesh + level;
}

// The bounding balls of bodies that exist come from their drawables.
BoundingBall ball_of(const DrawableBounds& bounds) { return {bounds.center, bounds.radius}; }

struct PlacedCord {
    Vec3 middle;
    double length;
    Quat turn;
};

PlacedCord place_cord(const CordDescription& cord, const Snapshot& snapshot, const Camera& camera) {
    const CordEnds ends = cord_ends(cord, snapshot);
    const Vec3 from = camera.relative(ends.anchor), to = camera.relative(ends.point);
    const double length = (to - from).norm();
    return {0.5 * (from + to), length,
            rotation_between(Vec3::UnitY(), length > 0.0 ? Vec3((to - from) / length) : Vec3(Vec3::UnitY()))};
}

// The half box has the faces on the high sides; they are mirrored to be those towards the sun.
void turn_to_light(Instance& half_box, const Quat& orientation, const Vec3& light) {
    const Vec3 there = orientation.conjugate() * light;
    for (int axis = 0; axis < 3; ++axis)
        half_box.scale[axis] = there[axis] > 0.0 ? -std::abs(half_box.scale[axis]) : std::abs(half_box.scale[axis]);
}

std::size_t mesh_of(const RenderBody& proxy, const RenderScene& scene, const BoundingBall& ball, const Camera& view) {
    switch (proxy.kind) {
        case DrawKind::ball:
            return ball_mesh_for(ball.radius, outline_error * view.pixel_size() *
                                                  std::max(ball.center.norm() - ball.radius, 1e-3 * ball.radius));
        case DrawKind::mesh:
            return scene_mesh(proxy.mesh, level_in_view(proxy, scene, ball.center, view));
        default:
            return half_box_mesh;
    }
}

// Level of detail for the resolution of the item's shadow map.
std::size_t caster_mesh(const RenderBody& proxy, const RenderScene& scene, const BoundingBall& ball, const Camera& view,
                        const ShadowCascades& shadows) {
    const double texel = shadows.may_look_far(ball.center, ball.radius)
                             ? std::min(shadows.near_texel, shadows.far_texel)
                             : shadows.near_texel;
    if (proxy.kind == DrawKind::ball)
        return scene.bodies.size() < large_scene ? mesh_of(proxy, scene, ball, view)
                                                 : ball_mesh_for(ball.radius, outline_error * texel);
    const MeshPaint* paint = scene.meshes[proxy.mesh].paint;
    if (paint && (paint->has_holes() || paint->translucent())) return scene_mesh(proxy.mesh, 0);
    return scene_mesh(proxy.mesh, level_for(proxy, scene, most_detail_error * texel));
}

// Appends the items' instances as batches of one mesh, nearest first; equal items keep the scene's order.
template <class Make>
std::vector<Batch> append_batches(std::vector<Item>& items, std::vector<Instance>& instances, const Make& make) {
    std::sort(items.begin(), items.end(), [](const Item& a, const Item& b) {
        return std::tie(a.order, a.distance, a.cord, a.index, a.face) <
               std::tie(b.order, b.distance, b.cord, b.index, b.face);
    });
    std::vector<Batch> batches;
    for (const Item& item : items) {
        if (batches.empty() || batches.back().mesh != item.mesh || batches.back().patterned != item.patterned ||
            batches.back().lit != item.lit || batches.back().spans_cascades != item.spans_cascades ||
            batches.back().look != item.look || batches.back().features != item.features ||
            batches.back().part != item.part)
            batches.push_back({item.mesh, item.patterned, item.lit, item.spans_cascades, item.charted, item.painted,
                               item.look, item.features, item.part, instances.size(), 0});
        instances.push_back(make(item));
        ++batches.back().count;
    }
    return batches;
}

class Builder {
public:
    Builder(const FrameContext& frame, const Visibility& visible, const OcclusionAtlas& atlas)
        : frame_(frame), visible_(visible), atlas_(atlas), light_(frame.scene.light.direction.normalized()) {}

    void add_body(std::size_t i, bool drawn, bool casts) {
        const RenderBody& proxy = frame_.scene.bodies[i];
        const BoundingBall ball = ball_of(frame_.drawables.bodies[i]);
        if (casts)
            add_caster(casters_, i,
                       proxy.kind == DrawKind::box
                           ? half_box_mesh
                           : caster_mesh(proxy, frame_.scene, ball, frame_.camera, frame_.cascades));
        if (frame_.lamp_map)
            add_caster(lamp_casters_, i,
                       proxy.kind == DrawKind::mesh ? scene_mesh(proxy.mesh, 0)
                                                    : mesh_of(proxy, frame_.scene, ball, frame_.camera));
        if (!drawn) return;
        if (proxy.kind == DrawKind::box)
            add_faces(i);
        else
            add_whole(i);
    }

    void add_cord(std::size_t i, bool drawn, bool casts) {
        cords_.push_back(place_cord(frame_.scene.cords[i], frame_.snapshot, frame_.camera));
        Item item = item_of(i, cylinder_mesh);
        item.cord = true;
        const double distance = cords_.back().middle.norm();
        if (drawn) drawn_.push_back(ordered(item, distance, true));
        if (casts) casters_.push_back(ordered(item, distance, false));
        if (frame_.lamp_map) lamp_casters_.push_back(ordered(item, distance, false));
    }

    DrawList take() {
        const auto instance = [&](const Item& item) {
            return item.cord ? cord_instance(item.index) : body_instance(item);
        };
        DrawList list;
        list.instances.reserve(drawn_.size() + translucent_.size() + casters_.size() + lamp_casters_.size());
        list.visible = append_batches(drawn_, list.instances, instance);
        list.translucent = append_batches(translucent_, list.instances, instance);
        list.casters = append_batches(casters_, list.instances, instance);
        list.lamp_casters = append_batches(lamp_casters_, list.instances, [&](const Item& item) {
            Instance made = instance(item);
            if (item.mesh == half_box_mesh)
                turn_to_light(made, frame_.snapshot.bodies[item.index].orientation,
                              frame_.lamp_map->light_at(frame_.drawables.bodies[item.index].center));
            return made;
        });
        return list;
    }

private:
    void add_caster(std::vector<Item>& casters, std::size_t i, std::size_t mesh) {
        const RenderBody& proxy = frame_.scene.bodies[i];
        Item item = item_of(i, mesh);
        const MeshPaint* paint = proxy.kind == DrawKind::mesh ? frame_.scene.meshes[proxy.mesh].paint : nullptr;
        if (proxy.translucent() || (paint && (paint->has_holes() || paint->translucent()))) {
            item.features = surface_feature::sieved;
            item.painted = paint != nullptr;
        }
        casters.push_back(ordered(item, frame_.drawables.bodies[i].center.norm(), false));
    }

    bool spans_cascades(const DrawableBounds& bounds) const {
        return frame_.scene.light.shadows && frame_.cascades.spans_maps(bounds.center, bounds.radius);
    }

    void add_whole(std::size_t i) {
        const RenderBody& proxy = frame_.scene.bodies[i];
        const DrawableBounds& bounds = frame_.drawables.bodies[i];
        Item item = item_of(i, mesh_of(proxy, frame_.scene, ball_of(bounds), frame_.camera));
        item.patterned = proxy.pattern != Pattern::panel;
        item.look = std::uint32_t(proxy.look);
        item.spans_cascades = spans_cascades(bounds);
        if (proxy.kind == DrawKind::mesh) {
            item.charted = frame_.scene.meshes[proxy.mesh].charts.has_value();
            item.painted = frame_.scene.meshes[proxy.mesh].paint != nullptr;
        }
        item.features = features_of(proxy, frame_.scene);
        const MeshPaint* paint = item.painted ? frame_.scene.meshes[proxy.mesh].paint : nullptr;
        if (paint && paint->translucent() && !proxy.translucent()) {
            item.part = MeshPart::translucent;
            item.features |= surface_feature::translucent;
            add_drawn(item, bounds.center.norm());
            item.part = MeshPart::opaque;
            item.features &= ~surface_feature::translucent;
        }
        add_drawn(item, bounds.center.norm());
    }

    void add_drawn(Item item, double distance) {
        item = ordered(item, distance, true);
        if ((item.features & surface_feature::translucent) == 0) return drawn_.push_back(item);
        item.order = ~std::uint64_t(std::bit_cast<std::uint32_t>(float(distance)));  // the farthest first
        translucent_.push_back(item);
    }

    // Visible faces of a box: lit ones are separate from unlit ones.
    void add_faces(std::size_t i) {
        const DrawableBounds& bounds = frame_.drawables.bodies[i];
        const Vec3 there = frame_.snapshot.bodies[i].orientation.conjugate() * light_;
        Item item = item_of(i, face_mesh);
        item.patterned = frame_.scene.bodies[i].pattern != Pattern::panel;
        item.look = std::uint32_t(frame_.scene.bodies[i].look);
        item.features = features_of(frame_.scene.bodies[i], frame_.scene);
        for (int face = 0; face < 6; ++face) {
            if ((visible_.faces[i] >> face & 1) == 0) continue;
            item.face = std::uint8_t(face);
            item.lit = there[face / 2] * (face % 2 == 0 ? -1.0 : 1.0) < 0.0;
            item.spans_cascades = item.lit && spans_cascades(bounds);
            add_drawn(item, bounds.center.norm());
        }
    }

    Instance body_instance(const Item& item) const {
        const RenderBody& proxy = frame_.scene.bodies[item.index];
        const BodyState& state = frame_.snapshot.bodies[item.index];
        const DrawableBounds& bounds = frame_.drawables.bodies[item.index];
        const OcclusionPlace& place = atlas_.places[item.index];
        const bool open_mesh = proxy.kind == DrawKind::mesh && !frame_.scene.meshes[proxy.mesh].closed;
        Instance made{};
        made.position = to_glm(frame_.camera.relative(state.origin));
        made.bevel = float(proxy.bevel);
        made.orientation = to_glm(state.orientation);
        made.scale = to_glm(proxy.half_size);
        made.pattern_cell = float(proxy.pattern_cell);
        made.color = proxy.color;
        made.roughness = proxy.roughness;
        made.metallic = proxy.metallic;
        made.pattern = pattern_number(proxy.pattern);
        made.paint = proxy.paint;
        made.glow = proxy.glow;
        made.atlas_place = glm::vec2(float(place.x), float(place.y));
        made.tile_size = float(place.size);
        made.face = open_mesh ? 1.0f : float(item.face);
        made.surface_id = surface_alpha(item.index, item.face);
        made.near_shadows = frame_.cascades.near_holds(bounds.center, bounds.radius) ? 1.0f : 0.0f;
        if (item.mesh == half_box_mesh) turn_to_light(made, state.orientation, light_);
        return made;
    }

    Instance cord_instance(std::size_t i) const {
        const CordDescription& cord = frame_.scene.cords[i];
        const PlacedCord& place = cords_[i];
        const std::array<double, 3> color = to_linear(cord.color);
        Instance made{};
        made.position = to_glm(place.middle);
        made.orientation = to_glm(place.turn);
        made.scale = to_glm(Vec3(cord.radius, std::max(0.5 * place.length, 1e-3 * cord.radius), cord.radius));
        made.pattern_cell = float(cord.radius);
        made.color = glm::vec3(float(color[0]), float(color[1]), float(color[2]));
        made.roughness = cord_roughness;
        made.surface_id = surface_alpha(frame_.scene.bodies.size() + i, 0);
        made.near_shadows = frame_.cascades.near_holds(place.middle, 0.5 * place.length + cord.radius) ? 1.0f : 0.0f;
        return made;
    }

    const FrameContext& frame_;
    const Visibility& visible_;
    const OcclusionAtlas& atlas_;
    Vec3 light_;  // unit, direction in which the light travels
    std::vector<PlacedCord> cords_;
    std::vector<Item> drawn_, translucent_, casters_, lamp_casters_;
};

}  // namespace

DrawList make_draw_list(const FrameContext& frame, const Visibility& visible, const OcclusionAtlas& atlas,
                        const DrawableMask& drawn, const DrawableMask& casters) {
    Builder builder(frame, visible, atlas);
    const bool shadows = frame.scene.light.shadows;
    for (std::size_t i = 0; i < frame.drawables.bodies.size(); ++i)
        if (frame.drawables.bodies[i].exists())
            builder.add_body(i, visible.bodies[i] && drawn.bodies[i] != 0, shadows && casters.bodies[i] != 0);
    for (std::size_t i = 0; i < frame.drawables.cords.size(); ++i)
        builder.add_cord(i, drawn.cords[i] != 0, shadows && casters.cords[i] != 0);
    return builder.take();
}

}  // namespace tumble
