#include "render/aov/shape_instance.h"

#include "render/scene/cord_ends.h"
#include "render/shapes/drawn_shape.h"

namespace tumble {

std::vector<ShapeInstance> surface_parts(const SceneDescription& scene) {
    std::vector<ShapeInstance> parts;
    const auto add = [&](ShapeInstance part) {
        const auto* mesh = std::get_if<MeshShape>(&part.shape);
        if (mesh != nullptr && !mesh->asset) return;
        // Copies share their mesh and are adjacent.
        const auto* before = parts.empty() ? nullptr : std::get_if<MeshShape>(&parts.back().shape);
        const bool known = mesh != nullptr && before != nullptr && mesh->asset == before->asset;
        part.closed =
            known ? parts.back().closed : std::visit([](const auto& shape) { return closed(shape); }, part.shape);
        parts.push_back(std::move(part));
    };
    for (std::size_t i = 0; i < scene.bodies.size(); ++i) {
        const BodyDescription& body = scene.bodies[i];
        if (!body.appearance.visible) continue;
        const auto* compound = std::get_if<CompoundShape>(&body.shape);
        if (compound == nullptr) {
            add({i, body.shape, Vec3::Zero(), Quat::Identity(), body.appearance.color, true});
            continue;
        }
        for (const CompoundPart& part : *compound->parts)
            if (part.visible)
                add({i, part.shape, part.position, part.rotation, part.color.value_or(body.appearance.color), true});
    }
    return parts;
}

std::uint32_t body_id(std::size_t body) { return std::uint32_t(1 + body); }

std::uint32_t cord_id(const SceneDescription& scene, std::size_t cord) { return body_id(scene.bodies.size() + cord); }

std::uint32_t water_id(const SceneDescription& scene) { return cord_id(scene, scene.cords.size()); }

PartPlace place_of(const ShapeInstance& part, const Snapshot& snapshot, const PinholeCamera& camera) {
    const BodyState& body = snapshot.bodies.at(part.body);
    const Mat3 turn = camera.axes.transpose() * body.orientation.toRotationMatrix();
    return {turn * part.rotation.toRotationMatrix(), camera.from_world(body.origin) + turn * part.position};
}

CordPlace place_of(const CordDescription& cord, const Snapshot& snapshot, const PinholeCamera& camera) {
    const CordEnds ends = cord_ends(cord, snapshot);
    return {camera.from_world(ends.anchor), camera.from_world(ends.point)};
}

}  // namespace tumble
