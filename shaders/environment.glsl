// Light from all sides, and the background, of a scene with [environment] (render/environment). Defines: ENVIRONMENT for
// light of an image; BACKGROUND 1 of colors, 2 of an image. World axes.

#ifdef ENVIRONMENT
uniform sampler2D environment_map;

const float mirror_tiles = 8.0;     // of growing roughness after the first, which is sharp

// Irradiance over pi at a surface with this normal. Ramamoorthi and Hanrahan 2001, An Efficient Representation for
// Irradiance Environment Maps
vec3 light_around(vec3 n, vec3 c[9]) {
    vec3 light = c[0] + c[1] * n.x + c[2] * n.y + c[3] * n.z + c[4] * (n.x * n.y) + c[5] * (n.y * n.z) + c[6] * (n.x * n.z) +
                 c[7] * (n.z * n.z) + c[8] * (n.x * n.x - n.y * n.y);
    return max(light, 0.0);
}

// Radiance from a direction, averaged over the lobe of a surface of this roughness.
vec3 light_mirrored(vec3 direction, float roughness) {
    // Meyer et al. 2010, On Floating-Point Normal Vectors: octahedral map
    vec2 p = direction.xz / (abs(direction.x) + abs(direction.y) + abs(direction.z));
    vec2 folded = (1.0 - abs(p.yx)) * vec2(p.x >= 0.0 ? 1.0 : -1.0, p.y >= 0.0 ? 1.0 : -1.0);
    p = direction.y >= 0.0 ? p : folded;
    float tile = floor(mirror_tiles * sqrt(max(roughness - 0.06, 0.0) / 0.94) + 0.5);
    float after = tile - 1.0, row = floor(0.5 * after);
    // A tile of 128 texels, and below it pairs of 64; each has a rim of one texel.
    vec2 corner = tile < 0.5 ? vec2(0.0) : vec2(64.0 * (after - 2.0 * row), 128.0 + 64.0 * row);
    float half_side = tile < 0.5 ? 63.0 : 31.0;
    vec2 at = corner + 1.0 + half_side * (1.0 + p);
    return textureLod(environment_map, at / vec2(128.0, 128.0 + 32.0 * mirror_tiles), 0.0).rgb;
}
#endif

#ifdef BACKGROUND
// The share of a plane's light that is replaced by that of the background: it grows more slowly than fog, because both
// may differ much, and a narrow transition would be a line.
float haze_share(float squared, float per_half) {
    float relative = 2.0 * squared * per_half;
    return relative / (0.35 / max(relative, 1e-9) + 1.0 + relative);
}

#if BACKGROUND == 2
uniform sampler2D background_image;
#endif

// Radiance from behind everything. `low`, `high`: colors of the horizon and of the zenith; of an image, low.w is the
// shift around: 1 is a whole turn.
vec3 background(vec3 ray, vec4 low, vec4 high) {
#if BACKGROUND == 2
    vec2 place = vec2(atan(ray.z, ray.x) * 0.15915494 + 0.5 + low.w, atan(length(ray.xz), ray.y) * 0.31830989);
    return textureLod(background_image, place, 0.0).rgb;
#else
    float up = max(ray.y, 0.0);
    return mix(low.rgb, high.rgb, 1.0 - 1.0 / (1.0 + horizon_falloff * up * (1.0 + up)));
#endif
}
#endif
