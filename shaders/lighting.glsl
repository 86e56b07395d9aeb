// From a surface point to the light it sends to the eye, and from light to the bytes of the screen.
#include "look.glsl"
#include "sky.glsl"
#if !defined(OPEN) && !defined(AWAY_FROM_SUN)
#include "shadow_place.glsl"
#include "shadow.glsl"
#endif

struct Surface {
    vec3 position;      // relative to the eye
    vec3 to_eye;        // unit
    vec3 normal;        // unit, bent at bevels
    vec4 shadow;        // its place in the shadow maps
    vec3 albedo;        // linear
    float roughness;
    float metallic;
    float open;         // share of the sky's light that other bodies leave
    vec4 haze;          // light of the air before it; w: share of its own light that comes through
};

float specular_lobe(float roughness, float n_h, float n_l, float n_v) {
    // Walter et al. 2007, Microfacet Models for Refraction: the GGX distribution, with
    // Hammon 2017, PBR Diffuse Lighting for GGX+Smith: its visibility term without the roots
    float a = roughness * roughness;
    float a2 = a * a;
    float d = n_h * n_h * (a2 - 1.0) + 1.0;
    // D V without 1/pi: the sun's light here is irradiance over pi
    return 0.5 * a2 / (d * d * mix(2.0 * n_l * n_v, n_l + n_v, a));
}

vec2 environment_scale(float roughness, float n_v) {
    // Karis 2014, Physically Based Shading on Mobile: the integral of the specular lobe, as scale and offset of F0
    vec4 r = roughness * vec4(-1.0, -0.0275, -0.572, 0.022) + vec4(1.0, 0.0425, 1.04, -0.04);
    float a = min(r.x * r.x, exp2(-9.28 * n_v)) * r.x + r.y;
    return vec2(-1.04, 1.04) * a + r.zw;
}

vec3 displayed(vec3 light) {
    // Minimax fit in s = sqrt(light), to 0.8 levels of 255, of two steps at once:
    // IEC 61966-2-1 (1999), the sRGB transfer curve, of light itself up to 0.62 and of a shoulder above it,
    // 1 - 0.38 exp(-(light - 0.62) / 0.38), that never reaches white. One root and one quotient, no powers.
    vec3 s = sqrt(max(light, 0.0));
    vec3 rise = s * s * (21.217153 + s * (-35.617540 + s * 32.353397));
    return rise / (1.0 + s * (7.989843 + s * (8.709465 + s * (-30.195670 + s * 31.746583))));
}

vec3 shade(Surface s) {
    float n_v = clamp(dot(s.normal, s.to_eye), 1e-3, 1.0);

    vec3 f0 = mix(vec3(dielectric_reflectance), s.albedo, s.metallic);
    vec3 diffuse = s.albedo * (1.0 - s.metallic);
    vec3 from_sky = mix(bounce_light, sky_light, 0.5 + 0.5 * s.normal.y) * s.open;
    vec3 light = diffuse * from_sky;
    float roughness = max(s.roughness, 0.06);   // below, the sun's highlight is smaller than a pixel and flickers
#ifndef AWAY_FROM_SUN
    float n_l = clamp(dot(s.normal, to_light.xyz), 0.0, 1.0);
    float sun = n_l * mix(1.0, s.open, occlusion_of_sun);
#ifndef OPEN
    sun *= sun_visible(s.shadow);
#endif
    vec3 middle = normalize(to_light.xyz + s.to_eye);
    float n_h = clamp(dot(s.normal, middle), 0.0, 1.0);
    float grazing = 1.0 - clamp(dot(to_light.xyz, middle), 0.0, 1.0);
    float grazing2 = grazing * grazing;         // Schlick 1994, An Inexpensive BRDF Model: Fresnel's rise
    vec3 fresnel = f0 + (1.0 - f0) * (grazing2 * grazing2 * grazing);
    light += (diffuse + fresnel * min(specular_lobe(roughness, n_h, n_l, n_v), 16.0)) * sun_light * sun;
#endif

    vec2 environment = environment_scale(roughness, n_v);
    light += blurred_sky(reflect(-s.to_eye, s.normal), roughness) * (f0 * environment.x + environment.y) *
             (s.open * mix(1.0, mix(veil_of_rough, 1.0, s.metallic), roughness));

    return displayed(light * s.haze.w + s.haze.rgb);
}
