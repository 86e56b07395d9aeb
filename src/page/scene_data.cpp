#include "page/scene_data.h"

#include "core/deterministic_math.h"
#include "overlay/overlay_builder.h"
#include "page/prediction.h"
#include "scene/description/lamps.h"
#include "scene/description/looks.h"
#include "scene/description/painted_mesh.h"
#include "scene/fields/body_fields.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <utility>

namespace tumble {
namespace {

using Json = ArrayStore::Json;

constexpr double place_steps = 65535.0, normal_steps = 511.0;  // of a mesh's extent, and of a unit vector
constexpr double uv_steps = 16384.0, color_steps = 1023.0;     // of a texture's side, and of square roots of colors
constexpr int most_texels = 512;                               // of a side of a texture on a page
constexpr double camera_quantum = 1e-6;                        // m, and degrees

Json quaternion_json(const Quat& q) { return {q.w(), q.x(), q.y(), q.z()}; }

Json shape_json(const Shape& shape, const Appearance& look, MeshTable& meshes);

Json part_json(const CompoundPart& part, const Appearance& look, MeshTable& meshes) {
    Json json{{"shape", shape_json(part.shape, look, meshes)},
              {"position", vector_json(part.position)},
              {"rotation", quaternion_json(part.rotation)},
              {"color", to_string(plain_color(part.shape, part.color.value_or(look.color)))}};
    Appearance of_part = look;
    of_part.color = part.color.value_or(look.color);
    if (two_colored(look)) json["pattern_color"] = to_string(second_color(of_part));
    return json;
}

struct ShapeForm {
    const Appearance& look;
    MeshTable& meshes;

    Json operator()(const PlaneShape& plane) {
        return {{"type", "plane"}, {"normal", vector_json(plane.normal)}, {"offset", plane.offset}};
    }
    Json operator()(const BoxShape& box) { return {{"type", "box"}, {"size", vector_json(box.size)}}; }
    Json operator()(const SphereShape& ball) { return {{"type", "sphere"}, {"radius", ball.radius}}; }
    Json operator()(const MeshShape& mesh) {
        return {{"type", "mesh"}, {"mesh", meshes.index_of(*mesh.asset, mesh.paint())}};
    }
    Json operator()(const CurvedShape& curved) {
        return {{"type", "mesh"}, {"mesh", meshes.index_of(*curved.drawn, curved.drawn->paint.get())}};
    }
    Json operator()(const CompoundShape& compound) {
        Json parts = Json::array();
        for (const CompoundPart& part : *compound.parts)
            if (part.visible) parts.push_back(part_json(part, look, meshes));
        return {{"type", "compound"}, {"parts", std::move(parts)}};
    }
};

Json shape_json(const Shape& shape, const Appearance& look, MeshTable& meshes) {
    return std::visit(ShapeForm{look, meshes}, shape);
}

Json inertia_json(const Mat3& inertia) {
    Json rows = Json::array();
    for (int r = 0; r < 3; ++r)
        for (int c = 0; c < 3; ++c) rows.push_back(inertia(r, c));
    return rows;
}

std::vector<std::int64_t> whole_numbers(std::span<const double> values, double quantum) {
    std::vector<std::int64_t> whole;
    for (const double value : values) whole.push_back(std::llround(value / quantum));
    return whole;
}

/// Adds the fields of a struct.
struct JsonFields : FieldVisitor {
    void operator()(Color value, std::string_view key, const auto&, const About& = {}) { json[key] = to_string(value); }
    void operator()(Pattern value, std::string_view key, const auto&, const About& = {}) { json[key] = name_of(value); }
    void operator()(auto value, std::string_view key, const auto&, const About& = {}) { json[key] = value; }

    Json& json;
};

/// One value of each item, predicted.
template <class Item, class Value>
Json column(const std::vector<Item>& items, ArrayStore& arrays, const Value& value) {
    std::vector<std::int64_t> whole;
    whole.reserve(items.size());
    for (const Item& item : items) whole.push_back(std::llround(value(item)));
    const int order = predict(whole);
    return {order, arrays.add(whole)};
}

/// The map of the largest side that pages have.
Json image_json(const Texture& texture, bool with_alpha, ArrayStore& arrays) {
    const auto level = std::ranges::find_if(
        texture.levels, [](const Texture::Level& map) { return std::max(map.width, map.height) <= most_texels; });
    Json channels = Json::array();
    for (std::size_t c = 0; c < (with_alpha ? 4u : 3u); ++c)
        channels.push_back(column(level->texels, arrays, [c](const auto& texel) { return double(texel[c]); }));
    return {{"width", level->width}, {"height", level->height}, {"channels", std::move(channels)}};
}

/// The texture and its wrapping. Null without one.
Json texture_json(const MeshMaterial& material, ArrayStore& arrays) {
    if (!material.texture && material.maps.bits() == 0 && !material.translucent()) return nullptr;
    const bool with_alpha = material.has_holes() || material.blends;
    const Texture white{{{1, 1, {{255, 255, 255, 255}}}}, 255};
    Json json = image_json(material.texture ? *material.texture : white, with_alpha, arrays);
    const auto name = [](TextureWrap wrap) {
        return wrap == TextureWrap::repeat ? "repeat" : wrap == TextureWrap::mirror ? "mirror" : "clamp";
    };
    json["wrap"] = {name(material.wrap_u), name(material.wrap_v)};
    json["nearest"] = material.nearest;
    json["cutoff"] = material.has_holes() ? material.cutoff : 0.0f;
    const auto add = [&](const char* key, const SurfaceMaps::Map& map) {
        if (map) json[key] = image_json(*map, false, arrays);
    };
    add("normal_map", material.maps.normal);
    add("surface_map", material.maps.surface);
    add("emission_map", material.maps.emission);
    if (material.translucent()) json["opacity"] = material.opacity;
    return json;
}

Json paint_json(const PaintedMesh& mesh, ArrayStore& arrays) {
    Json uv = Json::array(), color = Json::array(), surface = Json::array(), emission = Json::array();
    for (std::size_t c = 0; c < 3; ++c) {
        color.push_back(column(mesh.paint, arrays, [c](const VertexPaint& vertex) {
            return color_steps * std::sqrt(double(vertex.color[c]));
        }));
        emission.push_back(column(mesh.paint, arrays, [c](const VertexPaint& vertex) {
            return color_steps * std::sqrt(double(vertex.emission[c]));
        }));
    }
    for (std::size_t c = 0; c < 2; ++c) {
        uv.push_back(
            column(mesh.paint, arrays, [c](const VertexPaint& vertex) { return uv_steps * double(vertex.uv[c]); }));
        surface.push_back(column(mesh.paint, arrays,
                                 [c](const VertexPaint& vertex) { return color_steps * double(vertex.surface[c]); }));
    }
    Json groups = Json::array();
    for (const PaintedMesh::Range& range : mesh.ranges)
        groups.push_back(
            {{"first", range.first}, {"count", range.count}, {"texture", texture_json(*range.material, arrays)}});
    return {{"uv_steps", uv_steps},       {"color_steps", color_steps},    {"uv", std::move(uv)},
            {"color", std::move(color)},  {"surface", std::move(surface)}, {"emission", std::move(emission)},
            {"groups", std::move(groups)}};
}

Json mesh_json(const MeshAsset& asset, const MeshPaint* paint, ArrayStore& arrays) {
    PaintedMesh painted;
    std::vector<MeshAsset::Vertex> vertices = asset.vertices;
    if (paint != nullptr) {
        painted = paint_mesh(asset.indices, *paint);
        vertices.clear();
        for (const std::uint32_t source : painted.source) vertices.push_back(asset.vertices[source]);
    }
    Bounds bounds;
    for (const MeshAsset::Vertex& v : vertices) bounds.add(Vec3(v.position[0], v.position[1], v.position[2]));
    const double quantum = std::max(bounds.extent().maxCoeff() / place_steps, 1e-12);
    Json positions = Json::array(), normals = Json::array();
    for (int c = 0; c < 3; ++c) {
        std::vector<std::int64_t> places, directions;
        for (const MeshAsset::Vertex& v : vertices) {
            places.push_back(std::llround((double(v.position[c]) - bounds.min[c]) / quantum));
            directions.push_back(std::llround(double(v.normal[c]) * normal_steps));
        }
        const int place_order = predict(places), direction_order = predict(directions);
        positions.push_back({place_order, arrays.add(places)});
        normals.push_back({direction_order, arrays.add(directions)});
    }
    const std::vector<std::uint32_t>& drawn = paint != nullptr ? painted.indices : asset.indices;
    std::vector<std::int64_t> indices(drawn.begin(), drawn.end());
    const int order = predict(indices);
    Json json{{"min", vector_json(vertices.empty() ? Vec3(Vec3::Zero()) : bounds.min)},
              {"quantum", quantum},
              {"positions", std::move(positions)},
              {"normals", std::move(normals)},
              {"indices", {order, arrays.add(indices)}}};
    if (paint != nullptr) json["paint"] = paint_json(painted, arrays);
    return json;
}

}  // namespace

Json vector_json(const Vec3& v) { return {v.x(), v.y(), v.z()}; }

std::size_t MeshTable::index_of(const MeshAsset& asset, const MeshPaint* paint) {
    const auto [entry, is_new] = index_.try_emplace({&asset, paint}, meshes_.size());
    if (is_new) meshes_.push_back({&asset, paint});
    return entry->second;
}

std::size_t MeshTable::index_of(const Texture& texture) {
    const auto known = std::ranges::find(textures_, &texture);
    if (known == textures_.end()) return textures_.push_back(&texture), textures_.size() - 1;
    return std::size_t(known - textures_.begin());
}

Json MeshTable::write_textures(ArrayStore& arrays) const {
    Json all = Json::array();
    for (const Texture* texture : textures_) all.push_back(image_json(*texture, false, arrays));
    return all;
}

Json MeshTable::write(ArrayStore& arrays) const {
    Json all = Json::array();
    for (const auto& [asset, paint] : meshes_) all.push_back(mesh_json(*asset, paint, arrays));
    return all;
}

/// Null: the value of the other body.
Json surface_json(double value) { return value < 0.0 ? Json() : Json(value); }

Json make_bodies(const PageRun& run, MeshTable& meshes) {
    Json bodies = Json::array();
    for (std::size_t i = 0; i < run.scene.bodies.size(); ++i) {
        const BodyDescription& body = run.scene.bodies[i];
        const BodyReport& report = run.reports[i];
        const Appearance& look = body.appearance;
        const bool dynamic = body.type == BodyType::dynamic;
        Json& one = bodies.emplace_back(
            Json{{"name", body.name}, {"type", name_of(body.type)}, {"shape", shape_json(body.shape, look, meshes)}});
        JsonFields fields{{}, one};
        visit_fields(Of<Appearance>(), fields, look);
        if (two_colored(look)) one["pattern_color"] = to_string(second_color(look));
        if (look.pattern_scale > 0.0) one["pattern_scale"] = look.pattern_scale;
        if (look.texture)
            one["texture"] = {{"image", meshes.index_of(*look.texture)},
                              {"scale", look.texture_scale},
                              {"nearest", look.texture_filter == TextureFilter::nearest}};
        if (look.normal_map) one["normal_map"] = meshes.index_of(*look.normal_map);
        if (look.roughness_map) one["roughness_map"] = meshes.index_of(*look.roughness_map);
        if (!look.texture && look.has_image())
            one["texture"] = {{"image", nullptr},
                              {"scale", look.texture_scale},
                              {"nearest", look.texture_filter == TextureFilter::nearest}};
        if (look.opacity < 1.0) one["opacity"] = look.opacity;
        if (look.emission != Color{0, 0, 0}) one["emission"] = to_string(look.emission);
        one["mass"] = dynamic ? report.mass : 0.0;
        one["inertia"] = inertia_json(dynamic ? report.inertia : Mat3(Mat3::Zero()));
        one["center_of_mass"] = vector_json(report.center_of_mass);
        one["restitution"] = surface_json(body.restitution_in_pair());
        one["friction"] = surface_json(body.friction_in_pair());
    }
    return bodies;
}

Json make_light(const PageRun& run) {
    const SceneDescription& scene = run.scene;
    Json json{{"direction", vector_json(scene.light.direction)}, {"shadows", scene.light.shadows}};
    if (scene.lamps.empty()) return json;
    const auto light_json = [](const std::array<double, 3>& light) { return Json{light[0], light[1], light[2]}; };
    const auto sun = main_sun(scene.lamps);
    json["color"] = light_json(sun ? strength_of(scene.lamps[*sun]) : std::array<double, 3>{});
    json["others"] = Json::array();
    for (std::size_t i = 0; i < scene.lamps.size(); ++i) {
        const LampDescription& lamp = scene.lamps[i];
        if (i == sun) continue;
        json["others"].push_back(
            {{"kind", int(lamp.type)},
             {"place", vector_json(lamp.type == LightType::sun ? Vec3(-lamp.direction) : lamp.position)},
             {"light", light_json(strength_of(lamp))},
             {"axis", vector_json(lamp.direction)},
             {"cosine", sincos(0.5 * lamp.angle * pi / 180.0).cos}});
    }
    return json;
}

Json make_cords(const PageRun& run) {
    Json cords = Json::array();
    for (const CordDescription& cord : run.scene.cords) {
        cords.push_back({{"body", cord.body},
                         {"point", vector_json(cord.point)},
                         {"anchor", vector_json(cord.anchor)},
                         {"radius", cord.radius},
                         {"color", to_string(cord.color)}});
        if (cord.anchor_body) cords.back()["anchor_body"] = *cord.anchor_body;
    }
    return cords;
}

Json make_camera(const PageRun& run, ArrayStore& arrays) {
    const bool moves = run.cameras.size() > 1;
    const CameraDescription& first = run.cameras.front();
    Json json{{"eye", vector_json(first.eye)},
              {"target", vector_json(first.target)},
              {"up", vector_json(first.up)},
              {"vertical_fov", first.vertical_fov}};
    if (!moves) return json;
    std::array<std::vector<double>, 10> columns;
    for (const CameraDescription& camera : run.cameras) {
        for (int c = 0; c < 3; ++c) {
            columns[std::size_t(c)].push_back(camera.eye[c]);
            columns[std::size_t(3 + c)].push_back(camera.target[c]);
            columns[std::size_t(6 + c)].push_back(camera.up[c]);
        }
        columns[9].push_back(camera.vertical_fov);
    }
    Json frames = Json::array();
    for (const auto& column : columns) {
        std::vector<std::int64_t> whole = whole_numbers(column, camera_quantum);
        const int order = predict(whole);
        frames.push_back({order, arrays.add(whole)});
    }
    json["quantum"] = camera_quantum;
    json["frames"] = std::move(frames);
    return json;
}

Json make_water(const SceneDescription& scene) {
    const WaterSurface surface(*scene.water, scene.simulation.gravity.norm());
    Json waves = Json::array();
    for (const WaterSurface::Wave& wave : surface.waves())
        waves.push_back({{"k", {wave.k.x(), wave.k.z()}},
                         {"amplitude", wave.amplitude},
                         {"rate", wave.rate},
                         {"phase", wave.phase}});
    return {{"level", surface.level()}, {"color", to_string(scene.water->color)}, {"waves", std::move(waves)}};
}

Json make_overlays(const PageRun& run) {
    const OverlayDescription& overlay = run.scene.overlay;
    Json show = Json::array(), bodies = Json::array(), scale, color, points = Json::array();
    for (const OverlayName& name : overlay_names)
        if (overlay.show.has(name.overlay)) show.push_back(name.name);
    const std::vector<char> shown = shown_bodies(run.scene);
    for (std::size_t i = 0; i < shown.size(); ++i)
        if (shown[i] != 0) bodies.push_back(i);
    for (const auto& [name, quantity] : choices<ArrowQuantity>) {
        scale[name] = run.scales[std::size_t(quantity)];
        color[name] = to_string(arrow_color(overlay, quantity));
    }
    for (const TrailPoint& point : overlay.trail_points)
        points.push_back({{"body", point.body},
                          {"point", vector_json(point.point)},
                          {"color", point.color ? Json(to_string(*point.color)) : Json(nullptr)}});
    return {{"show", std::move(show)},
            {"bodies", std::move(bodies)},
            {"scale", std::move(scale)},
            {"color", std::move(color)},
            {"impulse_time", overlay.impulse_time},
            {"trail_time", overlay.trail_time == infinity ? Json(nullptr) : Json(overlay.trail_time)},
            {"trail_points", std::move(points)},
            {"ghost_every", overlay.ghost_every},
            {"plot", overlay.plot}};
}

}  // namespace tumble
