// Share of the sun that is visible from a point. Arguments of filtered_shadow() are x, y: texels across both maps, less
// a half; z: depth.
uniform sampler2DShadow shadow_map;

#ifdef PIXEL_SHADOWS
// Where texels of the map are smaller than pixels: the mean of four samples in the pixel, on a rotated grid.
float bilinear_shadow(vec3 at) {
    vec2 base = floor(at.xy);
    vec2 f = at.xy - base;
    vec4 lit = textureGather(shadow_map, (base + 1.0) * (vec2(0.5, 1.0) / SHADOW_TEXELS), clamp(at.z, 0.0, 1.0));
    vec2 rows = mix(lit.wx, lit.zy, f.x);   // x, y, z, w: (0,1), (1,1), (1,0), (0,0)
    return mix(rows.x, rows.y, f.y);
}

// Step to the next pixel on the surface, limited by the margins of the map and at least as long as the texels' own
// blur; in depth never farther than the surface moves in a pixel, because it may turn towards the sun.
vec3 pixel_step(vec3 way, float most) {
    float texels = max(length(way.xy), 1e-6);
    float scale = clamp(texels, LEAST_STEP, most) / texels;
    return way * vec3(scale, scale, min(scale, 1.0));
}

float filtered_shadow(vec3 at, vec3 to_right, vec3 to_next, float most) {
    vec3 right = pixel_step(to_right, most), down = pixel_step(to_next, most);
    vec3 a = 0.125 * right + 0.375 * down, b = 0.375 * right - 0.125 * down;
    float lit = bilinear_shadow(at + a) + bilinear_shadow(at - a) + bilinear_shadow(at + b) + bilinear_shadow(at - b);
    return min(lit * (1.00001 / 4.0), 1.0);   // exactly 1 without a shadow, as below
}

float filtered_shadow(vec3 at) { return filtered_shadow(at, dFdx(at), dFdy(at), MOST_STEP); }
#else
float filtered_shadow(vec3 place) { return kernel_shadow(shadow_map, vec2(0.5, 1.0) / SHADOW_TEXELS, place); }
#endif

// `place`: from shadow_place().
float sun_visible(vec4 place) {
    return mix(1.0, filtered_shadow(place.xyz), place.w);
}

// The same for a pixel that selects its map; places from place_in_map().
float sun_visible(vec3 in_near, vec3 in_far) {
    const float margin = 5.0 / SHADOW_TEXELS;
    float from_middle = max(abs(in_near.x - 0.5), abs(in_near.y - 0.5));
    float near = from_middle < 0.5 - margin ? 1.0 : 0.0;
    float from_edge = 0.5 - max(abs(in_far.x - 0.5), abs(in_far.y - 0.5));   // shadows of the far map fade out at its border
    float inside = max(near, clamp((from_edge - margin) * 16.0, 0.0, 1.0));
    vec3 at = mix(in_far + vec3(1.0, 0.0, 0.0), in_near, near);
    vec3 place = vec3(at.xy * SHADOW_TEXELS - 0.5, at.z);
#ifdef PIXEL_SHADOWS
    // Steps within one map, on both sides of the near one's border. In the far map they have at most the same length,
    // in meters.
    vec3 scale = vec3(SHADOW_TEXELS, SHADOW_TEXELS, 1.0);
    vec3 right = scale * mix(dFdx(in_far), dFdx(in_near), near), down = scale * mix(dFdy(in_far), dFdy(in_near), near);
    float far_part = length(dFdx(in_far.xy)) / max(length(dFdx(in_near.xy)), 1e-12);
    return mix(1.0, filtered_shadow(place, right, down, max(LEAST_STEP, MOST_STEP * mix(far_part, 1.0, near))), inside);
#else
    return mix(1.0, filtered_shadow(place), inside);
#endif
}
