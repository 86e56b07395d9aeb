// One drawn body's placement and look (struct Instance of render/draw_list.h).
layout(location = 0) in vec3 mesh_position;
layout(location = 1) in vec3 mesh_normal;
layout(location = 2) in vec4 instance_position;      // relative to the eye; w: bevel, m
layout(location = 3) in vec4 instance_orientation;   // unit quaternion x, y, z, w
layout(location = 4) in vec4 instance_scale;         // of the mesh; w: occlusion reach, m
layout(location = 5) in vec4 instance_color;         // linear; w: roughness
layout(location = 6) in vec4 instance_look;          // metallic, pattern, body number

#include "rotate.glsl"

vec3 placed(vec3 local) { return instance_position.xyz + rotate(instance_orientation, local); }
