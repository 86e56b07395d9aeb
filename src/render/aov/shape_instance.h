// Expands a scene into ray targets: single shapes, each on a body (a compound has several), and cords.
#pragma once

#include "core/color.h"
#include "render/aov/pinhole_camera.h"
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

/// Segmentation value of a body (the same for all its parts) or a cord. 0 is the background.
std::uint32_t body_id(std::size_t body);
std::uint32_t cord_id(const SceneDescription& scene, std::size_t cord);

/// Pose of a part in the camera frame: a point p of the part is at origin + axes p.
struct PartPlace {
    Mat3 axes;
    Vec3 origin;  // m

    friend bool operator==(const PartPlace&, const PartPlace&) = default;
};
PartPlace place_of(const ShapeInstance& part, const Snapshot& snapshot, const PinholeCamera& camera);

/// The ends of a cord in the camera frame: its anchor and its attachment on the body.
struct CordPlace {
    Vec3 from, to;  // m

    friend bool operator==(const CordPlace&, const CordPlace&) = default;
};
CordPlace place_of(const CordDescription& cord, const Snapshot& snapshot, const PinholeCamera& camera);

}  // namespace tumble
