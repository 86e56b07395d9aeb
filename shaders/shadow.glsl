// How much of the sun a point sees, from the near shadow map or, around it, the far one. Both lie side by side.
uniform sampler2DShadow shadow_map;

float filtered_shadow(vec2 uv, float depth, vec2 first, float size) {
    // Castano 2013, Shadow Mapping Summary: 3x3 bilinear percentage-closer filter, here by four gathers
    vec2 t = uv * size - 0.5;
    vec2 base = floor(t);
    vec2 f = t - base;
    vec2 low = 1.0 - f;
    vec2 step_size = vec2(0.5, 1.0) / size;
    vec2 at = (first * size + base) * step_size;   // the corner that texels -1, 0 | 0, 1 share is at base
    vec4 a = textureGather(shadow_map, at, depth);
    vec4 b = textureGather(shadow_map, at + vec2(2.0, 0.0) * step_size, depth);
    vec4 c = textureGather(shadow_map, at + vec2(0.0, 2.0) * step_size, depth);
    vec4 d = textureGather(shadow_map, at + vec2(2.0, 2.0) * step_size, depth);
    // a gather's x, y, z, w: (0,1), (1,1), (1,0), (0,0); weights over the four columns: 1-f, 1, 1, f
    float row0 = a.w * low.x + a.z + b.w + b.z * f.x;
    float row1 = a.x * low.x + a.y + b.x + b.y * f.x;
    float row2 = c.w * low.x + c.z + d.w + d.z * f.x;
    float row3 = c.x * low.x + c.y + d.x + d.y * f.x;
    // exactly 1 in the open, whatever the rounding of the weights: there the look-up may be left out
    return min((row0 * low.y + row1 + row2 + row3 * f.y) * (1.00001 / 9.0), 1.0);
}

float sun_visible(vec3 position, vec3 face_normal) {
    vec2 across = vec2(dot(shadow_x.xyz, position) + shadow_x.w, dot(shadow_y.xyz, position) + shadow_y.w);
    float size = shadow_texels.z;
    float margin = 5.0 / size;
    bool near = max(abs(across.x - 0.5), abs(across.y - 0.5)) < 0.5 - margin;

    vec3 lifted = position + face_normal * (shadow_offset * (near ? shadow_texels.x : shadow_texels.y));
    vec2 uv = vec2(dot(shadow_x.xyz, lifted) + shadow_x.w, dot(shadow_y.xyz, lifted) + shadow_y.w);
    float depth = clamp(dot(shadow_z.xyz, lifted) + shadow_z.w, 0.0, 1.0);
    uv = near ? uv : uv * shadow_far.x + shadow_far.yz;

    float from_edge = 0.5 - max(abs(uv.x - 0.5), abs(uv.y - 0.5));   // the shadows of the far map fade out at its rim
    float inside = near ? 1.0 : clamp((from_edge - margin) * 16.0, 0.0, 1.0) * shadow_far.w;
    uv = clamp(uv, margin, 1.0 - margin);
    return mix(1.0, filtered_shadow(uv, depth, vec2(near ? 0.0 : 1.0, 0.0), size), inside * to_light.w);
}
