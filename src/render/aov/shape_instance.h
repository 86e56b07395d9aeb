// A scene taken apart into what rays can hit: single shapes, each on a body (compounds give several), and cords.
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
    std::size_t body = 0;               // of the scene
    Shape shape;                        // no compound
    Vec3 position = Vec3::Zero();       // of the part, body frame, m
    Quat rotation = Quat::Identity();
    Color color;
    bool closed = true;                 // its back faces are never seen
};

/// In scene order. The meshes' assets must outlive them, as the scene does.
std::vector<ShapeInstance> surface_parts(const SceneDescription& scene);

/// What segmentation calls a body, all its parts alike, and a cord. 0 is the background.
std::uint32_t body_id(std::size_t body);
std::uint32_t cord_id(const SceneDescription& scene, std::size_t cord);

/// Where a part is as a camera sees it: a point p of the part is at origin + axes p. Both in the camera's frame.
struct PartPlace {
    Mat3 axes;
    Vec3 origin;   // m

    friend bool operator==(const PartPlace&, const PartPlace&) = default;
};
PartPlace place_of(const ShapeInstance& part, const Snapshot& snapshot, const PinholeCamera& camera);

/// A cord's two ends in the camera's frame: its anchor and its place on the body.
struct CordPlace {
    Vec3 from, to;   // m

    friend bool operator==(const CordPlace&, const CordPlace&) = default;
};
CordPlace place_of(const CordDescription& cord, const Snapshot& snapshot, const PinholeCamera& camera);

}  // namespace tumble
