#include "render/scene/compound_expansion.h"

#include <algorithm>
#include <utility>

namespace tumble {

CompoundExpansion::CompoundExpansion(const SceneDescription& scene) : scene_(scene) {
    const auto compound = [](const BodyDescription& body) { return std::holds_alternative<CompoundShape>(body.shape); };
    if (std::none_of(scene.bodies.begin(), scene.bodies.end(), compound)) return;
    scene_.bodies.clear();
    std::vector<std::size_t> first;  // first drawn body of each body
    for (std::size_t i = 0; i < scene.bodies.size(); ++i) {
        const BodyDescription& body = scene.bodies[i];
        first.push_back(scene_.bodies.size());
        const auto* whole = std::get_if<CompoundShape>(&body.shape);
        if (!whole) {
            scene_.bodies.push_back(body);
            parts_.push_back({i});
            continue;
        }
        for (const CompoundPart& part : *whole->parts) {
            BodyDescription drawn = body;
            drawn.shape = part.shape;
            drawn.position = body.position + body.rotation * part.position;
            drawn.rotation = body.rotation * part.rotation;
            drawn.keyframes.clear();
            if (part.color) drawn.appearance.color = *part.color;
            scene_.bodies.push_back(std::move(drawn));
            parts_.push_back({i, part.position, part.rotation});
        }
    }
    for (CordDescription& cord : scene_.cords) {
        cord.body = first[cord.body];
        const Part& part = parts_[cord.body];
        cord.point = part.rotation.conjugate() * (cord.point - part.position);
    }
    for (ForceDescription& force : scene_.forces) force.body = first[force.body];
}

void CompoundExpansion::forget_bodies() {
    for (const BodyDescription& body : scene_.bodies)
        if (const auto* mesh = std::get_if<MeshShape>(&body.shape)) assets_.insert(mesh->asset);
    scene_.bodies = std::vector<BodyDescription>();
}

const Snapshot& CompoundExpansion::snapshot(const Snapshot& whole) {
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
