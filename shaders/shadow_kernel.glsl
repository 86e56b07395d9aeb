// Castano 2013, Shadow Mapping Summary: 3x3 bilinear percentage-closer filter, here by four gathers. `place`: texels,
// less a half, and depth; `texel`: size of a texel.
float kernel_shadow(sampler2DShadow map, vec2 texel, vec3 place) {
    vec2 t = place.xy;
    float depth = clamp(place.z, 0.0, 1.0);
    vec2 base = floor(t);
    vec2 f = t - base;
    vec2 low = 1.0 - f;
    vec2 at = base * texel;   // the corner that texels -1, 0 | 0, 1 share is at base
    vec4 a = textureGather(map, at, depth);
    vec4 b = textureGather(map, at + vec2(2.0, 0.0) * texel, depth);
    vec4 c = textureGather(map, at + vec2(0.0, 2.0) * texel, depth);
    vec4 d = textureGather(map, at + vec2(2.0, 2.0) * texel, depth);
    // a gather's x, y, z, w: (0,1), (1,1), (1,0), (0,0); weights over the four columns: 1-f, 1, 1, f
    float row0 = a.w * low.x + a.z + b.w + b.z * f.x;
    float row1 = a.x * low.x + a.y + b.x + b.y * f.x;
    float row2 = c.w * low.x + c.z + d.w + d.z * f.x;
    float row3 = c.x * low.x + c.y + d.x + d.y * f.x;
    // exactly 1 without a shadow, for any rounding of the weights, because culled lookups give 1
    return min((row0 * low.y + row1 + row2 + row3 * f.y) * (1.00001 / 9.0), 1.0);
}
