#version 410 core
#include "body.glsl"

in vec3 v_local;                    // m
in vec3 v_normal;
#ifdef CHARTED
in vec2 v_texel;
#else
in float v_open;
#endif

void main() {
    vec3 normal = normalize(v_normal);
    normal = gl_FrontFacing ? normal : -normal;   // the inside of an open mesh is visible
    float paint = 1.0;
#ifdef PATTERNED
    paint = triplanar_paint(v_pattern, v_local, normal);
#endif
#ifdef CHARTED
    float open = textureLod(occlusion_atlas, v_texel, 0.0).r;
#else
    float open = v_open;
#endif
    open = gl_FrontFacing ? open : 1.0;           // occluders near the outer side do not apply to the inner side
    pixel = body_pixel(v_local, normal, v_diffuse, paint, open, vec2(0.0));
}
