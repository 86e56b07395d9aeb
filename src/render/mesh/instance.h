// One instance of a mesh in an instanced draw.
#pragma once

#include <glm/vec4.hpp>

namespace tumble {

/// One drawn body (or one face of a box); layout of shaders/instance.glsl.
struct Instance {
    glm::vec4 position;     // of the body's origin, m, relative to the eye; w: bevel, m
    glm::vec4 orientation;  // x, y, z, w
    glm::vec4 scale;        // of the mesh; w: cell of its pattern, m
    glm::vec4 color;        // linear; w: roughness
    glm::vec4 proxy;        // metallic, pattern; z, w: place in the AO atlas, texels
    glm::vec4
        tile;  // edge of its AO tiles, texels; index of a box's face, as in make_box(); surface id, as alpha; 1: uses
               // the near shadow map, 0: the far one
};

}  // namespace tumble
