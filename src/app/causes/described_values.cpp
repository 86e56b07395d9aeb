#include "app/causes/run_recorder.h"

#include "core/fnv_hash.h"
#include "core/frame_rate.h"
#include "scene/fields/body_fields.h"
#include "scene/fields/settings_fields.h"
#include "scene/hash/scene_hash.h"
#include "sim/geometry/shapes/shape.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <concepts>
#include <string>
#include <variant>
#include <vector>

namespace tumble {
namespace {

std::string text_of(const Vec3& v) { return fmt::format("[{}, {}, {}]", v.x(), v.y(), v.z()); }
std::string text_of(const Quat& q) { return fmt::format("[{}, {}, {}, {}]", q.w(), q.x(), q.y(), q.z()); }
std::string text_of(Color color) { return to_string(color); }
std::string text_of(std::integral auto value) { return fmt::format("{}", value); }
std::string text_of(std::floating_point auto value) { return fmt::format("{}", value); }
/// A name; records have numbers of these three.
template <Named Enum>
std::string text_of(Enum value) {
    constexpr bool numbered =
        std::same_as<Enum, IntegratorKind> || std::same_as<Enum, ContactSolverChoice> || std::same_as<Enum, PairRule>;
    return numbered ? fmt::format("{}", int(value)) : std::string(name_of(value));
}

/// Adds the fields of a struct.
struct FieldValues : FieldVisitor {
    void operator()(const auto& value, std::string_view key, const auto&, const About& = {}) {
        values[fmt::format("{}{}", prefix, key)] = text_of(value);
    }

    ValueMap& values;
    std::string_view prefix;
};

template <HasFields Struct>
void add_fields(const Struct& from, ValueMap& values, std::string_view prefix = "") {
    FieldValues visitor{{}, values, prefix};
    visit_fields(Of<Struct>(), visitor, from);
}

/// Text that is too long to be shown: two of them are the same or not.
std::string digest_text(const std::string& text) {
    return fmt::format("#{:016x}", fnv_hash(std::as_bytes(std::span(text))));
}

std::string shape_text(const Shape& shape);

struct ShapeText {
    std::string operator()(const PlaneShape& s) const {
        return fmt::format("plane {} at {}", text_of(s.normal), s.offset);
    }
    std::string operator()(const BoxShape& s) const { return "box " + text_of(s.size); }
    std::string operator()(const SphereShape& s) const { return fmt::format("sphere of radius {}", s.radius); }
    std::string operator()(const MeshShape& s) const {
        const MeshAsset& asset = *s.asset;
        std::uint64_t sum = fnv_hash(std::as_bytes(std::span(asset.vertices)));
        sum = fnv_hash(std::as_bytes(std::span(asset.indices)), sum);
        return fmt::format("mesh of {} triangles #{:016x}", asset.indices.size() / 3, sum);
    }
    std::string operator()(const CurvedShape& s) const {
        if (s.kind == CurvedKind::ellipsoid) return "ellipsoid " + text_of(s.radii);
        return fmt::format("{} of radius {} to {}, height {}", name_of(s.kind), s.radius, s.top_radius, s.height);
    }
    std::string operator()(const CompoundShape& s) const {
        std::string all;
        for (const CompoundPart& part : *s.parts) {
            all +=
                fmt::format("{} {} {} {} {};", shape_text(part.shape), text_of(part.position), text_of(part.rotation),
                            part.density.value_or(-1.0), part.color ? to_string(*part.color) : "");
            if (!part.collide) all += "does not collide;";
            if (!part.visible) all += "hidden;";
        }
        return fmt::format("compound of {} {}", s.parts->size(), digest_text(all));
    }
};

std::string shape_text(const Shape& shape) { return std::visit(ShapeText(), shape); }

/// Text of a restitution or a friction in pairs.
std::string surface_text(double value) { return value < 0.0 ? "of the other body" : fmt::format("{}", value); }

std::string keyframes_text(const BodyDescription& body) {
    std::string all = fmt::format("{}:", int(body.interpolation));
    for (const Keyframe& key : body.keyframes)
        all += fmt::format("{} {} {};", key.time, text_of(key.position), text_of(key.rotation));
    return fmt::format("{} {}", body.keyframes.size(), digest_text(all));
}

std::string forces_text(const SceneDescription& scene) {
    std::string all;
    for (const ForceDescription& f : scene.forces)
        all += fmt::format("{} {} {} {} {} {};", scene.bodies[f.body].name, text_of(f.point), text_of(f.force),
                           f.body_frame, f.start, f.end);
    return fmt::format("{} {}", scene.forces.size(), digest_text(all));
}

std::string cords_text(const SceneDescription& scene) {
    std::string all;
    for (const CordDescription& c : scene.cords) {
        all += fmt::format("{} {} {} {} {};", scene.bodies[c.body].name, text_of(c.point), text_of(c.anchor), c.radius,
                           to_string(c.color));
        if (c.joint) all += scene.joints[*c.joint].name + ";";
    }
    return fmt::format("{} {}", scene.cords.size(), digest_text(all));
}

std::string lamps_text(const SceneDescription& scene) {
    std::string all;
    for (const LampDescription& l : scene.lamps)
        all += fmt::format("{} {} {} {} {} {} {};", name_of(l.type), text_of(l.direction), text_of(l.position),
                           to_string(l.color), l.intensity, l.angle, l.shadows);
    return fmt::format("{} {}", scene.lamps.size(), digest_text(all));
}

std::string shown_text(const OverlayDescription& overlay) {
    std::vector<std::string_view> names;
    for (const OverlayName& one : overlay_names)
        if (overlay.show.has(one.overlay) && one.overlay != Overlay::title && one.overlay != Overlay::clock &&
            one.overlay != Overlay::mode)
            names.push_back(one.name);
    return fmt::format("{}", fmt::join(names, ","));
}

/// How overlays are drawn, apart from their names.
std::string overlay_style_text(const OverlayDescription& o) {
    std::string all = fmt::format("{} {} {} {} {} {};{};", o.start, o.end, o.impulse_time, o.trail_time, o.ghost_every,
                                  o.legend, fmt::join(o.bodies, " "));
    for (const TrailPoint& p : o.trail_points)
        all += fmt::format("{} {} {};", p.body, text_of(p.point), p.color ? to_string(*p.color) : "");
    for (const auto& scale : o.scale) all += fmt::format("{} ", scale.value_or(-1.0));
    for (const auto& color : o.color) all += color ? to_string(*color) : "-";
    return digest_text(all);
}

void add_simulation(const SimulationSettings& s, ValueMap& values) {
    add_fields(s, values);
    values.erase("duration");
    values["rotation form"] = text_of(s.rotation);
    values.erase("rotation");
}

}  // namespace

BodyKind kind_of(const SceneDescription& scene, const BodyDescription& body) {
    BodyKind kind;
    const Appearance& look = body.appearance;
    kind.look["shape"] = shape_text(body.shape);
    add_fields(look, kind.look);
    kind.matter["type"] = name_of(body.type);
    kind.matter["restitution"] = surface_text(body.restitution_in_pair());
    kind.matter["friction"] = surface_text(body.friction_in_pair());
    if (body.rolling_friction || body.spinning_friction) {
        kind.matter["rolling_friction"] = surface_text(body.rolling_friction_in_pair());
        kind.matter["spinning_friction"] = surface_text(body.spinning_friction_in_pair());
    }
    if (body.fracture) {
        const FractureDescription& f = *body.fracture;
        kind.matter["fracture"] = fmt::format("{} {} {} {}", f.pieces, name_of(f.pattern), f.seed, f.bonds.size());
        kind.matter["strength"] = fmt::format("{} {} {} {} {} {}", f.strength, f.shear_strength, f.compressive_strength,
                                              f.stiffness, f.toughness, f.blow_time);
    }
    if (!body.layers.empty()) kind.matter["layers"] = fmt::format("{}", fmt::join(body.layers, ", "));
    if (body.collide_with) kind.matter["collide_with"] = fmt::format("[{}]", fmt::join(*body.collide_with, ", "));
    if (body.type == BodyType::dynamic) {
        if (body.water_drag) kind.matter["water_drag"] = fmt::format("{}", *body.water_drag);
        if (body.gravity_scale != 1.0) kind.matter["gravity_scale"] = fmt::format("{}", body.gravity_scale);
        if (body.center_of_mass) kind.matter["center_of_mass"] = text_of(*body.center_of_mass);
        if (body.inertia) kind.matter["inertia"] = fmt::format("[{}]", fmt::join(*body.inertia, ", "));
        kind.matter[body.mass ? "mass" : "density"] = fmt::format("{}", body.mass.value_or(body.density));
        kind.matter["velocity"] = text_of(body.velocity);
        kind.matter["angular_velocity"] = text_of(body.angular_velocity);
        if (body.integrator && *body.integrator != scene.simulation.integrator)
            kind.matter["integrator"] = fmt::format("{}", int(*body.integrator));
    }
    if (!body.keyframes.empty()) kind.matter["keyframes"] = keyframes_text(body);
    if (!endless(body.shape)) kind.bounds = local_bounds(body.shape);
    // The look of the shape itself has the name that it has in all records.
    const bool own_look = look.pattern == Pattern::panel, plain = look.pattern == Pattern::plain;
    if (own_look || plain) kind.look["pattern"] = own_look ? "plain" : "none";
    if (look.pattern_color) kind.look["pattern_color"] = to_string(*look.pattern_color);
    if (look.pattern_scale > 0.0) kind.look["pattern_scale"] = fmt::format("{}", look.pattern_scale);
    if (look.texture)
        kind.look["texture"] =
            fmt::format("#{:016x} {} {}", fnv_hash(std::as_bytes(std::span(look.texture->levels.front().texels))),
                        look.texture_scale, name_of(look.texture_filter));
    for (const auto& [key, map] : {std::pair("normal_map", look.normal_map), {"roughness_map", look.roughness_map}})
        if (map)
            kind.look[key] =
                fmt::format("#{:016x} {} {}", fnv_hash(std::as_bytes(std::span(map->levels.front().texels))),
                            look.texture_scale, name_of(look.texture_filter));
    if (look.opacity != 1.0) kind.look["opacity"] = fmt::format("{}", look.opacity);
    if (look.emission != Color{0, 0, 0}) kind.look["emission"] = to_string(look.emission);
    kind.round = std::holds_alternative<SphereShape>(body.shape) && (own_look || plain) && !look.texture;
    return kind;
}

ValueMap values_of(const SceneDescription& scene) {
    ValueMap values;
    add_simulation(scene.simulation, values);
    if (scene.contact != PairRules{}) add_fields(scene.contact, values);
    add_fields(scene.light, values, "light.");
    if (!scene.lamps.empty()) values["lights"] = lamps_text(scene);
    if (const auto& environment = scene.environment) {
        add_fields(*environment, values, "environment.");
        values["environment.background"] = fmt::format("{} {} {}", int(environment->background),
                                                       to_string(environment->low), to_string(environment->high));
        if (environment->image)
            values["environment.image"] =
                fmt::format("#{:016x}", fnv_hash(std::as_bytes(std::span(environment->image->texels))));
    }
    if (scene.wind)
        values["wind"] = fmt::format("{} {} {}", text_of(scene.wind->velocity), scene.wind->density, scene.wind->drag);
    if (!scene.forces.empty()) values["forces"] = forces_text(scene);
    if (!scene.fields.empty() || !scene.pair_forces.empty() || !scene.explosions.empty() || scene.water)
        for (const auto& [part, hash] : scene_parts(scene))
            if (part == "fields" || part == "pair forces" || part == "explosions" || part == "water")
                values[part] = hash;
    if (!scene.cords.empty()) values["cords"] = cords_text(scene);
    values["overlay"] = shown_text(scene.overlay);
    for (std::size_t i = 0; i < scene.overlay.labels.size(); ++i) {
        const LabelDescription& label = scene.overlay.labels[i];
        values[fmt::format("label {}", i + 1)] =
            fmt::format("{} of {} at {} size {} {} {}from {} to {}", label.text, label.body,
                        label.offset ? text_of(*label.offset) : "above", label.size, to_string(label.color),
                        label.leader ? "leader " : "", label.start, label.end);
    }
    if (!values["overlay"].empty()) values["overlay style"] = overlay_style_text(scene.overlay);
    return values;
}

ValueMap values_of(const Composition& composition) {
    const SceneDescription& first = *composition.panels.front().scene;
    ValueMap values;
    values["size"] = fmt::format("{} x {}", composition.width, composition.height);
    values["samples"] = fmt::format("{}", first.output.samples);
    values["fps"] = fps_text(first.output.fps);
    if (first.output.exposure) values["exposure"] = fmt::format("{}", *first.output.exposure);
    if (first.output.tone) values["tone"] = name_of(*first.output.tone);
    const ClipText& text = composition.text;
    values["text.title"] = text.title;
    values["text.mode"] = text.mode;
    values["text.clock"] = text.clock ? "true" : "false";
    std::string captions;
    for (const Caption& c : text.captions) captions += fmt::format("{} from {} to {}; ", c.text, c.start, c.end);
    values["text.captions"] = captions;
    std::string labels;
    for (const ClipLabel& label : composition.labels) labels += label.text + "; ";
    values["text.labels"] = labels;
    std::string plots;
    for (const ClipPlot& plot : composition.plots) {
        plots += fmt::format("[{} {} {} {}]", plot.place.x, plot.place.y, plot.place.width, plot.place.height);
        for (const Panel& panel : plot.figure.panels) plots += panel.title + ";";
    }
    values["plot"] = plots;
    const auto place_text = [](const Rectangle& r) { return fmt::format("{} {} {} {}", r.x, r.y, r.width, r.height); };
    for (std::size_t i = 0; i < composition.insets.size(); ++i) {
        const ClipInset& inset = composition.insets[i];
        values[fmt::format("inset {}", i + 1)] =
            fmt::format("{} border {} {} from {} to {}", place_text(inset.place), inset.border,
                        to_string(inset.border_color), inset.start, inset.end);
    }
    if (const auto& logo = composition.logo)
        values["logo"] = fmt::format("{} opacity {} #{:016x}", place_text(logo->place), logo->logo.opacity,
                                     fnv_hash(std::as_bytes(std::span(logo->logo.image->levels.front().texels))));
    if (const ClipFade& fade = composition.fade; !fade.empty())
        values["fade"] = fmt::format("in {} out {} end {}", fade.in, fade.out, fade.last_time);
    return values;
}

}  // namespace tumble
