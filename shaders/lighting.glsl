// From a surface point to the light it sends to the eye, and from light to the bytes of the screen.
#include "look.glsl"
#include "sky.glsl"
#ifndef OPEN_GROUND
#include "shadow.glsl"
#include "occlusion.glsl"
#endif

struct Surface {
    vec3 position;      // relative to the eye
    vec3 normal;        // unit, bent at bevels
    vec3 face_normal;   // unit, of the geometry
    vec3 albedo;        // linear
    float roughness;
    float metallic;
    float reach;        // how far other bodies occlude it, m
    float body;         // its number: it does not occlude itself
};

float specular_lobe(float roughness, float n_h, float n_l, float n_v) {
    // Walter et al. 2007, Microfacet Models for Refraction: the GGX distribution, with
    // Hammon 2017, PBR Diffuse Lighting for GGX+Smith: its visibility term without the roots
    float a = roughness * roughness;
    float a2 = a * a;
    float d = n_h * n_h * (a2 - 1.0) + 1.0;
    float visibility = 0.5 / mix(2.0 * n_l * n_v, n_l + n_v, a);
    return a2 / (d * d) * visibility;   // D V without 1/pi: the sun's light here is irradiance over pi
}

vec2 environment_scale(float roughness, float n_v) {
    // Karis 2014, Physically Based Shading on Mobile: the integral of the specular lobe, as scale and offset of F0
    vec4 r = roughness * vec4(-1.0, -0.0275, -0.572, 0.022) + vec4(1.0, 0.0425, 1.04, -0.04);
    float a = min(r.x * r.x, exp2(-9.28 * n_v)) * r.x + r.y;
    return vec2(-1.04, 1.04) * a + r.zw;
}

vec3 tone_mapped(vec3 light) {
    // Lalish et al. 2024, Khronos PBR Neutral Tone Mapper: colours as given, only highlights rolled off to white
    const float start = 0.8 - 0.04, desaturation = 0.15;
    float low = min(light.r, min(light.g, light.b));
    light -= low < 0.08 ? low - 6.25 * low * low : 0.04;
    float peak = max(light.r, max(light.g, light.b));
    const float room = 1.0 - start;
    float new_peak = 1.0 - room * room / (peak + room - start);
    vec3 rolled = light * (new_peak / max(peak, 1e-6));
    float pale = 1.0 - 1.0 / (desaturation * (peak - new_peak) + 1.0);
    return peak < start ? light : mix(rolled, vec3(new_peak), pale);
}

vec3 displayed(vec3 light) {
    light = clamp(tone_mapped(light), 0.0, 1.0);
#ifdef ENCODE_IN_SHADER
    vec3 s1 = sqrt(light), s2 = sqrt(s1), s3 = sqrt(s2);
    return 0.662002687 * s1 + 0.684122060 * s2 - 0.323583601 * s3 - 0.0225411470 * light;
#else
    return light;   // the framebuffer encodes to sRGB
#endif
}

vec3 shade(Surface s) {
    float squared = dot(s.position, s.position);
    vec3 to_eye = s.position * -inversesqrt(squared);
    float n_l = clamp(dot(s.normal, to_light.xyz), 0.0, 1.0);
    float n_v = clamp(dot(s.normal, to_eye), 1e-3, 1.0);

#ifdef OPEN_GROUND
    float open = 1.0, sun = n_l;
#else
    float open = sky_open(s.position, s.face_normal, s.reach, s.body);
    float sun = n_l * sun_visible(s.position, s.face_normal) * mix(1.0, open, occlusion_of_sun);
#endif
    vec3 f0 = mix(vec3(dielectric_reflectance), s.albedo, s.metallic);
    vec3 diffuse = s.albedo * (1.0 - s.metallic);
    vec3 from_sky = mix(bounce_light, sky_light, 0.5 + 0.5 * s.normal.y) * open;
    vec3 light = diffuse * (sun * sun_light + from_sky);

    float roughness = max(s.roughness, 0.06);   // below, the sun's highlight is smaller than a pixel and flickers
    vec3 middle = normalize(to_light.xyz + to_eye);
    float n_h = clamp(dot(s.normal, middle), 0.0, 1.0);
    float l_h = clamp(dot(to_light.xyz, middle), 0.0, 1.0);
    float grazing = 1.0 - l_h;                  // Schlick 1994, An Inexpensive BRDF Model: Fresnel's rise
    float grazing2 = grazing * grazing;
    vec3 fresnel = f0 + (1.0 - f0) * (grazing2 * grazing2 * grazing);
    light += fresnel * min(specular_lobe(roughness, n_h, n_l, n_v), 16.0) * (sun * sun_light);

    vec2 environment = environment_scale(roughness, n_v);
    vec3 mirrored = reflect(-to_eye, s.normal);
    light += blurred_sky(mirrored, roughness) * (f0 * environment.x + environment.y) * open;

    light = mix(light, sky(-to_eye), haze_share(squared));
    return displayed(light);
}
