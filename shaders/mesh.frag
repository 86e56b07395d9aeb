#version 410 core
#include "body.glsl"

in vec3 v_local;                    // m
in vec3 v_normal;
in float v_open;

void main() {
    vec3 normal = normalize(v_normal);
    normal = gl_FrontFacing ? normal : -normal;   // an open mesh shows its inside too
    float paint = 1.0;
#ifdef PATTERNED
    paint = triplanar_paint(v_pattern, v_local, normal);
#endif
    pixel = body_pixel(v_local, normal, v_diffuse, paint, v_open);
}
