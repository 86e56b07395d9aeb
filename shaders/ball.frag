#version 410 core
#include "frame.glsl"
#include "body.glsl"

flat in vec3 v_tile;

// 1 on every other octant, 0 on the rest, filtered over the pixel: shows how the ball turns.
float octant(vec3 direction) {
    vec3 side = clamp(direction / max(fwidth(direction), vec3(1e-6)), -1.0, 1.0);
    return 0.5 + 0.5 * side.x * side.y * side.z;
}

vec2 octahedral(vec3 n) {
    // Meyer et al. 2010, On Floating-Point Normal Vectors: the sphere unfolded onto a square
    vec2 p = n.xy / (abs(n.x) + abs(n.y) + abs(n.z));
    vec2 folded = (1.0 - abs(p.yx)) * vec2(p.x >= 0.0 ? 1.0 : -1.0, p.y >= 0.0 ? 1.0 : -1.0);
    return n.z >= 0.0 ? p : folded;
}

void main() {
    vec3 direction = normalize(v_local);

    vec3 albedo = v_color.rgb;
#ifdef PATTERNED
    albedo = patterned(albedo, v_look.y, v_local, direction, v_scale.w);
#else
    albedo = mix(albedo, vec3(1.0), ball_contrast * octant(direction) * (1.0 - v_look.x));
    albedo *= 1.0 - ball_contrast * octant(direction) * v_look.x;   // metal has no paler paint
#endif
    vec2 texel = v_tile.xy + (0.5 + 0.5 * octahedral(direction)) * max(v_tile.z - 1.0, 0.0) + 0.5;
    float open = texture(occlusion_atlas, (v_tile.z > 0.0 ? texel : vec2(0.5)) * atlas.xy).r;
    vec3 normal = rotate(v_orientation, direction);
    pixel = vec4(shade(body_surface(normal, albedo, open)), v_look.w);
}
