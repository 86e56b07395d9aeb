// Fragment counterpart of body.vert, shared by all kinds of bodies. Directions and positions are in the body's axes (of
// a box, those of its face: two along it and one outward), where the sun and the eye are constant over a body.
in vec3 v_air;
#ifdef SUNLIT
flat in vec3 v_to_light;
#endif
#ifdef SHADOWED
#ifdef SPANS_CASCADES
in vec3 v_in_near;
in vec3 v_in_far;
#else
in vec4 v_shadow;
#endif
#endif
#ifdef LAMP_SHADOW
in vec4 v_lamp_shadow;
#endif
flat in vec4 v_eye;             // position of the eye; per_half of fog_share()
flat in vec3 v_up;
flat in vec3 v_diffuse;
flat in vec3 v_f0;
flat in vec4 v_rough;           // surface_roughness(), surface_veil(), surface id as alpha
#ifdef PATTERNED
flat in vec2 v_pattern;         // kind of pattern; size of a cell, m
#endif

layout(location = 0) out vec4 pixel;

#if defined(TWO_COLORS) || defined(IMAGE)
#define COLORED
flat in vec3 v_color;
flat in vec4 v_second;          // see body.vert
#endif
#ifdef TWO_COLORS
flat in vec4 v_cells;
#endif
#ifdef IMAGE
uniform sampler2D mesh_texture;
flat in vec2 v_image;               // size of the texture, texels
#include "texture_place.glsl"
#endif

#ifdef ENVIRONMENT
flat in vec3 v_east, v_south;   // axes x and z of the world
flat in vec3 v_around[9];       // see light_around()
flat in vec3 v_sun_share;
#endif

#include "lighting.glsl"
#ifdef LAMPS
#include "lights.glsl"
#endif
#ifdef GLOWING
flat in vec4 v_glow;                // emission, linear; opacity
#endif
#ifdef TRANSLUCENT
float mirror_share;                 // set by body_pixel()
float hidden_share(float opacity) { return mix(opacity, 1.0, mirror_share); }
layout(location = 0, index = 1) out vec4 pixel_share;   // alpha: share of the background that it hides
#endif
#if defined(NORMAL_MAP) || defined(SURFACE_MAP)
#define MAPPED
#endif
#if defined(MAPPED) || defined(EMISSION_MAP)
#define WITH_MAPS
#include "surface_maps.glsl"
#endif
#include "pattern.glsl"
#if defined(COLORED) || defined(PAINTED) || defined(MAPPED)
#include "material.glsl"
#endif
#ifdef TWO_COLORS
#include "solid_pattern.glsl"
#endif

// Sky visibility at texture coordinates of the AO atlas.
uniform sampler2D occlusion_atlas;

#if defined(PAINTED) || defined(COLORED)
// Reflectance and own light of the pixel, set by main().
vec3 paint_f0, paint_emission = vec3(0.0);
#endif

#ifdef COLORED
#ifdef SURFACE_MAP
#define METALLIC map_metallic
#else
#define METALLIC v_second.w
#endif
// The diffuse color of a pixel, with its reflectance beside.
vec3 colored(vec3 color) {
    paint_f0 = surface_f0(color, METALLIC);
    return surface_diffuse(color, METALLIC);
}
#endif

// `paint`: factor of the pattern on all light; `spread`: see bevel_lobe(), unused elsewhere.
vec4 body_pixel(vec3 place, vec3 normal, vec3 diffuse, float paint, float open, vec2 spread) {
    vec3 to_eye = v_eye.xyz - place;
    float squared = max(dot(to_eye, to_eye), 1e-30);
    float air = fog_share(squared, v_eye.w);   // per pixel, because the corners of a large face are far away
    to_eye *= inversesqrt(squared);
    Surface surface;
    surface.n_v = dot(normal, to_eye);
    surface.up = dot(normal, v_up);
    surface.eye_up = dot(to_eye, v_up);
    surface.n_l = 0.0;
    surface.l_v = 0.0;
    surface.sun = 1.0;
#ifdef SUNLIT
    surface.n_l = dot(normal, v_to_light);
    surface.l_v = dot(to_eye, v_to_light);
#endif
#ifdef SHADOWED
#ifdef SPANS_CASCADES
    surface.sun = sun_visible(v_in_near, v_in_far);
#else
    surface.sun = sun_visible(v_shadow);
#endif
#endif
    surface.diffuse = diffuse;
#if defined(PAINTED) || defined(COLORED)
    surface.f0 = paint_f0;
#else
    surface.f0 = v_f0;
#endif
#ifdef MAPPED
    surface.rough = surface_roughness(map_roughness);
    surface.veil = surface_veil(map_roughness, map_metallic);
    open *= map_open;
#else
    surface.rough = v_rough.xy;
    surface.veil = v_rough.z;
#endif
#ifdef FILTERED
    surface.lobe = bevel_lobe(surface.rough.x, normal, normalize(to_eye + v_to_light), spread, clamp(surface.n_l, 0.0, 1.0),
                              clamp(surface.n_v, 1e-3, 1.0));
#endif
    surface.open = open;
#ifdef TRANSLUCENT
    // A smooth surface seen at a low angle mirrors, and shows little of the background.
    float grazing = 1.0 - clamp(surface.n_v, 0.0, 1.0), smoothness = 1.0 - surface.rough.x;
    mirror_share = grazing * grazing * grazing * grazing * grazing * smoothness * smoothness;
#endif
#ifdef ENVIRONMENT
    vec3 outward = vec3(dot(normal, v_east), surface.up, dot(normal, v_south));
    vec3 back = vec3(dot(to_eye, v_east), surface.eye_up, dot(to_eye, v_south));
    surface.around = light_around(outward, v_around);
    // Rough paint mirrors so little that the light around is as good.
    surface.mirrored = surface.around;
    if (surface.rough.x < 0.5 || max(surface.f0.r, max(surface.f0.g, surface.f0.b)) > 0.1)
        surface.mirrored = light_mirrored(2.0 * surface.n_v * outward - back, surface.rough.x);
    surface.sun_share = v_sun_share;
#endif
    vec3 light = shade(surface) * paint;
#ifdef LAMPS
#ifdef LAMP_SHADOW
    lamp_seen = lamp_visible(v_lamp_shadow);
#endif
    light += light_of_lamps(place, normal, to_eye, surface) * paint;
#endif
#ifdef PAINTED
    light += paint_emission;
#endif
#ifdef GLOWING
    light += v_glow.rgb;
#endif
    return vec4(displayed(mix(light, v_air, air)), v_rough.w);
}
