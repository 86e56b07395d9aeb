#include "api/spec_text.h"

#include "api/joint_text.h"

#include <fmt/format.h>

#include <array>
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
        write(spec.camera);
        header("[light]", "light");
        set("direction", spec.light.direction);
        set("shadows", spec.light.shadows);
        if (spec.wind) write(*spec.wind);
        write(spec.contact);
        for (std::size_t i = 0; i < spec.bodies.size(); ++i) write(spec.bodies[i], i);
        for (std::size_t i = 0; i < spec.joints.size(); ++i) write_joint(spec.joints[i], i, *this);
        for (std::size_t i = 0; i < spec.forces.size(); ++i) write(spec.forces[i], i);
        for (std::size_t i = 0; i < spec.cords.size(); ++i) write(spec.cords[i], i);
    }

    SpecText finish() {
        made.text = std::move(text);
        return std::move(made);
    }

private:
    void write(const SimulationSettings& s) {
        header("[simulation]", "simulation");
        set("duration", s.duration);
        if (s.step)
            set("step", *s.step);
        else
            value("steps_per_frame", "steps_per_frame", std::to_string(s.steps_per_frame));
        set("gravity", s.gravity);
        name("method", name_of(s.method));
        if (s.push_out) set("push_out", s.push_out);
        name("integrator", name_of(s.integrator));
        name("impacts", name_of(s.impacts));
        name("impact_law", name_of(s.impact_law));
        name("contact_solver", name_of(s.contact_solver));
        name("rotation", name_of(s.rotation));
        set("sleep", s.sleep);
        value("seed", "seed", std::to_string(s.seed));
    }

    void write(const OutputSettings& o) {
        header("[output]", "output");
        line("size = [", prefix(), "width");  // a line for each, so that an error names the right one
        line(fmt::format("    {},", o.width), prefix(), "width");
        line(fmt::format("    {},", o.height), prefix(), "height");
        line("]", prefix(), "height");
        set("fps", o.fps);
        value("samples", "samples", std::to_string(o.samples));
    }

    void write(const Camera& c) {
        header("[camera]", "camera");
        set("eye", c.eye);
        set("target", c.target);
        set("up", c.up);
        set("vertical_fov", c.vertical_fov);
        if (!c.keyframes.empty() || c.interpolation != Interpolation::smooth)
            name("interpolation", name_of(c.interpolation));
        set("orbit", c.orbit);
        if (!c.follow.empty()) set("follow", c.follow);
        for (std::size_t i = 0; i < c.keyframes.size(); ++i) {
            header("[[camera.keyframes]]", fmt::format("camera.keyframes[{}]", i));
            set("time", c.keyframes[i].time);
            set("eye", c.keyframes[i].eye);
            set("target", c.keyframes[i].target);
            set("vertical_fov", c.keyframes[i].vertical_fov);
        }
    }

    void write(const PairRules& c) {
        if (c.restitution_rule == PairRule::maximum && c.friction_rule == PairRule::geometric) return;  // the defaults
        header("[contact]", "contact");
        name("restitution_rule", name_of(c.restitution_rule));
        name("friction_rule", name_of(c.friction_rule));
    }

    void write(const Wind& w) {
        header("[wind]", "wind");
        set("velocity", w.velocity);
        set("density", w.density);
        set("drag", w.drag);
    }

    // A table of its own, because a body may have the mass in place of its material's density.
    bool write(const Material& m, std::size_t body) {
        if (!m.color && !m.density && !m.restitution && !m.friction && !m.roughness && !m.metallic && !m.pattern)
            return false;
        header(fmt::format("[materials.body{}]", body), fmt::format("bodies[{}].material", body));
        set("color", m.color);
        set("density", m.density);
        set("restitution", m.restitution);
        set("friction", m.friction);
        set("roughness", m.roughness);
        set("metallic", m.metallic);
        if (m.pattern) name("pattern", name_of(*m.pattern));
        return true;
    }

    void write(const Body& b, std::size_t i) {
        const std::string prefix = fmt::format("bodies[{}]", i);
        const bool material = write(b.material, i);
        header("[[body]]", prefix);
        if (!b.name.empty()) set("name", b.name);
        if (b.type != BodyType::dynamic) name("type", name_of(b.type));
        if (material) value("material", "material", fmt::format("\"body{}\"", i));
        set("mass", b.mass);
        if (!b.visible) set("visible", b.visible);
        write_pose(b.position, b.rotation);
        if (b.velocity != Vec3{}) set("velocity", b.velocity);
        if (b.angular_velocity != Vec3{}) set("angular_velocity", b.angular_velocity);
        if (b.integrator) name("integrator", name_of(*b.integrator));
        if (b.interpolation != Interpolation::smooth) name("interpolation", name_of(b.interpolation));
        if (b.scale)
            value("scale", "scale", fmt::format("[{}, {}]", text_of(b.scale->smallest), text_of(b.scale->largest)));
        if (!b.colors.empty()) {
            std::string colors;
            for (const Color& color : b.colors) colors += (colors.empty() ? "" : ", ") + text_of(color);
            value("colors", "colors", "[" + colors + "]");
        }
        for (std::size_t k = 0; k < b.keyframes.size(); ++k) {
            header("[[body.keyframes]]", fmt::format("{}.keyframes[{}]", prefix, k));
            set("time", b.keyframes[k].time);
            set("position", b.keyframes[k].position);
            set("rotation", b.keyframes[k].rotation);
        }
        write(b.shape, "body.shape", prefix + ".shape");
        if (b.grid) write(*b.grid, prefix + ".grid");
        if (b.scatter) write(*b.scatter, prefix + ".scatter");
    }

    void write(const Grid& grid, const std::string& prefix) {
        header("[body.grid]", prefix);
        value("count", "count", fmt::format("[{}, {}, {}]", grid.count[0], grid.count[1], grid.count[2]));
        set("spacing", grid.spacing);
        set("jitter", grid.jitter);
        set("tilt", grid.tilt);
    }

    void write(const Scatter& scatter, const std::string& prefix) {
        header("[body.scatter]", prefix);
        value("count", "count", std::to_string(scatter.count));
        set("size", scatter.size);
        value("rotation", "random_rotation", scatter.random_rotation ? "\"random\"" : "\"none\"");
        set("clearance", scatter.clearance);
    }

    void write_pose(const Vec3& position, const Rotation& rotation) {
        if (position != Vec3{}) set("position", position);
        if (rotation != Rotation{}) set("rotation", rotation);
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
    void write_shape(const Mesh& mesh, const std::string&, const std::string&) {
        shape_type("mesh");
        set("file", mesh.file);
        set("scale", mesh.scale);
        if (mesh.objects_are_parts) value("parts", "objects_are_parts", "\"objects\"");
    }
    void write_shape(const TriangleMesh& mesh, const std::string&, const std::string& prefix) {
        shape_type("mesh");
        value("memory", "arrays", std::to_string(index_of(mesh.arrays)));
        set("scale", mesh.scale);
        if (made.first_mesh.empty()) made.first_mesh = prefix;
    }
    void write_shape(const Compound& compound, const std::string& table, const std::string& prefix) {
        shape_type("compound");
        if (compound.parts.empty()) value("parts", "parts", "[]");
        for (std::size_t i = 0; i < compound.parts.size(); ++i) {
            const CompoundPart& part = compound.parts[i];
            const std::string name = fmt::format("{}.parts[{}]", prefix, i);
            header(fmt::format("[[{}.parts]]", table), name);
            write_pose(part.position, part.rotation);
            set("density", part.density);
            set("color", part.color);
            write(part.shape, table + ".parts.shape", name + ".shape");
        }
    }

    void write(const Force& f, std::size_t i) {
        header("[[force]]", fmt::format("forces[{}]", i));
        set("body", f.body);
        set("point", f.point);
        set("force", f.force);
        if (f.body_frame) value("frame", "body_frame", "\"body\"");
        set("start", f.start);
        if (f.end != std::numeric_limits<double>::infinity()) set("end", f.end);  // a file leaves it out
    }

    void write(const Cord& c, std::size_t i) {
        header("[[cord]]", fmt::format("cords[{}]", i));
        if (c.joint.empty()) {
            set("body", c.body);
            set("point", c.point);
            set("anchor", c.anchor);
        } else {
            set("joint", c.joint);
        }
        set("radius", c.radius);
        set("color", c.color);
    }

    std::size_t index_of(const std::shared_ptr<const TriangleMesh::Arrays>& arrays) {
        const auto [entry, is_new] = index_of_mesh_.try_emplace(arrays.get(), made.meshes.size());
        if (is_new) made.meshes.push_back(arrays);
        return entry->second;
    }

    SpecText made;
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
