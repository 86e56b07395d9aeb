#include "api/joint_text.h"

#include "scene/fields/joint_fields.h"

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

}  // namespace tumble::v0
