// What drawing needs to know of each body, worked out once for a scene.
#pragma once

#include "core/vector.h"
#include "scene/description.h"

#include <glm/vec3.hpp>

#include <cstddef>
#include <vector>

namespace tumble {

enum class DrawKind { hidden, plane, box, ball, mesh };

struct BodyLook {
    DrawKind kind = DrawKind::hidden;
    std::size_t mesh = 0;                    // index into SceneLooks::meshes
    Vec3 half_size = Vec3::Ones();           // scale of the unit box or ball, m; 1 for meshes
    Vec3 bound_center = Vec3::Zero();        // of a ball around the body, body frame from its origin, m
    double bound_radius = 0.0;               // m
    double reach = 0.0;                      // how far it darkens its neighbours, and they it, m
    double bevel = 0.0;                      // m
    PlaneShape plane;                        // planes only
    glm::vec3 color{1.0f};                   // linear
    float roughness = 0.6f, metallic = 0.0f;
    Pattern pattern = Pattern::plain;
};

/// A box inside a body that stands for it where neighbours are darkened; body frame.
struct OccluderBox {
    Vec3 center;      // m
    Vec3 half_size;   // m
};

struct SceneLooks {
    std::vector<BodyLook> bodies;                            // in scene order
    std::vector<const MeshAsset*> meshes;                    // each once, in order of first use
    std::vector<std::vector<OccluderBox>> mesh_occluders;    // for each of them
};

SceneLooks make_scene_looks(const SceneDescription& scene);

}  // namespace tumble
