// Expands a scene into ray targets: single shapes, each on a body (a compound has several), and cords.
#pragma once

#include "core/color.h"
#include "render/aov/pinhole_camera.h"
#include "render/shapes/ray_depths.h"
#include "scene/description/description.h"
#include "sim/snapshot/snapshot.h"

#include <cstdint>
#include <vector>

namespace tumble {

/// One shape of a visible body.
struct ShapeInstance {
    std::size_t body = 0;          // index in the scene
    Shape shape;                   // not a compound
    Vec3 position = Vec3::Zero();  // of the part, body frame, m
    Quat rotation = Quat::Identity();
    Color color;
    bool closed = true;  // its back faces are never visible
};

/// In scene order. The scene must outlive them, because it owns the meshes.
std::vector<ShapeInstance> surface_parts(const SceneDescription& scene);

/// Segmentation value of a body (the same for all its parts), a cord or the water. 0 is the background.
std::uint32_t body_id(std::size_t body);
std::uint32_t cord_id(const SceneDescription& scene, std::size_t cord);
std::uint32_t water_id(const SceneDescription& scene);
/// True if the AOVs have the surface of the water.
inline bool shows_water(const SceneDescription& scene) { return scene.water && scene.water->visible_in_aov; }

PartPlace place_of(const ShapeInstance& part, const Snapshot& snapshot, const PinholeCamera& camera);

CordPlace place_of(const CordDescription& cord, const Snapshot& snapshot, const PinholeCamera& camera);

}  // namespace tumble
