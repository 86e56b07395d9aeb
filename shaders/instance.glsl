// One drawn body's placement and look (struct Instance of render/draw_list.h).
layout(location = 0) in vec3 mesh_position;
layout(location = 1) in vec3 mesh_normal;
layout(location = 2) in vec4 instance_position;      // relative to the eye; w: bevel, m
layout(location = 3) in vec4 instance_orientation;   // unit quaternion x, y, z, w
layout(location = 4) in vec4 instance_scale;         // of the mesh; w: its pattern's cell, m
layout(location = 5) in vec4 instance_color;         // linear; w: roughness
layout(location = 6) in vec4 instance_look;          // metallic, pattern; z, w: place in the occlusion atlas, texels
layout(location = 7) in vec4 instance_tile;          // edge of its tiles there (0: none, it is open); face of a box, 1 of a mesh
                                                     // with two sides; its surface's number; 1: looks into the near shadow map
layout(location = 8) in uint mesh_probe;             // whose sky light a vertex of the scene's own meshes has
layout(location = 9) in vec2 mesh_texel;             // or where its texel is, from its place in the occlusion atlas on

#include "rotate.glsl"

vec3 placed(vec3 local) { return instance_position.xyz + rotate(instance_orientation, local); }
