#version 410 core
#include "frame.glsl"
#include "body.glsl"

in vec2 v_on_face;                  // m, from the face's middle along its axes
flat in vec2 v_half;                // m, half the face's size
flat in vec3 v_normal;              // world axes: of the face, and its two own
flat in vec3 v_along_a;
flat in vec3 v_along_b;
flat in vec4 v_tile;                // place of the face's middle in the occlusion atlas, and of a metre along its axes
flat in vec2 v_groove;              // m: how far from the edge it is, and half its width

// How much of the pixel lies in the groove between a crate's frame and its panel.
float groove(vec2 on_face) {
    vec2 to_edges = v_half - abs(on_face);
    float edge = min(to_edges.x, to_edges.y);
    float footprint = max(fwidth(edge), 1e-4 * v_groove.x);
    float off = abs(edge - v_groove.x);
    return clamp((v_groove.y - off) / footprint + 0.5, 0.0, 1.0) * min(1.0, 2.0 * v_groove.y / footprint);
}

void main() {
    // At the rim of a face seen edge-on the pixel's middle can lie far outside of it: back onto the box, and its tile.
    vec2 on_face = clamp(v_on_face, -v_half, v_half);
    // A rounded box's normal: away from the box that is smaller by the bevel.
    float bevel = v_look.z;
    vec2 bent = on_face - clamp(on_face, bevel - v_half, v_half - bevel);
    vec3 normal = normalize(v_normal * bevel + v_along_a * bent.x + v_along_b * bent.y);

    vec3 albedo = v_color.rgb;
#ifdef PATTERNED
    albedo = patterned(albedo, v_look.y, v_local, rotate_back(v_orientation, v_normal), v_scale.w);
#else
    albedo *= 1.0 - crate_groove_depth * groove(on_face);
#endif
    float open = textureLod(occlusion_atlas, v_tile.xy + on_face * v_tile.zw, 0.0).r;
    pixel = vec4(shade(body_surface(normal, albedo, open)), v_look.w);
}
