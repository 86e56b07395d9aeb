#include "render/scene/compound_expansion.h"

#include <algorithm>
#include <utility>

namespace tumble {
namespace {

const CompoundShape* compound_of(const BodyDescription& body) { return std::get_if<CompoundShape>(&body.shape); }

bool has_compounds(const SceneDescription& scene) {
    return std::any_of(scene.bodies.begin(), scene.bodies.end(),
                       [](const BodyDescription& body) { return compound_of(body) != nullptr; });
}

BodyDescription part_as_body(const BodyDescription& body, const CompoundPart& part) {
    BodyDescription drawn = body;
    drawn.shape = part.shape;
    drawn.position = body.position + body.rotation * part.position;
    drawn.rotation = body.rotation * part.rotation;
    drawn.keyframes.clear();
    drawn.appearance.visible = body.appearance.visible && part.visible;
    if (part.color) drawn.appearance.color = *part.color;
    return drawn;
}

}  // namespace

SceneDescription expand_compounds(const SceneDescription& scene) {
    SceneDescription expanded = scene;
    if (!has_compounds(scene)) return expanded;
    expanded.bodies.clear();
    std::vector<std::size_t> first;  // first part of each body
    for (const BodyDescription& body : scene.bodies) {
        first.push_back(expanded.bodies.size());
        if (const CompoundShape* compound = compound_of(body))
            for (const CompoundPart& part : *compound->parts) expanded.bodies.push_back(part_as_body(body, part));
        else
            expanded.bodies.push_back(body);
    }
    const auto attach_to_part = [&](std::size_t& body, Vec3& point) {
        if (const CompoundShape* compound = compound_of(scene.bodies[body])) {
            const CompoundPart& part = compound->parts->front();
            point = part.rotation.conjugate() * (point - part.position);
        }
        body = first[body];
    };
    for (CordDescription& cord : expanded.cords) {
        attach_to_part(cord.body, cord.point);
        if (cord.anchor_body) attach_to_part(*cord.anchor_body, cord.anchor);
    }
    for (ForceDescription& force : expanded.forces) force.body = first[force.body];
    return expanded;
}

PartPoses::PartPoses(const SceneDescription& scene) {
    if (!has_compounds(scene)) return;
    for (std::size_t i = 0; i < scene.bodies.size(); ++i)
        if (const CompoundShape* compound = compound_of(scene.bodies[i]))
            for (const CompoundPart& part : *compound->parts) parts_.push_back({i, part.position, part.rotation});
        else
            parts_.push_back({i});
}

const Snapshot& PartPoses::snapshot(const Snapshot& whole) {
    if (parts_.empty()) return whole;
    snapshot_.frame = whole.frame;
    snapshot_.time = whole.time;
    snapshot_.bodies.clear();
    for (const Part& part : parts_) {
        BodyState state = whole.bodies.at(part.body);
        state.origin += state.orientation * part.position;
        state.orientation = state.orientation * part.rotation;
        snapshot_.bodies.push_back(state);
    }
    return snapshot_;
}

}  // namespace tumble
