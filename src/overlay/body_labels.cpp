#include "overlay/body_labels.h"

#include "overlay/overlay_builder.h"

#include <fmt/format.h>

namespace tumble {
namespace {

constexpr float lift = 22.0f;  // units of sizes on the screen, of a label above its body

std::string number_text(double value, const LabelField& field) {
    const auto written = [&](double number) {
        switch (field.form) {
            case 'g':
                return fmt::format("{:.{}g}", number, field.digits);
            case 'e':
                return fmt::format("{:.{}e}", number, field.digits);
            default:
                return fmt::format("{:.{}f}", number, field.digits);
        }
    };
    const std::string text = written(value);
    // No "-0.00": a resting body would flicker between the two zeros.
    return text.starts_with('-') && text.find_first_of("123456789") == std::string::npos ? written(0.0) : text;
}

std::string vector_text(const Vec3& v, const LabelField& field) {
    return fmt::format("({}, {}, {})", number_text(v.x(), field), number_text(v.y(), field), number_text(v.z(), field));
}

std::string value_text(const LabelField& field, const BodyState& body, const std::string& name, double time) {
    const Vec3& center = body.center_of_mass;
    switch (field.value) {
        case LabelValue::name:
            return name;
        case LabelValue::mass:
            return number_text(body.mass, field);
        case LabelValue::speed:
            return number_text(body.velocity.norm(), field);
        case LabelValue::velocity:
            return vector_text(body.velocity, field);
        case LabelValue::position:
            return vector_text(center, field);
        case LabelValue::x:
            return number_text(center.x(), field);
        case LabelValue::y:
            return number_text(center.y(), field);
        case LabelValue::z:
            return number_text(center.z(), field);
        case LabelValue::omega:
            return number_text(body.angular_velocity.norm(), field);
        case LabelValue::momentum:
            return number_text(body.momentum.norm(), field);
        case LabelValue::kinetic:
            return number_text(
                0.5 * (body.momentum.dot(body.velocity) + body.angular_momentum.dot(body.angular_velocity)), field);
        case LabelValue::time:
            return number_text(time, field);
    }
    return {};
}

}  // namespace

std::string label_text(const std::vector<LabelPiece>& pieces, const BodyState& body, const std::string& name,
                       double time) {
    std::string text;
    for (const LabelPiece& piece : pieces) {
        if (const auto* plain = std::get_if<std::string>(&piece))
            text += *plain;
        else
            text += value_text(std::get<LabelField>(piece), body, name, time);
    }
    return text;
}

BodyLabels::BodyLabels(const SceneDescription& scene) : scene_(&scene) {
    for (const LabelDescription& label : scene.overlay.labels)
        labels_.push_back(
            {&label, parse_label(label.text).pieces, radius_about_origin(scene.bodies[label.body].shape)});
}

void BodyLabels::add(const Snapshot& snapshot, std::vector<OverlayCallout>& callouts) const {
    for (const Label& one : labels_) {
        const LabelDescription& label = *one.description;
        if (snapshot.time < label.start || snapshot.time >= label.end) continue;
        const BodyState& body = snapshot.bodies[label.body];
        OverlayCallout callout;
        callout.of = body.center_of_mass;
        callout.at = callout.of + label.offset.value_or(Vec3(0.0, one.above, 0.0));
        callout.lift = label.offset ? 0.0f : lift;
        callout.text = label_text(one.pieces, body, scene_->bodies[label.body].name, snapshot.time);
        callout.size = float(label.size);
        callout.color = label.color;
        callout.leader = label.leader;
        callouts.push_back(std::move(callout));
    }
}

}  // namespace tumble
