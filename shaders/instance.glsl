// Placement and material of one drawn body (struct Instance of render/mesh/mesh_buffer.h).
layout(location = 0) in vec3 mesh_position;
layout(location = 1) in vec3 mesh_normal;
layout(location = 2) in vec4 instance_position;      // m, relative to the eye; w: bevel, m
layout(location = 3) in vec4 instance_orientation;   // unit quaternion x, y, z, w
layout(location = 4) in vec4 instance_scale;         // of the mesh; w: cell of its pattern, m
layout(location = 5) in vec4 instance_color;         // linear; w: roughness
layout(location = 6) in vec4 instance_material;   // metallic, pattern; z, w: place in the AO atlas, texels
// edge of its AO tiles, texels (0: none, unoccluded); face of a box, 1 for a mesh
layout(location = 7) in vec4 instance_tile;
                                                     // with two sides; surface id; 1: uses the near shadow map
// second color of a pattern, linear; of a texture: images around and along a ball; w: m that an image covers, or 0
layout(location = 8) in vec4 instance_paint;
// index of the vertex sample whose sky visibility applies; meshes of the scene only
layout(location = 9) in uint mesh_sample;
layout(location = 10) in vec2 mesh_texel;             // or place of its texel, relative to the mesh's place in the AO atlas
// Colors of the mesh's file (struct VertexPaint of scene/description/painted_mesh.h).
layout(location = 11) in vec2 mesh_uv;
layout(location = 12) in vec3 mesh_color;            // linear
// roughness, metallic (below 0: the body's); alpha below which is a hole (below 0: alpha multiplies the opacity); opacity
layout(location = 13) in vec4 mesh_surface;
layout(location = 14) in vec3 mesh_emission;
layout(location = 15) in vec4 instance_glow;         // emission, linear; w: opacity

#include "rotate.glsl"

vec3 placed(vec3 local) { return instance_position.xyz + rotate(instance_orientation, local); }
