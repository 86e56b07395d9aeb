#version 410 core
#include "frame.glsl"
#include "body.glsl"

flat in vec3 v_normal;
in vec2 v_atlas;
flat in vec4 v_rim;

// How much of the pixel lies in the groove between a crate's frame and its panel.
float groove(vec3 to_edges) {
    // to_edges: distances to the three pairs of faces; the smallest is this face's own (0), the middle the edge's
    float edge = max(min(to_edges.x, to_edges.y), min(max(to_edges.x, to_edges.y), to_edges.z));
    float shortest = 2.0 * min(v_scale.x, min(v_scale.y, v_scale.z));
    float footprint = max(fwidth(edge), 1e-6 * shortest);
    float half_width = 0.5 * crate_groove * shortest;
    float off = abs(edge - crate_frame * shortest);
    return clamp((half_width - off) / footprint + 0.5, 0.0, 1.0) * min(1.0, 2.0 * half_width / footprint);
}

void main() {
    vec3 half_size = v_scale.xyz;
    // At the rim of a face seen edge-on the pixel's middle can lie far outside of it: back onto the box, and its tile.
    vec3 local = clamp(v_local, -half_size, half_size);
    // A rounded box's normal: away from the box that is smaller by the bevel.
    vec3 inner = half_size - v_look.z;
    vec3 local_normal = normalize(local - clamp(local, -inner, inner));

    vec3 albedo = v_color.rgb;
#ifdef PATTERNED
    albedo = patterned(albedo, v_look.y, local, local_normal, v_scale.w);
#else
    albedo *= 1.0 - crate_groove_depth * groove(half_size - abs(local));
#endif
    float open = texture(occlusion_atlas, clamp(v_atlas, v_rim.xy, v_rim.zw)).r;
    pixel = vec4(shade(body_surface(rotate(v_orientation, local_normal), v_normal, albedo, open)), v_look.w);
}
