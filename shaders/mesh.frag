#version 410 core
#include "frame.glsl"
#include "body.glsl"

in vec3 v_normal;
in float v_open;

void main() {
    vec3 normal = normalize(v_normal);
    normal = gl_FrontFacing ? normal : -normal;   // an open mesh shows its inside too
    vec3 albedo = v_color.rgb;
#ifdef PATTERNED
    albedo = patterned(albedo, v_look.y, v_local, rotate_back(v_orientation, normal), v_scale.w);
#endif
    pixel = vec4(shade(body_surface(normal, albedo, v_open)), v_look.w);
}
