#include "api/spec_text.h"

#include "api/guard.h"
#include "scene/fields/body_fields.h"
#include "scene/fields/camera_fields.h"
#include "scene/fields/force_fields.h"
#include "scene/fields/joint_fields.h"
#include "scene/fields/many_bodies_fields.h"
#include "scene/fields/settings_fields.h"
#include "scene/fields/water_fields.h"
#include "tumble/spec.h"

#include <fmt/format.h>

#include <array>
#include <limits>
#include <string_view>
#include <unordered_map>

namespace tumble::v0 {

namespace {

class SpecWriter : public SpecLines {
public:
    using SpecLines::SpecLines;

    void write(const SceneSpec& spec) {
        value("format", "format", std::string("1"));
        if (!spec.title.empty()) set("title", spec.title);
        write(spec.simulation);
        write(spec.output);
        header("[camera]", "camera");
        write(spec.camera, "camera", "camera");
        for (const auto& [name, camera] : spec.cameras) {
            const std::string table = "cameras." + text_of(name), path = fmt::format("cameras[{}]", text_of(name));
            header(fmt::format("[{}]", table), path);
            write(camera, table, path);
        }
        for (std::size_t i = 0; i < spec.shots.size(); ++i) write(spec.shots[i], i);
        for (std::size_t i = 0; i < spec.speed.size(); ++i) write(spec.speed[i], i);
        write_lights(spec);
        if (spec.environment) write(*spec.environment);
        if (spec.wind) write(*spec.wind);
        if (spec.water) write(*spec.water);
        write(spec.contact);
        for (std::size_t i = 0; i < spec.bodies.size(); ++i) write(spec.bodies[i], i);
        for (std::size_t i = 0; i < spec.joints.size(); ++i) write_joint(spec.joints[i], i, *this);
        for (std::size_t i = 0; i < spec.forces.size(); ++i) write(spec.forces[i], i);
        for (std::size_t i = 0; i < spec.fields.size(); ++i) write(spec.fields[i], i);
        for (std::size_t i = 0; i < spec.pair_forces.size(); ++i) write(spec.pair_forces[i], i);
        for (std::size_t i = 0; i < spec.explosions.size(); ++i) {
            header("[[explosion]]", fmt::format("explosions[{}]", i));
            write_fields<ExplosionDescription>(*this, spec.explosions[i], true);
        }
        for (std::size_t i = 0; i < spec.cords.size(); ++i) write(spec.cords[i], i);
    }

    SpecText finish() {
        made_.text = std::move(text);
        return std::move(made_);
    }

private:
    void write(const SimulationSettings& s) {
        header("[simulation]", "simulation");
        if (s.step) set("step", *s.step);
        write_fields<tumble::SimulationSettings>(*this, s, false, {s.step ? "steps_per_frame" : ""});
    }

    void write(const OutputSettings& o) {
        header("[output]", "output");
        line("size = [", prefix(), "width");  // a line for each, so that an error names the right one
        line(fmt::format("    {},", o.width), prefix(), "width");
        line(fmt::format("    {},", o.height), prefix(), "height");
        line("]", prefix(), "height");
        write_fields<tumble::OutputSettings>(*this, o);
    }

    void write(const Camera& c, const std::string& table, const std::string& path) {
        write_fields<CameraDescription>(*this, c, true);
        for (std::size_t i = 0; i < c.keyframes.size(); ++i) {
            header(fmt::format("[[{}.keyframes]]", table), fmt::format("{}.keyframes[{}]", path, i));
            write_fields<tumble::CameraKeyframe>(*this, c.keyframes[i]);
        }
    }

    void write(const Shot& s, std::size_t i) {
        header("[[shot]]", fmt::format("shots[{}]", i));
        set("camera", s.camera);
        value("from", "start", text_of(s.start));
        if (s.end != std::numeric_limits<double>::infinity()) value("to", "end", text_of(s.end));
        set("move", s.move);
    }

    void write(const Speed& s, std::size_t i) {
        header("[[speed]]", fmt::format("speed[{}]", i));
        if (s.impact[0].empty() && s.impact[1].empty()) {
            set("time", s.time);
        } else {
            value("time", "impact", text_of(fmt::format("impact:{},{}", s.impact[0], s.impact[1])));
            value("after", "time", text_of(s.time));
        }
        set("factor", s.factor);
        set("hold", s.hold);
        set("easing", s.easing);
    }

    void write_lights(const SceneSpec& spec) {
        if (spec.lights.empty()) {
            header("[light]", "light");
            write_fields<LightDescription>(*this, spec.light);
        }
        for (std::size_t i = 0; i < spec.lights.size(); ++i) {
            header("[[light]]", fmt::format("lights[{}]", i));
            write_fields<LampDescription>(*this, spec.lights[i]);
        }
    }

    void write(const Environment& e) {
        header("[environment]", "environment");
        if (!e.preset.empty()) set("preset", e.preset);
        if (!e.image.empty()) set("image", e.image);
        if (!e.background.empty()) set("background", e.background);
        if (e.gradient) value("background", "gradient", text_of(*e.gradient));
        write_fields<EnvironmentDescription>(*this, e, true);
    }

    void write_span(double start, double end) {
        const bool ends = end != std::numeric_limits<double>::infinity();
        if (start == 0.0 && !ends) return;
        line("enabled = [", prefix(), "start");  // a line for each, so that an error names the right one
        line(fmt::format("    {},", text_of(start)), prefix(), "start");
        if (ends) line(fmt::format("    {},", text_of(end)), prefix(), "end");
        line("]", prefix(), "end");
    }

    void write(const Field& f, std::size_t i) {
        const std::string path = fmt::format("fields[{}]", i);
        header("[[field]]", path);
        write_fields<FieldDescription>(*this, f, true);
        write_span(f.start, f.end);
        if (!f.region) return;
        header("[field.region]", path + ".region");
        write_fields<tumble::FieldRegion>(*this, *f.region, true);
    }

    void write(const PairForce& f, std::size_t i) {
        header("[[pair_force]]", fmt::format("pair_forces[{}]", i));
        write_fields<PairForceDescription>(*this, f, true);
        if (!f.charges.empty()) {
            std::string charges;
            for (const double charge : f.charges) charges += (charges.empty() ? "" : ", ") + text_of(charge);
            value("charges", "charges", "[" + charges + "]");
        }
        if (!f.moments.empty()) {
            std::string moments;
            for (const Vec3& moment : f.moments) moments += (moments.empty() ? "" : ", ") + text_of(moment);
            value("moments", "moments", "[" + moments + "]");
        }
        write_span(f.start, f.end);
    }

    void write(const PairRules& c) {
        if (c.restitution_rule == PairRule::maximum && c.friction_rule == PairRule::geometric) return;  // the defaults
        header("[contact]", "contact");
        write_fields<tumble::PairRules>(*this, c);
    }

    void write(const Wind& w) {
        header("[wind]", "wind");
        write_fields<WindDescription>(*this, w);
    }

    void write(const Water& w) {
        header("[water]", "water");
        write_fields<WaterDescription>(*this, w);
        for (std::size_t i = 0; i < w.waves.size(); ++i) {
            header("[[water.waves]]", fmt::format("water.waves[{}]", i));
            write_fields<tumble::WaterWave>(*this, w.waves[i]);
        }
    }

    // A table of its own, because a body may have the mass instead of its material's density.
    bool write(const Material& m, std::size_t body) {
        if (!m.color && !m.density && !m.restitution && !m.friction && !m.rolling_friction && !m.spinning_friction &&
            !m.roughness && !m.metallic && !m.pattern && !m.pattern_color && !m.pattern_scale && !m.texture &&
            !m.texture_scale && !m.texture_filter && !m.normal_map && !m.roughness_map && !m.opacity && !m.emission &&
            !m.reflection && !m.sound && !m.strength && !m.shear_strength && !m.compressive_strength && !m.stiffness &&
            !m.toughness && !m.blow_time && !m.inner_color)
            return false;
        header(fmt::format("[materials.body{}]", body), fmt::format("bodies[{}].material", body));
        write_fields<tumble::Material>(*this, m);
        write_fields<FractureMaterial>(*this, m);
        return true;
    }

    void write(const Body& b, std::size_t i) {
        const std::string prefix = fmt::format("bodies[{}]", i);
        const bool material = write(b.material, i);
        header("[[body]]", prefix);
        write_fields<BodyDescription>(*this, b, true);
        if (material) value("material", "material", fmt::format("\"body{}\"", i));
        if (b.scale)
            value("scale", "scale", fmt::format("[{}, {}]", text_of(b.scale->smallest), text_of(b.scale->largest)));
        if (!b.colors.empty()) {
            std::string colors;
            for (const Color& color : b.colors) colors += (colors.empty() ? "" : ", ") + text_of(color);
            value("colors", "colors", "[" + colors + "]");
        }
        for (std::size_t k = 0; k < b.keyframes.size(); ++k) {
            header("[[body.keyframes]]", fmt::format("{}.keyframes[{}]", prefix, k));
            write_fields<tumble::Keyframe>(*this, b.keyframes[k]);
        }
        write(b.shape, "body.shape", prefix + ".shape");
        if (b.fracture) {
            header("[body.fracture]", prefix + ".fracture");
            write_fields<FractureRequest>(*this, *b.fracture, true);
            if (b.fracture->focus_at_impact) value("focus", "focus_at_impact", "\"impact\"");
        }
        if (b.grid) write(*b.grid, prefix + ".grid");
        if (b.scatter) write(*b.scatter, prefix + ".scatter");
    }

    void write(const Grid& grid, const std::string& prefix) {
        header("[body.grid]", prefix);
        write_fields<GridRequest>(*this, grid);
    }

    void write(const Scatter& scatter, const std::string& prefix) {
        header("[body.scatter]", prefix);
        write_fields<ScatterRequest>(*this, scatter);
    }

    void write(const Shape& shape, const std::string& table, const std::string& prefix) {
        header(fmt::format("[{}]", table), prefix);
        std::visit([&](const auto& one) { write_shape(one, table, prefix); }, shape);
    }

    void shape_type(const char* type) { value("type", "", text_of(std::string(type))); }

    void write_shape(const Plane& plane, const std::string&, const std::string&) {
        shape_type("plane");
        set("normal", plane.normal);
        set("offset", plane.offset);
    }
    void write_shape(const Box& box, const std::string&, const std::string&) {
        shape_type("box");
        set("size", box.size);
    }
    void write_shape(const Sphere& sphere, const std::string&, const std::string&) {
        shape_type("sphere");
        set("radius", sphere.radius);
    }
    void write_shape(const Capsule& capsule, const std::string&, const std::string&) {
        shape_type("capsule");
        set("radius", capsule.radius);
        set("height", capsule.height);
    }
    void write_shape(const Cylinder& cylinder, const std::string&, const std::string&) {
        shape_type("cylinder");
        set("radius", cylinder.radius);
        set("height", cylinder.height);
    }
    void write_shape(const Cone& cone, const std::string&, const std::string&) {
        shape_type("cone");
        set("radius", cone.radius);
        set("height", cone.height);
        set("top_radius", cone.top_radius);
    }
    void write_shape(const Ellipsoid& ellipsoid, const std::string&, const std::string&) {
        shape_type("ellipsoid");
        set("radii", ellipsoid.radii);
    }
    void write_mass(const auto& mesh) {
        if (mesh.mass_from) value("mass_from", "mass_from", text_of(name_of(*mesh.mass_from)));
        if (mesh.thickness) set("thickness", *mesh.thickness);
    }
    void write_shape(const Mesh& mesh, const std::string&, const std::string&) {
        shape_type("mesh");
        set("file", mesh.file);
        set("scale", mesh.scale);
        if (!mesh.unit.empty()) set("unit", mesh.unit);
        if (!mesh.up.empty()) set("up", mesh.up);
        if (mesh.objects_are_parts) value("parts", "objects_are_parts", "\"objects\"");
        write_mass(mesh);
    }
    void write_shape(const TriangleMesh& mesh, const std::string&, const std::string& prefix) {
        shape_type("mesh");
        value("memory", "arrays", std::to_string(index_of(mesh.arrays)));
        set("scale", mesh.scale);
        write_mass(mesh);
        if (made_.first_mesh.empty()) made_.first_mesh = prefix;
    }
    void write_shape(const Hull& hull, const std::string&, const std::string&) {
        shape_type("hull");
        std::string points;
        for (const Vec3& point : hull.points) points += (points.empty() ? "" : ", ") + text_of(point);
        value("points", "points", "[" + points + "]");
    }
    void write_shape(const HeightField& field, const std::string&, const std::string&) {
        shape_type("heightfield");
        set("file", field.file);
        value("size", "size_x", text_of(std::array{field.size_x, field.size_z}));
        set("height", field.height);
        set("base", field.base);
    }
    void write_shape(const Compound& compound, const std::string& table, const std::string& prefix) {
        shape_type("compound");
        if (compound.parts.empty()) value("parts", "parts", "[]");
        for (std::size_t i = 0; i < compound.parts.size(); ++i) {
            const CompoundPart& part = compound.parts[i];
            const std::string name = fmt::format("{}.parts[{}]", prefix, i);
            header(fmt::format("[[{}.parts]]", table), name);
            write_fields<tumble::CompoundPart>(*this, part, true);
            write(part.shape, table + ".parts.shape", name + ".shape");
        }
    }

    void write(const Force& f, std::size_t i) {
        header("[[force]]", fmt::format("forces[{}]", i));
        write_fields<ForceDescription>(*this, f);
    }

    void write(const Cord& c, std::size_t i) {
        header("[[cord]]", fmt::format("cords[{}]", i));
        if (c.joint.empty()) return write_fields<CordDescription>(*this, c);
        set("joint", c.joint);
        write_fields<CordDescription>(*this, c, false, {"body", "point", "anchor"});
    }

    std::size_t index_of(const std::shared_ptr<const TriangleMesh::Arrays>& arrays) {
        const auto [entry, is_new] = index_of_mesh_.try_emplace(arrays.get(), made_.meshes.size());
        if (is_new) made_.meshes.push_back(arrays);
        return entry->second;
    }

    SpecText made_;
    std::unordered_map<const TriangleMesh::Arrays*, std::size_t> index_of_mesh_;  // only looked up
};

}  // namespace

SpecText spec_text(const SceneSpec& spec) {
    SpecWriter writer(0);
    writer.write(spec);
    return writer.finish();
}

std::string element_of_line(const SceneSpec& spec, int line) {
    SpecWriter writer(line);
    writer.write(spec);
    return writer.element;
}

}  // namespace tumble::v0

namespace tumble::v0 {
namespace {

bool given(const std::array<std::string, 2>& names) { return !names[0].empty() || !names[1].empty(); }

/// Writes the tables of a joint: `table` is the name of one in the file, `element` in the spec.
class JointWriter {
public:
    explicit JointWriter(SpecLines& lines) : lines_(lines) {}

    void write(const Joint& j, const std::string& element) {
        lines_.header("[[joint]]", element);
        if (!j.name.empty()) lines_.set("name", j.name);
        lines_.set("type", j.type);
        if (given(j.bodies) || j.type != JointType::gear) lines_.set("bodies", j.bodies);
        if (given(j.joints) || j.type == JointType::gear) lines_.set("joints", j.joints);
        lines_.set("ratio", j.ratio);
        write_place(j);
        write_coordinates(j);
        lines_.set("break_force", j.break_force);
        lines_.set("break_torque", j.break_torque);
        lines_.set("break_impulse", j.break_impulse);
        lines_.set("collide", j.collide);
        write_span(j);
        if (j.visible) lines_.set("visible", j.visible);
        write_spring(j.spring, "joint.spring", element + ".spring");
        write_spring(j.turn_spring, "joint.turn_spring", element + ".turn_spring");
        write_motor(j.motor, "joint.motor", element + ".motor");
        write_motor(j.turn_motor, "joint.turn_motor", element + ".turn_motor");
        for (std::size_t k = 0; k < 3; ++k) {
            const char axis = char('x' + k);
            write_coordinate(j.move[k], fmt::format("joint.move_{}", axis), fmt::format("{}.move[{}]", element, k));
            write_coordinate(j.turn[k], fmt::format("joint.turn_{}", axis), fmt::format("{}.turn[{}]", element, k));
        }
    }

private:
    void write_place(const Joint& j) {
        lines_.set("anchor", j.anchor);
        lines_.set("anchors", j.anchors);
        lines_.set("axis", j.axis);
        lines_.set("second_axis", j.second_axis);
        lines_.set("axes", j.axes);
        if (j.frame != JointFrame::world) lines_.set("frame", j.frame);
        if (j.snap) lines_.set("snap", j.snap);
        lines_.set("start_angle", j.start_angle);
        lines_.set("start_position", j.start_position);
    }

    void write_coordinates(const Joint& j) {
        lines_.set("limits", j.limits);
        lines_.set("turn_limits", j.turn_limits);
        lines_.set("second_limits", j.second_limits);
        lines_.set("swing", j.swing);
        lines_.set("twist", j.twist);
        lines_.set("limit_restitution", j.limit_restitution);
        lines_.set("friction", j.friction);
        lines_.set("turn_friction", j.turn_friction);
        lines_.set("friction_coefficient", j.friction_coefficient);
        lines_.set("bearing_radius", j.bearing_radius);
        lines_.set("armature", j.armature);
        lines_.set("length", j.length);
        lines_.set("min_length", j.min_length);
        lines_.set("max_length", j.max_length);
    }

    void write_span(const Joint& j) {
        const bool ends = j.end != std::numeric_limits<double>::infinity();
        if (j.start == 0.0 && !ends) return;
        lines_.line("enabled = [", lines_.prefix(), "start");  // a line for each, so that an error names the right one
        lines_.line(fmt::format("    {},", text_of(j.start)), lines_.prefix(), "start");
        if (ends) lines_.line(fmt::format("    {},", text_of(j.end)), lines_.prefix(), "end");
        lines_.line("]", lines_.prefix(), "end");
    }

    void write_spring(const std::optional<JointSpring>& spring, const std::string& table, const std::string& element) {
        if (!spring) return;
        lines_.header(fmt::format("[{}]", table), element);
        write_fields<tumble::JointSpring>(lines_, *spring);
    }

    void write_motor(const std::optional<JointMotor>& motor, const std::string& table, const std::string& element) {
        if (!motor) return;
        lines_.header(fmt::format("[{}]", table), element);
        lines_.set("speed", motor->speed);
        lines_.set("target", motor->target);
        if (motor->interpolation != Interpolation::smooth) lines_.set("interpolation", motor->interpolation);
        lines_.set("stiffness", motor->stiffness);
        lines_.set("damping", motor->damping);
        lines_.set("max_force", motor->max_force);
        lines_.set("max_torque", motor->max_torque);
        for (std::size_t k = 0; k < motor->keyframes.size(); ++k) {
            lines_.header(fmt::format("[[{}.keyframes]]", table), fmt::format("{}.keyframes[{}]", element, k));
            write_fields<JointTarget>(lines_, motor->keyframes[k]);
        }
    }

    void write_coordinate(const std::optional<JointCoordinate>& coordinate, const std::string& table,
                          const std::string& element) {
        if (!coordinate) return;
        lines_.header(fmt::format("[{}]", table), element);
        lines_.set("limits", coordinate->limits);
        lines_.set("limit_restitution", coordinate->limit_restitution);
        lines_.set("friction", coordinate->friction);
        write_spring(coordinate->spring, table + ".spring", element + ".spring");
        write_motor(coordinate->motor, table + ".motor", element + ".motor");
    }

    SpecLines& lines_;
};

}  // namespace

void write_joint(const Joint& joint, std::size_t index, SpecLines& lines) {
    JointWriter(lines).write(joint, fmt::format("joints[{}]", index));
}

std::string to_toml(const SceneSpec& spec) {
    return guarded([&] {
        SpecText made = spec_text(spec);
        if (!made.first_mesh.empty())
            throw Error(ErrorKind::input, {{}, 0, 0, made.first_mesh},
                        "a mesh in memory cannot be part of a scene file: use a Mesh with the name of a file");
        return std::move(made.text);
    });
}

}  // namespace tumble::v0
