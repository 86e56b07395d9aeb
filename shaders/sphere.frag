#version 410 core
#include "frame.glsl"
#include "body.glsl"
#include "rotate.glsl"
#include "lighting.glsl"
#include "pattern.glsl"

// 1 on every other octant, 0 on the rest, filtered over the pixel: shows how the ball turns.
float octant(vec3 direction) {
    vec3 side = clamp(direction / max(fwidth(direction), vec3(1e-6)), -1.0, 1.0);
    return 0.5 + 0.5 * side.x * side.y * side.z;
}

void main() {
    vec3 direction = normalize(v_local);

    vec3 albedo = v_color.rgb;
    if (v_look.y > 0.5) {
        albedo = patterned(albedo, v_look.y, v_local, direction, 0.5 * v_scale.x);
    } else {
        albedo = mix(albedo, vec3(1.0), ball_contrast * octant(direction));
    }

    Surface surface;
    surface.position = v_position;
    surface.normal = rotate(v_orientation, direction);
    surface.face_normal = surface.normal;
    surface.albedo = albedo;
    surface.roughness = v_color.w;
    surface.metallic = v_look.x;
    surface.reach = v_scale.w;
    surface.body = v_look.z;
    pixel = vec4(shade(surface), 1.0);
}
