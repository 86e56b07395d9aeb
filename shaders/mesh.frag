#version 410 core
#include "frame.glsl"
#include "body.glsl"
#include "rotate.glsl"
#include "lighting.glsl"
#include "pattern.glsl"

void main() {
    vec3 normal = normalize(v_normal);
    normal = gl_FrontFacing ? normal : -normal;   // an open mesh shows its inside too

    vec3 albedo = v_color.rgb;
    if (v_look.y > 0.5) albedo = patterned(albedo, v_look.y, v_local, rotate_back(v_orientation, normal), 0.5 * v_scale.w);

    Surface surface;
    surface.position = v_position;
    surface.normal = normal;
    surface.face_normal = normal;
    surface.albedo = albedo;
    surface.roughness = v_color.w;
    surface.metallic = v_look.x;
    surface.reach = v_scale.w;
    surface.body = v_look.z;
    pixel = vec4(shade(surface), 1.0);
}
