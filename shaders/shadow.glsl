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

// The same where each pixel finds out which map it lies in: places as place_in_map() gives them.
float sun_visible(vec3 in_near, vec3 in_far) {
    const float margin = 5.0 / SHADOW_TEXELS;
    float from_middle = max(abs(in_near.x - 0.5), abs(in_near.y - 0.5));
    float near = from_middle < 0.5 - margin ? 1.0 : 0.0;
    float from_edge = 0.5 - max(abs(in_far.x - 0.5), abs(in_far.y - 0.5));   // the far map's shadows fade out at its rim
    float inside = max(near, clamp((from_edge - margin) * 16.0, 0.0, 1.0));
    vec3 at = mix(in_far + vec3(1.0, 0.0, 0.0), in_near, near);
    return mix(1.0, filtered_shadow(at.xy * SHADOW_TEXELS - 0.5, clamp(at.z, 0.0, 1.0)), inside);
}
