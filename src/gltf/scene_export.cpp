#include "gltf/scene_export.h"

#include "core/deterministic_math.h"
#include "core/vector.h"
#include "gltf/glb_buffer.h"
#include "gltf/painted_meshes.h"
#include "gltf/primitives.h"
#include "scene/description/looks.h"

#include <algorithm>
#include <map>
#include <optional>
#include <string>
#include <tuple>
#include <utility>

namespace tumble {
namespace {

constexpr double least_patch = 2.0, most_patch = 1000.0;  // m, half the side of a plane's square
constexpr double light_intensity = 3.0;                   // lux; viewers show white surfaces in it as white
constexpr double water_opacity = 0.7;                     // so that bodies below are seen in every viewer
constexpr double near_fraction = 1e-3;                    // near plane of the camera, of the distance to its target

Json vector_json(const Vec3& v) { return {v.x(), v.y(), v.z()}; }
Json quaternion_json(const Eigen::Vector4d& q) { return {q.x(), q.y(), q.z(), q.w()}; }

class SceneWriter {
public:
    explicit SceneWriter(const GltfExport& source) : source_(source), scene_(source.scene) {}

    std::vector<std::byte> write() {
        for (std::size_t i = 0; i < scene_.bodies.size(); ++i)
            if (scene_.bodies[i].appearance.visible) add_body(i);
        add_camera();
        add_light();
        if (scene_.water) add_water();
        return buffer_.finish(root());
    }

private:
    struct Geometry {
        std::size_t positions, normals, indices;  // accessors
    };
    struct Placed {
        std::size_t mesh;
        Vec3 scale;
    };
    using MaterialKey = std::tuple<int, int, int, double, double, double, std::array<double, 3>>;
    using TexturedKey = std::tuple<std::tuple<const Texture*, std::size_t, double, double, double, double>,
                                   std::array<const Texture*, 2>, MaterialKey, TextureFilter>;

    void add_body(std::size_t index);
    Json shape_node(const BodyDescription& body, const Shape& shape, const Appearance& look, const Vec3& place,
                    const Quat& rotation);
    Placed placed(const BodyDescription& body, const Shape& shape, const Appearance& look);
    Placed unit(std::optional<Geometry>& geometry, Triangles (*make)(), const Appearance& look, const Vec3& scale);
    std::size_t mesh(const Geometry& geometry, const Appearance& look);
    std::size_t material(const Appearance& look);
    static MaterialKey key_of(Color color, const Appearance& look) {
        return {color.r, color.g, color.b, look.roughness, look.metallic, look.opacity, to_linear(look.emission)};
    }
    Geometry add_triangles(const Triangles& triangles);
    Geometry asset(const MeshAsset& asset);
    Placed textured(const Shape& shape, const Triangles& unit, const Vec3& scale, const Appearance& look);
    std::size_t painted(const MeshAsset& asset, const MeshPaint& paint, const Appearance& look);
    Triangles patch(const BodyDescription& body, const PlaneShape& plane);
    void add_camera();
    void add_light();
    void add_water();
    void add_lamps();
    std::size_t add_node(Json node);
    void set_pose(Json& node, const PoseKeys& keys) const;
    void animate(std::size_t node, const PoseKeys& keys);
    void hide(std::size_t node, const Vec3& size, const std::vector<double>& absent_from);
    template <int N>
    void add_channel(std::size_t node, const char* path, const KeyTrack<N>& track);
    Json root() const;

    const GltfExport& source_;
    const SceneDescription& scene_;
    GlbBuffer buffer_;
    Json lights_ = Json::array();
    Json nodes_ = Json::array(), meshes_ = Json::array(), materials_ = Json::array();
    Json samplers_ = Json::array(), channels_ = Json::array(), top_ = Json::array();
    std::optional<Geometry> box_, sphere_;
    std::map<const MeshAsset*, Geometry> assets_;                         // only looked up: their order has no effect
    std::map<std::pair<std::size_t, std::size_t>, std::size_t> mesh_of_;  // by positions and material
    std::map<MaterialKey, std::size_t> material_of_;
    PaintedMeshes painted_meshes_{buffer_};
    std::map<std::pair<const MeshAsset*, MaterialKey>, std::size_t> painted_of_;  // only looked up
    std::map<TexturedKey, std::size_t> textured_of_;                              // only looked up
};

std::size_t SceneWriter::add_node(Json node) {
    nodes_.push_back(std::move(node));
    return nodes_.size() - 1;
}

void SceneWriter::set_pose(Json& node, const PoseKeys& keys) const {
    node["translation"] = vector_json(keys.position.keys().front().value.cast<double>());
    node["rotation"] = quaternion_json(keys.rotation.keys().front().value.cast<double>());
}

/// A node at the body's center of mass, whose path in flight is a parabola. Shapes that do not lie there are children.
void SceneWriter::add_body(std::size_t index) {
    const BodyDescription& body = scene_.bodies[index];
    const PoseKeys& keys = source_.motion.bodies()[index];
    const Vec3 origin = -source_.motion.node_place(index);
    Json node{{"name", body.name}};
    set_pose(node, keys);
    std::vector<Json> parts;
    Vec3 size = Vec3::Ones();
    if (const auto* compound = std::get_if<CompoundShape>(&body.shape)) {
        for (const CompoundPart& part : *compound->parts) {
            if (!part.visible) continue;
            Appearance look = body.appearance;
            look.color = plain_color(part.shape, part.color.value_or(look.color));
            parts.push_back(shape_node(body, part.shape, look, origin + part.position, part.rotation));
        }
    } else if (!origin.isZero(0.0)) {
        parts.push_back(shape_node(body, body.shape, body.appearance, origin, Quat::Identity()));
    } else {
        const Placed shape = placed(body, body.shape, body.appearance);
        if (shape.scale != Vec3::Ones()) node["scale"] = vector_json(shape.scale);
        size = shape.scale;
        node["mesh"] = shape.mesh;
    }
    if (!parts.empty()) {
        Json children = Json::array();
        for (Json& part : parts) children.push_back(add_node(std::move(part)));
        node["children"] = std::move(children);
    }
    const std::size_t number = add_node(std::move(node));
    top_.push_back(number);
    animate(number, keys);
    hide(number, size, source_.motion.absent_from()[index]);
}

Json SceneWriter::shape_node(const BodyDescription& body, const Shape& shape, const Appearance& look, const Vec3& place,
                             const Quat& rotation) {
    const Placed result = placed(body, shape, look);
    Json node{{"translation", vector_json(place)}};
    if (!rotation.isApprox(Quat::Identity(), 0.0)) node["rotation"] = quaternion_json(rotation.coeffs());
    if (result.scale != Vec3::Ones()) node["scale"] = vector_json(result.scale);
    node["mesh"] = result.mesh;
    return node;
}

SceneWriter::Placed SceneWriter::placed(const BodyDescription& body, const Shape& shape, const Appearance& look) {
    struct Form {
        SceneWriter& writer;
        const BodyDescription& body;
        const Appearance& look;
        Placed operator()(const BoxShape& box) {
            if (look.has_image()) return writer.textured(box, unit_box(), box.size, look);
            return writer.unit(writer.box_, unit_box, look, box.size);
        }
        Placed operator()(const SphereShape& ball) {
            if (look.has_image()) return writer.textured(ball, unit_sphere(), Vec3::Constant(ball.radius), look);
            return writer.unit(writer.sphere_, unit_sphere, look, Vec3::Constant(ball.radius));
        }
        Placed operator()(const PlaneShape& plane) {
            if (look.has_image()) return writer.textured(plane, writer.patch(body, plane), Vec3::Ones(), look);
            return {writer.mesh(writer.add_triangles(writer.patch(body, plane)), look), Vec3::Ones()};
        }
        Placed operator()(const MeshShape& shape) {
            if (const MeshPaint* paint = shape.paint())
                return {writer.painted(*shape.asset, *paint, look), Vec3::Ones()};
            return {writer.mesh(writer.asset(*shape.asset), look), Vec3::Ones()};
        }
        Placed operator()(const CurvedShape& shape) {
            if (shape.drawn->paint) return {writer.painted(*shape.drawn, *shape.drawn->paint, look), Vec3::Ones()};
            return {writer.mesh(writer.asset(*shape.drawn), look), Vec3::Ones()};
        }
        Placed operator()(const CompoundShape&) { return {}; }  // written part by part
    };
    return std::visit(Form{*this, body, look}, shape);
}

SceneWriter::Placed SceneWriter::unit(std::optional<Geometry>& geometry, Triangles (*make)(), const Appearance& look,
                                      const Vec3& scale) {
    if (!geometry) geometry = add_triangles(make());
    return {mesh(*geometry, look), scale};
}

std::size_t SceneWriter::mesh(const Geometry& geometry, const Appearance& look) {
    const std::size_t surface = material(look);
    const auto [place, is_new] = mesh_of_.try_emplace({geometry.positions, surface}, meshes_.size());
    if (is_new)
        meshes_.push_back(
            {{"primitives",
              Json::array({{{"attributes", {{"POSITION", geometry.positions}, {"NORMAL", geometry.normals}}},
                            {"indices", geometry.indices},
                            {"material", surface}}})}});
    return place->second;
}

std::size_t SceneWriter::material(const Appearance& look) {
    const Color mean = mean_color(look);
    const MaterialKey key = key_of(mean, look);
    const auto [place, is_new] = material_of_.try_emplace(key, materials_.size());
    if (is_new) {
        const std::array<double, 3> color = to_linear(mean);
        Json& made = materials_.emplace_back(Json{{"pbrMetallicRoughness",
                                                   {{"baseColorFactor", {color[0], color[1], color[2], look.opacity}},
                                                    {"metallicFactor", look.metallic},
                                                    {"roughnessFactor", look.roughness}}}});
        painted_meshes_.add_emission(to_linear(look.emission), made);
        if (look.opacity < 1.0) made["alphaMode"] = "BLEND";
    }
    return place->second;
}

SceneWriter::Geometry SceneWriter::add_triangles(const Triangles& triangles) {
    return {buffer_.add(triangles.positions, 3, GlbBuffer::Use::vertices, true),
            buffer_.add(triangles.normals, 3, GlbBuffer::Use::vertices, false), buffer_.add(triangles.indices)};
}

SceneWriter::Geometry SceneWriter::asset(const MeshAsset& asset) {
    const auto known = assets_.find(&asset);
    if (known != assets_.end()) return known->second;
    Triangles triangles;
    for (const MeshAsset::Vertex& vertex : asset.vertices) {
        triangles.positions.insert(triangles.positions.end(), vertex.position, vertex.position + 3);
        triangles.normals.insert(triangles.normals.end(), vertex.normal, vertex.normal + 3);
    }
    triangles.indices = asset.indices;
    return assets_.emplace(&asset, add_triangles(triangles)).first->second;
}

std::size_t SceneWriter::painted(const MeshAsset& asset, const MeshPaint& paint, const Appearance& look) {
    const auto [entry, is_new] = painted_of_.try_emplace({&asset, key_of(look.color, look)}, meshes_.size());
    if (is_new) meshes_.push_back({{"primitives", painted_meshes_.primitives(asset, paint, look, materials_)}});
    return entry->second;
}

/// A mesh of its own size, because the places of the texture depend on it.
SceneWriter::Placed SceneWriter::textured(const Shape& shape, const Triangles& unit, const Vec3& scale,
                                          const Appearance& look) {
    const TexturedKey key{{look.texture.get(), shape.index(), scale.x(), scale.y(), scale.z(), look.texture_scale},
                          {look.normal_map.get(), look.roughness_map.get()},
                          key_of(look.color, look),
                          look.texture_filter};
    const bool shared = !endless(shape);  // planes differ by their direction too
    if (const auto known = textured_of_.find(key); shared && known != textured_of_.end())
        return {known->second, Vec3::Ones()};
    MeshAsset asset;
    asset.indices = unit.indices;
    for (std::size_t i = 0; i < unit.positions.size(); i += 3) {
        MeshAsset::Vertex& vertex = asset.vertices.emplace_back();
        for (std::size_t c = 0; c < 3; ++c) {
            vertex.position[c] = float(scale[Eigen::Index(c)] * double(unit.positions[i + c]));
            vertex.normal[c] = unit.normals[i + c];
        }
    }
    const auto paint = texture_paint(shape, look, asset.vertices, asset.indices);
    meshes_.push_back({{"primitives", painted_meshes_.primitives(asset, *paint, look, materials_)}});
    if (shared) textured_of_.emplace(key, meshes_.size() - 1);
    return {meshes_.size() - 1, Vec3::Ones()};
}

/// A square of the plane below the motion of all bodies.
Triangles SceneWriter::patch(const BodyDescription& body, const PlaneShape& plane) {
    Bounds bounds = source_.motion.bounds();
    bounds.add(source_.camera.target);
    const Vec3 center = body.rotation.conjugate() * (bounds.center() - body.position);
    const double half_side = std::clamp(1.5 * bounds.extent().norm(), least_patch, most_patch);
    return square(center - (plane.normal.dot(center) - plane.offset) * plane.normal, plane.normal, half_side);
}

void SceneWriter::add_camera() {
    Json node{{"name", "camera"}, {"camera", 0}};
    set_pose(node, source_.motion.camera());
    const std::size_t number = add_node(std::move(node));
    top_.push_back(number);
    animate(number, source_.motion.camera());
}

void SceneWriter::add_light() {
    if (!scene_.lamps.empty()) return add_lamps();
    const Quat rotation = rotation_between(-Vec3::UnitZ(), scene_.light.direction);
    lights_.push_back({{"type", "directional"}, {"intensity", light_intensity}});
    top_.push_back(add_node({{"name", "light"},
                             {"rotation", quaternion_json(rotation.coeffs())},
                             {"extensions", {{"KHR_lights_punctual", {{"light", 0}}}}}}));
}

/// The still surface.
void SceneWriter::add_water() {
    Appearance look;
    look.color = scene_.water->color;
    look.pattern = Pattern::plain;
    look.roughness = 0.1;
    look.opacity = water_opacity;
    Json node = shape_node({}, PlaneShape{Vec3::UnitY(), scene_.water->level}, look, Vec3::Zero(), Quat::Identity());
    node["name"] = "water";
    top_.push_back(add_node(std::move(node)));
}

/// Points and spots of intensity 1 light a surface at 1 m as a sun of intensity 1 does.
void SceneWriter::add_lamps() {
    for (const LampDescription& lamp : scene_.lamps) {
        const std::array<double, 3> color = to_linear(lamp.color);
        constexpr const char* types[] = {"directional", "point", "spot"};
        Json light{{"type", types[int(lamp.type)]},
                   {"color", {color[0], color[1], color[2]}},
                   {"intensity", light_intensity * lamp.intensity}};
        if (lamp.type == LightType::spot) light["spot"] = {{"outerConeAngle", 0.5 * lamp.angle * pi / 180.0}};
        Json node{{"name", "light " + std::to_string(lights_.size())},
                  {"extensions", {{"KHR_lights_punctual", {{"light", lights_.size()}}}}}};
        if (lamp.type != LightType::point)
            node["rotation"] = quaternion_json(rotation_between(-Vec3::UnitZ(), lamp.direction).coeffs());
        if (lamp.type != LightType::sun) node["translation"] = vector_json(lamp.position);
        lights_.push_back(std::move(light));
        top_.push_back(add_node(std::move(node)));
    }
}

void SceneWriter::animate(std::size_t node, const PoseKeys& keys) {
    add_channel(node, "translation", keys.position);
    add_channel(node, "rotation", keys.rotation);
}

// A body that is absent has the scale 0, and otherwise `size`. `absent_from`: s, when it vanishes and appears in turn.
void SceneWriter::hide(std::size_t node, const Vec3& size, const std::vector<double>& absent_from) {
    if (absent_from.empty()) return;
    std::vector<float> times{0.0f}, sizes;
    for (const double time : absent_from)
        if (time > 0.0) times.push_back(float(time));
    bool shown = absent_from.front() > 0.0;
    for (std::size_t k = 0; k < times.size(); ++k, shown = !shown)
        for (int axis = 0; axis < 3; ++axis) sizes.push_back(shown ? float(size[axis]) : 0.0f);
    samplers_.push_back({{"input", buffer_.add(times, 1, GlbBuffer::Use::animation, true)},
                         {"interpolation", "STEP"},
                         {"output", buffer_.add(sizes, 3, GlbBuffer::Use::animation, false)}});
    channels_.push_back({{"sampler", samplers_.size() - 1}, {"target", {{"node", node}, {"path", "scale"}}}});
}

template <int N>
void SceneWriter::add_channel(std::size_t node, const char* path, const KeyTrack<N>& track) {
    if (track.keys().size() < 2) return;
    std::vector<float> times, values;
    const bool cubic = track.kind() == KeyKind::cubic;
    const auto add = [&](const Eigen::Matrix<float, N, 1>& part) {
        values.insert(values.end(), part.data(), part.data() + N);
    };
    for (const typename KeyTrack<N>::Key& key : track.keys()) {
        times.push_back(key.time);
        if (cubic) add(key.in);
        add(key.value);
        if (cubic) add(key.out);
    }
    samplers_.push_back({{"input", buffer_.add(times, 1, GlbBuffer::Use::animation, true)},
                         {"interpolation", cubic ? "CUBICSPLINE" : "LINEAR"},
                         {"output", buffer_.add(values, N, GlbBuffer::Use::animation, false)}});
    channels_.push_back({{"sampler", samplers_.size() - 1}, {"target", {{"node", node}, {"path", path}}}});
}

Json SceneWriter::root() const {
    const CameraDescription& camera = source_.camera;
    Json scene{{"nodes", top_}};
    if (!scene_.title.empty()) scene["name"] = scene_.title;
    Json root{{"asset",
               {{"version", "2.0"},
                {"generator", source_.generator},
                {"extras",
                 {{"duration", scene_.simulation.duration},
                  {"fps", scene_.output.fps},
                  {"largestPositionError", source_.motion.position_error()},
                  {"largestRotationError", source_.motion.rotation_error()},
                  {"momentsPerSecond", source_.moments_per_second},
                  {"errors",
                   "m and rad, of the keys (single precision) against the simulation at momentsPerSecond moments"}}}}},
              {"extensionsUsed", {"KHR_lights_punctual"}},
              {"extensions", {{"KHR_lights_punctual", {{"lights", lights_}}}}},
              {"scene", 0},
              {"scenes", Json::array({scene})},
              {"nodes", nodes_},
              {"cameras", Json::array({{{"type", "perspective"},
                                        {"perspective",
                                         {{"aspectRatio", double(scene_.output.width) / scene_.output.height},
                                          {"yfov", camera.vertical_fov * pi / 180.0},
                                          {"znear", near_fraction * (camera.eye - camera.target).norm()}}}}})}};
    if (!meshes_.empty()) {
        root["meshes"] = meshes_;
        root["materials"] = materials_;
        painted_meshes_.finish(root);
        if (painted_meshes_.bright()) root["extensionsUsed"].push_back("KHR_materials_emissive_strength");
    }
    if (!channels_.empty())
        root["animations"] = Json::array({{{"name", "motion"}, {"samplers", samplers_}, {"channels", channels_}}});
    return root;
}

}  // namespace

std::vector<std::byte> make_glb(const GltfExport& source) { return SceneWriter(source).write(); }

}  // namespace tumble
