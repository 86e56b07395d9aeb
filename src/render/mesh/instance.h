// One instance of a mesh in an instanced draw.
#pragma once

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>

namespace tumble {

/// One drawn body (or one face of a box); six vec4 attributes, as in shaders/instance.glsl.
struct Instance {
    glm::vec3 position;     // of the body's origin, m, relative to the eye
    float bevel;            // m
    glm::vec4 orientation;  // x, y, z, w
    glm::vec3 scale;        // of the mesh
    float pattern_cell;     // m
    glm::vec3 color;        // linear
    float roughness;
    float metallic, pattern;  // pattern: see pattern_number()
    glm::vec2 atlas_place;    // in the AO atlas, texels
    float tile_size;          // edge of its AO tiles, texels; 0: none
    float face;               // of a box, as in BodyOcclusion; 1 for an open mesh
    float surface_id;         // as alpha
    float near_shadows;       // 1: uses the near shadow map, 0: the far one
};
static_assert(sizeof(Instance) == 6 * sizeof(glm::vec4));

}  // namespace tumble
