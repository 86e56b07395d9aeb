// How much of the sun a point sees.
uniform sampler2DShadow shadow_map;

float filtered_shadow(vec2 t, float depth) {
    // Castano 2013, Shadow Mapping Summary: 3x3 bilinear percentage-closer filter, here by four gathers
    vec2 base = floor(t);
    vec2 f = t - base;
    vec2 low = 1.0 - f;
    const vec2 texel = vec2(0.5, 1.0) / SHADOW_TEXELS;
    vec2 at = base * texel;   // the corner that texels -1, 0 | 0, 1 share is at base
    vec4 a = textureGather(shadow_map, at, depth);
    vec4 b = textureGather(shadow_map, at + vec2(2.0, 0.0) * texel, depth);
    vec4 c = textureGather(shadow_map, at + vec2(0.0, 2.0) * texel, depth);
    vec4 d = textureGather(shadow_map, at + vec2(2.0, 2.0) * texel, depth);
    // a gather's x, y, z, w: (0,1), (1,1), (1,0), (0,0); weights over the four columns: 1-f, 1, 1, f
    float row0 = a.w * low.x + a.z + b.w + b.z * f.x;
    float row1 = a.x * low.x + a.y + b.x + b.y * f.x;
    float row2 = c.w * low.x + c.z + d.w + d.z * f.x;
    float row3 = c.x * low.x + c.y + d.x + d.y * f.x;
    // exactly 1 in the open, whatever the rounding of the weights: there the look-up may be left out
    return min((row0 * low.y + row1 + row2 + row3 * f.y) * (1.00001 / 9.0), 1.0);
}

// `place` as shadow_place() gives it.
float sun_visible(vec4 place) {
    return mix(1.0, filtered_shadow(place.xy, clamp(place.z, 0.0, 1.0)), place.w);
}
