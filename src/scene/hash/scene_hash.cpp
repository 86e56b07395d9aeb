#include "scene/hash/scene_hash.h"

#include "core/color.h"
#include "core/sha256.h"
#include "core/vector.h"
#include "scene/fields/body_fields.h"
#include "scene/fields/camera_fields.h"
#include "scene/fields/force_fields.h"
#include "scene/fields/joint_fields.h"
#include "scene/fields/label_fields.h"
#include "scene/fields/overlay_fields.h"
#include "scene/fields/settings_fields.h"
#include "scene/fields/water_fields.h"

#include <array>
#include <bit>
#include <concepts>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <map>
#include <span>
#include <string>
#include <string_view>
#include <type_traits>
#include <vector>

namespace tumble {
namespace {

// Values as bytes for a hash: fixed widths, little-endian, numbers of elements first, so that no two sequences of
// values have the same bytes.

class ValueHash {
public:
    void add(const void*) = delete;  // an address is no value
    void add(bool value) { add_word(value ? 1 : 0); }
    void add(double value) { add_word(std::bit_cast<std::uint64_t>(value)); }
    void add(std::integral auto value) { add_word(std::uint64_t(std::int64_t(value))); }
    template <class T>
    requires std::is_enum_v<T>
    void add(T value) { add(std::underlying_type_t<T>(value)); }
    void add(std::string_view text) {
        add(text.size());
        add_bytes(std::as_bytes(std::span(text)));
    }
    void add(Color color) {
        const auto [r, g, b] = color;
        add(std::uint32_t(r) << 16 | std::uint32_t(g) << 8 | b);
    }

    std::string finish() {
        flush();
        return hash_.finish();
    }

protected:
    void add_word(std::uint64_t word) {
        static_assert(std::endian::native == std::endian::little);
        add_bytes(std::as_bytes(std::span(&word, 1)));
    }
    void add_bytes(std::span<const std::byte> bytes) {
        if (buffer_.size() + bytes.size() > buffer_size) flush();
        if (bytes.size() >= buffer_size)
            hash_.add(bytes);
        else
            buffer_.insert(buffer_.end(), bytes.begin(), bytes.end());
    }

private:
    static constexpr std::size_t buffer_size = 1 << 14;

    void flush() {
        hash_.add(buffer_);
        buffer_.clear();
    }

    Sha256 hash_;
    std::vector<std::byte> buffer_;
};

enum class Content { all, motion };

/// Adds each struct of a description by its fields (scene/fields), in their order. tests/scene/scene_hash_test.cpp
/// varies each key.
class DescriptionHash : public ValueHash, public FieldVisitor {
public:
    explicit DescriptionHash(Content content) : all_(content == Content::all) {}

    void add_scene(const SceneDescription& scene) {
        const auto& [file, title, simulation, output, camera, light, lamps, environment, wind, contact, forces, fields,
                     pair_forces, explosions, bodies, joints, cords, overlay, speed, water] = scene;
        add_value(simulation);
        add_value(output);
        add_value(wind);
        if (contact != PairRules{}) add_value(contact);  // other scenes keep their hash
        add_value(forces);
        if (!fields.empty()) add_value(fields);            // other scenes keep their hash
        if (!pair_forces.empty()) add_value(pair_forces);  // the same
        if (!explosions.empty()) add_value(explosions);
        if (water) add_value(*water);
        add_value(bodies);
        if (!joints.empty()) add_value(joints);  // scenes without joints keep their hash
        if (!all_) return;
        add_all(title, camera, light, cords, overlay);
        if (!lamps.empty()) add_value(lamps);      // as joints
        if (environment) add_value(*environment);  // as joints
        add_shown_file(scene);
        if (!speed.empty()) add_value(speed);  // other scenes keep their hash
    }

    void add_shown_file(const SceneDescription& scene) {
        const bool shows_file = scene.title.empty() && scene.overlay.show.has(Overlay::title);
        add_value(shows_file ? std::filesystem::path(scene.file).stem().string() : std::string());
    }

    // As a visitor of fields.
    void operator()(const auto& value, std::string_view key, const auto&, const About& about = {}) {
        if (!all_ && about.picture) return;
        if constexpr (requires { is_default(value); })
            if (about.later) {
                if (is_default(value)) return;
                add(key);
            }
        add_value(value);
    }
    void inner(const auto&... values) { add_all(values...); }
    void shown(const auto&... values) {
        if (all_) add_all(values...);
    }
    void instead(const auto&, const auto& value) { add_value(value); }
    void since(bool condition, const auto&... values) {
        if (condition) add_all(values...);
    }

    template <class T>
    std::string finish_with(const T& part) {
        add_value(part);
        return finish();
    }

private:
    // Defaults of fields that are newer than hashes in use.
    static bool is_default(CameraFit value) { return value == CameraFit{}; }
    static bool is_default(bool value) { return value; }
    static bool is_default(double value) { return value == 1.0; }
    template <class T>
    static bool is_default(const std::optional<T>& value) {
        return !value;
    }
    template <class T>
    static bool is_default(const std::vector<T>& values) {
        return values.empty();
    }

    template <class... Values>
    void add_all(const Values&... values) {
        (add_value(values), ...);
    }

    template <class T>
    requires requires(ValueHash hash, const T& value) { hash.add(value); }
    void add_value(const T& value) { add(value); }
    template <HasFields T>
    void add_value(const T& value) {
        visit_fields(Of<T>(), *this, value);
    }
    void add_value(const Vec3& v) { add_all(v.x(), v.y(), v.z()); }
    void add_value(const Quat& q) { add_all(q.w(), q.x(), q.y(), q.z()); }
    template <class T>
    void add_value(const std::optional<T>& value) {
        add(value.has_value());
        if (value) add_value(*value);
    }
    template <class T>
    void add_value(const std::vector<T>& values) {
        add(values.size());
        for (const T& value : values) add_value(value);
    }
    template <class T, std::size_t N>
    void add_value(const std::array<T, N>& values) {
        for (const T& value : values) add_value(value);
    }

    void add_value(const std::shared_ptr<const FractureDescription>& fracture) {
        if (!fracture) return;
        const FractureDescription& f = *fracture;  // pieces and bonds follow from the others
        add_value(static_cast<const FractureRequest&>(f));
        add_all(f.strength, f.shear_strength, f.compressive_strength, f.stiffness, f.toughness, f.blow_time);
        if (all_) add_value(f.inner_color);
    }
    void add_value(const MeshAsset::Vertex& vertex) {
        const auto& [position, normal] = vertex;
        add_bytes(std::as_bytes(std::span(position)));
        add_bytes(std::as_bytes(std::span(normal)));
    }
    void add_value(const TriangleMesh& mesh) {
        const auto& [vertices, triangles] = mesh;
        add_all(vertices, triangles);
    }
    void add_value(const MeshAsset& asset) {
        const auto& [file, doubled, mesh, vertices, indices, paint, convex] = asset;  // the shape has the paint
        add_value(mesh);
        add_all(vertices, indices);
    }
    void add_value(const Texture& texture) {
        const auto& [levels, least_alpha] = texture;  // the image defines the others
        add_all(levels.front().width, levels.front().height);
        add_bytes(std::as_bytes(std::span(levels.front().texels)));
    }
    void add_value(const std::shared_ptr<const Texture>& texture) { add_shared(texture); }
    void add_value(const EnvironmentImage& image) {
        const auto& [width, height, texels] = image;
        add_all(width, height);
        add_bytes(std::as_bytes(std::span(texels)));
    }
    void add_value(const std::shared_ptr<const EnvironmentImage>& image) {
        add(image != nullptr);
        if (image) add_shared(image);
    }
    void add_value(const MeshMaterial& material) {
        const auto& [color, roughness, metallic, emission, cutoff, texture, wrap_u, wrap_v, nearest, maps, opacity,
                     blends] = material;
        add_bytes(std::as_bytes(std::span(color)));
        add_bytes(std::as_bytes(std::span(emission)));
        add_all(double(roughness), double(metallic), double(cutoff), wrap_u, wrap_v, nearest, texture != nullptr);
        if (texture) add_shared(texture);
        if (maps.bits() != 0) add(maps.bits());  // other scenes keep their hash
        for (const SurfaceMaps::Map& map : {maps.normal, maps.surface, maps.emission})
            if (map) add_shared(map);
        if (material.translucent()) add_all(std::string_view("opacity"), double(opacity), blends);
    }
    void add_value(const MeshPaint& paint) {
        const auto& [materials, material_of_triangle, corners, mean, missing] =
            paint;  // the mean follows from the others
        add_all(materials, material_of_triangle);
        add_bytes(std::as_bytes(std::span(corners)));
    }
    void add_value(const PlaneShape& plane) {
        const auto& [normal, offset] = plane;
        add_all(normal, offset);
    }
    void add_value(const BoxShape& box) {
        const auto& [size] = box;
        add_value(size);
    }
    void add_value(const SphereShape& sphere) {
        const auto& [radius] = sphere;
        add_value(radius);
    }
    void add_value(const MeshShape& mesh) {
        const auto& [asset, mass_from, thickness, chosen, painted] = mesh;
        add_shared(asset);
        if (mass_from != MassFrom::solid) add_all(mass_from, thickness);  // other scenes keep their hash
        if (painted && all_) add_shared(asset->paint);
    }
    void add_value(const CompoundShape& compound) {
        const auto& [parts] = compound;
        add_shared(parts);
    }
    void add_value(const CurvedShape& curved) {
        const auto& [kind, radius, top_radius, height, radii, drawn] = curved;  // drawn follows from the others
        add_all(kind, radius, top_radius, height, radii);
    }
    void add_value(const Shape& shape) {
        add(shape.index());
        std::visit([&](const auto& one) { add_value(one); }, shape);
    }
    /// Data that several bodies may share, hashed once. Equal data counts as equal, shared or not.
    template <class T>
    void add_shared(const std::shared_ptr<const T>& data) {
        const auto [place, is_new] = hash_of_shared_.try_emplace(data.get());
        if (is_new) {
            DescriptionHash inner(all_ ? Content::all : Content::motion);
            inner.add_value(*data);
            place->second = inner.finish();
        }
        add(place->second);
    }

    void add_value(const OverlaySet& show) {
        for (const OverlayName& overlay : overlay_names)
            if (overlay.overlay != Overlay::cracks) add(show.has(overlay.overlay));
        if (show.has(Overlay::cracks)) add(std::string_view("cracks"));  // scenes without it keep their hash
    }
    bool all_;
    std::map<const void*, std::string> hash_of_shared_;  // looked up only: the order of addresses has no effect
};

std::string hash_of(const SceneDescription& scene, Content content) {
    DescriptionHash hash(content);
    hash.add(std::string_view(content == Content::all ? "tumble scene" : "tumble motion"));
    hash.add_scene(scene);
    return hash.finish();
}

}  // namespace

std::string scene_hash(const SceneDescription& scene) { return hash_of(scene, Content::all); }

std::string motion_hash(const SceneDescription& scene) { return hash_of(scene, Content::motion); }

std::vector<std::pair<std::string, std::string>> scene_parts(const SceneDescription& scene) {
    const auto& [file, title, simulation, output, camera, light, lamps, environment, wind, contact, forces, fields,
                 pair_forces, explosions, bodies, joints, cords, overlay, speed, water] = scene;
    const auto part = [](const auto& value) { return DescriptionHash(Content::all).finish_with(value); };
    SimulationSettings of_any_duration = simulation;
    of_any_duration.duration = 0.0;
    DescriptionHash text(Content::all);
    if (overlay.show.has(Overlay::title)) text.add(title);
    text.add_shown_file(scene);
    std::vector<std::pair<std::string, std::string>> parts{{"simulation", part(of_any_duration)},
                                                           {"camera", part(camera)},
                                                           {"light", part(light)},
                                                           {"wind", part(wind)},
                                                           {"forces", part(forces)},
                                                           {"bodies", part(bodies)}};
    if (!lamps.empty()) parts.emplace_back("lights", part(lamps));             // as in the hash
    if (environment) parts.emplace_back("environment", part(*environment));    // as in the hash
    if (contact != PairRules{}) parts.emplace_back("contact", part(contact));  // as in the hash
    if (!fields.empty()) parts.emplace_back("fields", part(fields));
    if (!pair_forces.empty()) parts.emplace_back("pair forces", part(pair_forces));
    if (!explosions.empty()) parts.emplace_back("explosions", part(explosions));
    if (water) parts.emplace_back("water", part(*water));
    if (!joints.empty()) parts.emplace_back("joints", part(joints));  // as in the hash
    parts.emplace_back("cords", part(cords));
    parts.emplace_back("overlay", text.finish_with(overlay));
    if (!speed.empty()) parts.emplace_back("speed", part(speed));  // as in the hash
    return parts;
}

}  // namespace tumble
