// One instance of a mesh in an instanced draw.
#pragma once

#include <glm/vec4.hpp>

namespace tumble {

/// One drawn body (of a box, one of its faces), as shaders/instance.glsl reads it.
struct Instance {
    glm::vec4 position;     // of the body's origin, relative to the eye; w: bevel, m
    glm::vec4 orientation;  // x, y, z, w
    glm::vec4 scale;        // of the mesh; w: its pattern's cell, m
    glm::vec4 color;        // linear; w: roughness
    glm::vec4 look;         // metallic, pattern; z, w: its place in the occlusion atlas, texels
    glm::vec4 tile;         // the edge of its tiles there; which face of a box this is, as in make_box(); its surface's
                            // number as alpha; 1: looks into the near shadow map, 0: the far one
};

}  // namespace tumble
