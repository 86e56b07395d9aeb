// Shift of a point's depth towards the sun. Before a lit wall, some texels of the kernel lie on the wall, nearer to the
// sun than the point: without the shift they would darken the foot of the wall in teeth.
float shadow_lift(bool near) {
    return shadow_texels.z * (near ? shadow_texels.x : shadow_texels.y) * length(shadow_z.xyz);
}

// Coordinates of a point in the shadow maps, the near one and the far one around it. x, y: across the map, 0 to 1; z:
// depth.
vec3 place_in_map(vec3 position, vec3 face_normal, bool near) {
    vec3 lifted = position + face_normal * (shadow_texels.w * (near ? shadow_texels.x : shadow_texels.y));
    vec2 uv = vec2(dot(shadow_x.xyz, lifted) + shadow_x.w, dot(shadow_y.xyz, lifted) + shadow_y.w);
    float depth = dot(shadow_z.xyz, lifted) + shadow_z.w - shadow_lift(near);
    return vec3(near ? uv : uv * shadow_far.x + shadow_far.yz, depth);
}

// For a body that uses only one of the maps, which are side by side. x, y: texels across the texture, less a half; z:
// depth; w: weight of a shadow there, 0 without a map.
vec4 shadow_place(vec3 position, vec3 face_normal, bool near) {
    const float size = SHADOW_TEXELS, margin = 5.0 / size;
    vec3 place = place_in_map(position, face_normal, near);
    vec2 uv = place.xy;
    float from_edge = 0.5 - max(abs(uv.x - 0.5), abs(uv.y - 0.5));   // shadows of the far map fade out at its border
    float inside = near ? 1.0 : clamp((from_edge - margin) * 16.0, 0.0, 1.0) * shadow_far.w;
    uv = clamp(uv, margin, 1.0 - margin);
    return vec4((uv + vec2(near ? 0.0 : 1.0, 0.0)) * size - 0.5, place.z, inside * to_light.w);
}
