// From a surface point to the light that it sends to the eye, and from light to the bytes of the screen. In a fragment
// shader, llvmpipe reads a uniform lane by lane, with forty instructions each. Constants come as flat outputs of the
// vertex shader instead, and directions only as the cosines that lighting needs.
#include "light_constants.glsl"
#ifdef LAMP_LIGHT
#ifndef LAMP_VALUE                  // or uniform, in pages
#define LAMP_VALUE flat in
#endif
LAMP_VALUE vec3 v_sun;              // received by a surface facing the sun
#else
#define v_sun sun_light
#endif
#include "sky.glsl"
#if defined(ENVIRONMENT) || defined(BACKGROUND)
#include "environment.glsl"
#endif
#if defined(SHADOWED) || defined(LAMP_SHADOW)
#include "shadow_kernel.glsl"
#endif
#ifdef SHADOWED
#include "shadow.glsl"
#endif

struct Surface {
    float n_v;          // cosines: of the normal (bent at bevels) and the direction to the eye,
    float n_l;          // the normal and the direction to the sun,
    float l_v;          // the directions to the sun and to the eye
    float up;           // upward component of the normal
    float eye_up;       // and of the direction to the eye
    vec3 diffuse;       // linear
    vec3 f0;            // reflectance at normal incidence
    vec2 rough;         // see surface_roughness() of material.glsl
    float veil;
    float open;         // sky visibility past other bodies
    float sun;          // share of sunlight that is not in shadow
#ifdef FILTERED
    float lobe;         // see bevel_lobe()
#endif
#ifdef ENVIRONMENT
    vec3 around;        // see light_around()
    vec3 mirrored;      // see light_mirrored()
    vec3 sun_share;     // factor on the light of the sun
#endif
};

float specular_lobe(float roughness, float n_h, float n_l, float n_v) {
    // Walter et al. 2007, Microfacet Models for Refraction: the GGX distribution, with Hammon 2017, PBR Diffuse
    // Lighting for GGX+Smith: its visibility term without the roots
    float a = roughness * roughness;
    float a2 = a * a;
    float d = n_h * n_h * (a2 - 1.0) + 1.0;
    // D V without 1/pi: the sun's light is given as irradiance over pi
    return 0.5 * a2 / (d * d * mix(2.0 * n_l * n_v, n_l + n_v, a));
}

#ifdef FILTERED
// The same for a face of a box whose normal varies within the pixel. `to_half`: half vector between sun and eye;
// Tokuyoshi and Kaplanyan 2019, Improved Geometric Specular Antialiasing: the lobe (GGX with two widths) is widened by
// the spread
float bevel_lobe(float roughness, vec3 normal, vec3 to_half, vec2 spread, float n_l, float n_v) {
    // Tokuyoshi and Kaplanyan 2019, Improved Geometric Specular Antialiasing: the lobe (GGX with two widths) is as much wider
    float a = roughness * roughness, a2 = a * a;
    vec2 wide = a2 + spread;
    vec2 across = (to_half.xy * normal.z - normal.xy * to_half.z) * inversesqrt(normal.z * normal.z + normal.xy * normal.xy);
    vec2 shares = across * across / wide;
    float n_h = dot(normal, to_half);
    float q = shares.x + shares.y + n_h * n_h;
    // The part above the brightest highlight was at most this wide; spread out, it is darker by the same factor.
    float cut = max(a2, 0.5 * a / sqrt(brightest_highlight));
    vec2 kept = cut / (cut + spread);
    float left = kept.x * kept.y;
    return min(0.5 / (sqrt(wide.x * wide.y) * q * q * mix(2.0 * n_l * n_v, n_l + n_v, a)), brightest_highlight * left * left);
}
#endif

vec2 environment_scale(float roughness, float n_v) {
    // Karis 2014, Physically Based Shading on Mobile: the integral of the specular lobe, as scale and offset of F0
    vec4 r = roughness * vec4(-1.0, -0.0275, -0.572, 0.022) + vec4(1.0, 0.0425, 1.04, -0.04);
    float a = min(r.x * r.x, exp2(-9.28 * n_v)) * r.x + r.y;
    return vec2(-1.04, 1.04) * a + r.zw;
}

vec3 displayed(vec3 light) {
#ifdef EXPOSURE
    light *= EXPOSURE;
#endif
#ifdef LINEAR_TONE
    // IEC 61966-2-1 (1999)
    light = clamp(light, 0.0, 1.0);
    return mix(light * 12.92, 1.055 * pow(light, vec3(1.0 / 2.4)) - 0.055, step(0.0031308, light));
#else
    // Minimax fit in s = sqrt(light), to 0.8 levels of 255, of two steps at once: IEC 61966-2-1 (1999), the sRGB
    // transfer curve, of light itself up to 0.62 and of a shoulder above it, 1 - 0.38 exp(-(light - 0.62) / 0.38), that
    // never reaches white. One root and one quotient, no powers.
    vec3 s = sqrt(max(light, 0.0));
    vec3 rise = s * s * (21.217153 + s * (-35.617540 + s * 32.353397));
    return rise / (1.0 + s * (7.989843 + s * (8.709465 + s * (-30.195670 + s * 31.746583))));
#endif
}

// For gradients so flat that a step of one level (1/255) is visible as a band: adds -0.5 to 0.5 levels as a function of
// the pixel's place only. The nearest level, taken afterwards, has the right mean and is the same in every frame.
vec3 dithered(vec3 shown) {
    // Bayer 1973, An Optimum Method for Two-Level Rendition of Continuous-Tone Pictures: thresholds of an 8 x 8 square
    ivec2 at = ivec2(gl_FragCoord.xy);
    int across = at.x ^ at.y;
    int rank = (across & 1) << 5 | (at.y & 1) << 4 | (across & 2) << 2 | (at.y & 2) << 1 | (across & 4) >> 1 | (at.y & 4) >> 2;
    return shown + (float(rank) - 31.5) / (64.0 * 255.0);
}

#ifndef ENVIRONMENT
// Received by a surface that faces down. MIRROR_FLOOR: color of a mirroring floor, and the share that it mirrors. Its
// image shows the undersides of bodies, which are as bright as it is.
vec3 light_from_below() {
#ifdef MIRROR_FLOOR
    vec4 floor_below = MIRROR_FLOOR;
    vec3 upward = floor_below.rgb * floor_in_sun * (sun_light + sky_light);
    return max(bounce_light, mix(upward, sky_light, floor_below.a));
#else
    return bounce_light;
#endif
}
#endif

vec3 shade(Surface s) {
    float n_v = clamp(s.n_v, 1e-3, 1.0);
    vec2 environment = environment_scale(s.rough.x, n_v);
#ifdef ENVIRONMENT
    // Fdez-Aguera 2019, A Multiple-Scattering Microfacet Model for Real-Time Image-based Lighting: further
    // reflections return the loss of the first
    vec3 share = s.f0 * environment.x + environment.y;
    share *= 1.0 + s.f0 * (1.0 / (environment.x + environment.y) - 1.0);
    vec3 light = (s.diffuse * (1.0 - share) * s.around + share * s.mirrored) * s.open;
#else
    vec3 light = s.diffuse * (mix(light_from_below(), sky_light, 0.5 + 0.5 * s.up) * s.open);
#endif
#ifdef SUNLIT
    float n_l = clamp(s.n_l, 0.0, 1.0);
    float per_half = inversesqrt(max(2.0 + 2.0 * s.l_v, 1e-6));      // 1 / |sun + eye|
    float n_h = clamp((s.n_l + s.n_v) * per_half, 0.0, 1.0);
    float grazing = 1.0 - clamp((1.0 + s.l_v) * per_half, 0.0, 1.0);
    float grazing2 = grazing * grazing;         // Schlick 1994, An Inexpensive BRDF Model: Fresnel term
    vec3 fresnel = s.f0 + (1.0 - s.f0) * (grazing2 * grazing2 * grazing);
    float sun = n_l * (1.0 - occlusion_of_sun + occlusion_of_sun * s.open) * s.sun;
#ifdef FILTERED
    float lobe = s.lobe;
#else
    float lobe = min(specular_lobe(s.rough.x, n_h, n_l, n_v), brightest_highlight);
#endif
#ifdef ENVIRONMENT
    light += (s.diffuse + fresnel * lobe) * (v_sun * s.sun_share * sun);
#else
    light += (s.diffuse + fresnel * lobe) * (v_sun * sun);
#endif
#endif

#ifndef ENVIRONMENT
    float mirrored_up = 2.0 * s.n_v * s.up - s.eye_up;
    light += blurred_sky(mirrored_up, s.rough) * (s.f0 * environment.x + environment.y) * (s.open * s.veil);
#endif
    return light;
}
