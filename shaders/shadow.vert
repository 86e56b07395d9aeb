#version 410 core
#include "frame.glsl"
#include "instance.glsl"

#ifdef LAMP_MAP
#include "lamps_block.glsl"
#else
uniform int far_map;
#endif
#ifdef SIEVED
flat out float v_shade;
#ifdef PAINTED
uniform sampler2D mesh_texture;
out vec2 v_uv;
flat out vec2 v_image;
flat out float v_hole;
#endif
#endif

void main() {
    vec3 p = placed(mesh_position * instance_scale.xyz);
#ifdef LAMP_MAP
    vec4 q = vec4(p, 1.0);
    gl_Position = vec4(dot(lamp_map[0], q), dot(lamp_map[1], q), dot(lamp_map[2], q), dot(lamp_map[3], q));
#else
    vec3 at = vec3(dot(shadow_x.xyz, p) + shadow_x.w, dot(shadow_y.xyz, p) + shadow_y.w,
                   dot(shadow_z.xyz, p) + shadow_z.w);
    if (far_map != 0) at.xy = at.xy * shadow_far.x + shadow_far.yz;
    gl_Position = vec4(2.0 * at - 1.0, 1.0);
#endif
#ifdef SIEVED
    v_shade = instance_glow.w;
#ifdef PAINTED
    v_shade *= mesh_surface.w;
    v_uv = mesh_uv;
    v_image = vec2(textureSize(mesh_texture, 0));
    v_hole = mesh_surface.z;
#endif
#endif
}
