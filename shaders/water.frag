#version 410 core
// The surface of [water] over the finished picture, of which it reads the color and the depth. The light from below is
// tinted by its way through the water (Beer's law); the sky and, if REFLECTIVE, bodies are mirrored (Fresnel). WAVES is
// their number, WAVE_LIST has k, 1/m, and amplitude, m, of each. EYE_BELOW: the eye is in the water.
#include "lighting.glsl"

uniform sampler2D seen_color;
uniform sampler2D seen_depth;

flat in vec4 v_water;           // see water.vert
flat in vec4 v_absorbed;
flat in vec4 v_to_light;
#ifdef WAVES
flat in vec4 v_phases[4];
const vec3 waves[WAVES] = vec3[WAVES](WAVE_LIST);
#endif
#ifdef ENVIRONMENT
flat in vec3 v_sun_share;
#endif
#ifdef BACKGROUND
flat in vec4 v_low, v_high;
#endif
#ifdef REFLECTIVE
uniform sampler2D reflection_image;     // bodies, straight alpha; from right to left
flat in vec3 v_clip_x, v_clip_y, v_clip_w;
#endif
in vec3 v_at;

layout(location = 0) out vec4 pixel;

// The light that displayed() showed as this.
vec3 light_of_shown(vec3 shown) {
    // Cubic fit to IEC 61966-2-1 (1999), to 0.002.
    vec3 light = shown * (0.012522878 + shown * (0.682171111 + shown * 0.305306011));
#ifndef LINEAR_TONE
    vec3 shoulder = 0.62 - 0.38 * log(max((1.0 - light) / 0.38, 1e-3));
    light = mix(light, shoulder, step(0.62, light));
#endif
#ifdef EXPOSURE
    light /= EXPOSURE;
#endif
    return light;
}

vec3 through_water(vec3 light, float way) {
    vec3 kept = exp(-v_absorbed.rgb * min(way, 1e6));
    return light * kept + v_water.rgb * (1.0 - kept);
}

vec3 sky_along(vec3 ray) {
#ifdef BACKGROUND
    return background(ray, v_low, v_high);
#else
    return sky(ray.y, dot(ray, v_to_light.xyz));
#endif
}

#ifdef REFLECTIVE
// Between the pixels of the image: shown color times alpha. `at`: pixels, from left to right as seen here.
vec4 reflected_at(vec2 at) {
    ivec2 last = textureSize(reflection_image, 0) - 1;
    vec2 place = at - 0.5, share = fract(place);
    vec4 sum = vec4(0.0);
    for (int i = 0; i < 4; ++i) {
        ivec2 corner = ivec2(i & 1, i >> 1), from = clamp(ivec2(floor(place)) + corner, ivec2(0), last);
        vec4 texel = texelFetch(reflection_image, ivec2(last.x - from.x, from.y), 0);
        vec2 weight = mix(1.0 - share, share, vec2(corner));
        sum += weight.x * weight.y * vec4(texel.rgb * texel.a, texel.a);
    }
    return sum;
}
#endif

// The smaller of the two changes of the depth to the neighbors: that within the surface of this pixel.
float change_of_depth(ivec2 at, ivec2 way, float depth) {
    ivec2 last = textureSize(seen_depth, 0) - 1;
    float after = texelFetch(seen_depth, min(at + way, last), 0).r - depth;
    float before = depth - texelFetch(seen_depth, max(at - way, ivec2(0)), 0).r;
    return abs(after) < abs(before) ? after : before;
}

void main() {
    ivec2 at = ivec2(gl_FragCoord.xy);
    vec4 seen = texelFetch(seen_color, at, 0);
    float depth = texelFetch(seen_depth, at, 0).r;              // 1 - near / distance
    float behind = v_water.w / max(1.0 - depth, 1e-12);         // m, along the axis of the view
    vec3 below = light_of_shown(seen.rgb);
#ifdef EYE_BELOW
    float surface = v_at.y > 0.0 ? -v_absorbed.w / v_at.y : 1e9;
    pixel = vec4(dithered(displayed(through_water(below, min(behind, surface) * length(v_at)))), seen.a);
#else
    // Coverage of the pixel: along a water line the depths of both surfaces cross.
    float axis = 1.0 / gl_FragCoord.w, own = 1.0 - v_water.w / axis;
    vec2 change = vec2(change_of_depth(at, ivec2(1, 0), depth) - dFdx(own), change_of_depth(at, ivec2(0, 1), depth) - dFdy(own));
    float covered = clamp(0.5 + (depth - own) / max(abs(change.x) + abs(change.y), 1e-12), 0.0, 1.0);
    if (covered == 0.0) discard;

    float far = length(v_at);
    vec3 view = v_at / far, normal = vec3(0.0, 1.0, 0.0);
    float hidden = 0.0;         // mean square slope of waves narrower than the pixel
#ifdef WAVES
    vec2 dx = dFdx(v_at.xz), dy = dFdy(v_at.xz);
    for (int i = 0; i < WAVES; ++i) {
        vec2 k = waves[i].xy;
        float width = abs(dot(k, dx)) + abs(dot(k, dy)), slope = waves[i].z * length(k), left = exp2(-0.5 * width * width);
        normal.xz += waves[i].z * left * sin(dot(k, v_at.xz) + v_phases[i >> 2][i & 3]) * k;
        hidden += 0.5 * slope * slope * (1.0 - left * left);
    }
    normal = normalize(normal);
#endif
    float n_v = dot(normal, -view);
    float grazing = 1.0 - min(sqrt(n_v * n_v + hidden), 1.0), grazing2 = grazing * grazing;
    float mirrors = water_reflectance + (1.0 - water_reflectance) * (grazing2 * grazing2 * grazing);
    vec3 mirrored = view + 2.0 * n_v * normal;
    mirrored.y = abs(mirrored.y);       // a ray into the next wave meets the sky after it
#ifdef ENVIRONMENT
    vec3 light = light_mirrored(mirrored, 0.0);
#else
    vec3 light = sky_along(mirrored);
#endif
#ifdef REFLECTIVE
    // The image is that of a mirror at the level: a water line that is higher by h is lower by h in it. The slope of a
    // wave moves bodies as if they were rather far away.
    float high = v_at.y + v_absorbed.w;
    vec3 shown_ray = normalize(v_at - vec3(0.0, 2.0 * high, 0.0)) + reflection_way * (vec3(mirrored.x, -mirrored.y, mirrored.z) - view);
    vec2 shown_at = vec2(dot(v_clip_x, shown_ray), dot(v_clip_y, shown_ray)) / max(dot(v_clip_w, shown_ray), 1e-3);
    vec4 bodies = reflected_at((0.5 + 0.5 * shown_at) * vec2(textureSize(reflection_image, 0)));
    light = mix(light, light_of_shown(bodies.rgb / max(bodies.a, 1e-3)), bodies.a);
#endif
    light = mix(through_water(below, max(behind - axis, 0.0) * far / axis), light, mirrors);

    vec3 middle = normalize(v_to_light.xyz - view);
    float n_l = clamp(dot(normal, v_to_light.xyz), 0.0, 1.0), edge = 1.0 - clamp(dot(middle, -view), 0.0, 1.0);
    float edge2 = edge * edge;
    float roughness = sqrt(sqrt(water_glint * water_glint + 2.0 * hidden));
    float lobe = min(specular_lobe(roughness, clamp(dot(normal, middle), 0.0, 1.0), max(n_l, 1e-3), max(n_v, 1e-3)), brightest_glint);
    vec3 glint = v_sun * (n_l * lobe * (water_reflectance + (1.0 - water_reflectance) * edge2 * edge2 * edge));
#ifdef ENVIRONMENT
    glint *= v_sun_share;
#endif
    light += glint;

#ifdef BACKGROUND
    light = mix(light, sky_along(view), haze_share(far * far, v_to_light.w));
#else
    light = mix(light, sky_along(view), fog_share(far * far, v_to_light.w));
#endif
    pixel = vec4(dithered(mix(seen.rgb, displayed(light), covered)), seen.a);
#endif
}
