#version 410 core
// An infinite plane. Defines: GRID, CHECKER or neither; PLAIN with TWO_COLORS of a pattern or with IMAGE; OCCLUDED within
// the AO radius of bodies; SHADOWED where shadows may be as well, with FAR_MAP if the far map is in use; OTHER_PLANES is the number of planes that it may intersect;
// GROUND_SHADOW where only shadows are shown, over the background or, with TRANSPARENT 1 and 2, as a surface id with the
// alpha beside or as alpha; REFLECTIVE with an image of the mirrored bodies.
#define SUNLIT
#include "lighting.glsl"
#ifdef LAMPS
#include "lights.glsl"
#endif
#if defined(NORMAL_MAP) || defined(SURFACE_MAP)
#define MAPPED
#include "surface_maps.glsl"
#endif
#ifdef GLOWING
flat in vec4 v_glow;
#endif
#if defined(NORMAL_MAP) || defined(LAMPS)
flat in vec4 v_frame;           // see plane.vert
flat in float v_cell;
#endif
#include "pattern.glsl"

#ifdef LAMP_SHADOW
flat in vec4 v_lamp_map[3];
#endif
flat in vec3 v_fall;            // see plane.vert
flat in vec3 v_along_u;
flat in vec3 v_along_v;
flat in vec3 v_rise;
flat in vec3 v_sunward;
flat in vec4 v_length_x;
flat in vec4 v_length_y;
flat in vec4 v_facing;
flat in vec3 v_diffuse;
#if defined(ENVIRONMENT) || defined(BACKGROUND)
flat in vec3 v_ray_x;
flat in vec3 v_ray_z;
#endif
#ifdef ENVIRONMENT
flat in vec3 v_normal;
flat in vec3 v_around;
flat in vec3 v_sun_share;
#endif
#ifdef BACKGROUND
flat in vec4 v_low, v_high;
#endif
flat in vec4 v_f0;
flat in vec3 v_rough;
#ifdef PLAIN
flat in vec3 v_color;
flat in vec4 v_second;
#include "material.glsl"
#endif
#ifdef TWO_COLORS
#include "solid_pattern.glsl"
#endif
#ifdef IMAGE
uniform sampler2D mesh_texture;
flat in vec2 v_image;
#include "texture_place.glsl"
#endif
#ifdef OCCLUDED
uniform sampler2D occlusion_atlas;
flat in vec3 v_tile;
flat in vec4 v_rim;
flat in vec2 v_texel;
#endif
#ifdef SHADOWED
flat in vec3 v_shadow_x;
flat in vec3 v_shadow_y;
flat in vec3 v_shadow_z;
flat in vec3 v_shadow_eye;
#ifdef FAR_MAP
flat in vec4 v_far;
flat in vec3 v_far_lift;
#endif
#endif
#ifdef OTHER_PLANES
flat in vec4 v_others[OTHER_PLANES];
#endif

#ifdef REFLECTIVE
uniform sampler2D reflection_image;     // straight alpha; from right to left
flat in vec2 v_reflection;              // share seen from above; the last column
#endif

layout(location = 0) out vec4 pixel;

const float farthest = 1e6;     // in heights above the plane: keeps the numbers finite at the horizon

float here(vec3 coefficients) {
    return coefficients.x + gl_FragCoord.x * coefficients.y + gl_FragCoord.y * coefficients.z;
}

#ifdef SHADOWED
// `far`: distance of the plane along the ray, in lengths of the view ray.
float sun_of_plane(float far) {
    vec3 at = vec3(here(v_shadow_x), here(v_shadow_y), here(v_shadow_z)) * far + v_shadow_eye;
#ifdef FAR_MAP
    vec3 in_far = at + v_far_lift;
    in_far.xy = in_far.xy * v_far.x + v_far.yz;
    return sun_visible(at, in_far);
#else
    const float margin = 5.0 / SHADOW_TEXELS;
    float from_middle = max(abs(at.x - 0.5), abs(at.y - 0.5));
    float inside = from_middle < 0.5 - margin ? 1.0 : 0.0;
    return mix(1.0, filtered_shadow(vec3(at.xy * SHADOW_TEXELS - 0.5, at.z)), inside);
#endif
}
#endif

// Sky visibility past the bodies and, in a corner, past the other planes.
float sky_visibility(vec2 cells, float far) {
    float open = 1.0;
#ifdef OCCLUDED
    vec2 texel = clamp(cells * v_tile.x + v_tile.yz, v_rim.xy, v_rim.zw);
    open = textureLod(occlusion_atlas, (texel + 0.5) * v_texel, 0.0).r;
#endif
#ifdef OTHER_PLANES
    for (int i = 0; i < OTHER_PLANES; ++i)
        open *= 1.0 - corner_darkness * clamp(1.0 - (here(v_others[i].xyz) * far + v_others[i].w), 0.0, 1.0);
#endif
    return open;
}

void main() {
    // Intersection of the ray with the plane: exact for every pixel at any distance. The sample may be off the pixel's
    // center.
    float fall = max(here(v_fall), 1.0 / farthest);
    float far = v_length_x.w / fall;
    float squared = v_length_x.x + gl_FragCoord.x * (v_length_x.y + gl_FragCoord.x * v_length_x.z) +
                    gl_FragCoord.y * (v_length_y.x + gl_FragCoord.y * v_length_y.y);
    float per_length = inversesqrt(squared);

    vec2 cells = vec2(here(v_along_u), here(v_along_v)) * far + v_length_y.zw;
    vec2 width = max(abs(dFdx(cells)), abs(dFdy(cells)));              // the pixel's footprint
    float distinct = clamp(2.0 - max(width.x, width.y), 0.0, 1.0);     // a box filter still shows moire far out
    float paint = 1.0;
#ifdef CHECKER
    paint = 1.0 - 2.0 * ground_contrast * mix(0.5, checker(cells, width), distinct);
#endif
#ifdef GRID
    paint = 1.0 - grid_line_contrast * mix(2.0 * grid_line_width, grid(cells, width, grid_line_width), distinct);
#endif

    Surface surface;
    surface.n_v = fall * per_length;
    surface.n_l = v_facing.x;
    surface.l_v = -here(v_sunward) * per_length;
    surface.up = v_facing.y;
    surface.eye_up = -here(v_rise) * per_length;
    surface.diffuse = v_diffuse * paint;
    surface.f0 = v_f0.rgb * (1.0 - v_f0.w + v_f0.w * paint);
#ifdef PLAIN
#ifdef TWO_COLORS
    float second = second_share(TWO_COLORS, vec3(cells, 0.0), vec3(width, 0.0), cells, width, cells.y, width.y);
    vec3 color = mix(v_color, v_second.rgb, second);
#else
    vec3 color = v_color * texel_at(mesh_texture, vec2(cells.x, -cells.y), texture_level(dFdx(cells) * v_image, dFdy(cells) * v_image));
#endif
#ifdef MAPPED
    read_maps(vec2(cells.x, -cells.y), dFdx(cells), dFdy(cells));
    float metallic = map_metallic;
#else
    float metallic = v_second.w;
#endif
    surface.diffuse = surface_diffuse(color, metallic);
    surface.f0 = surface_f0(color, metallic);
#endif
    surface.open = sky_visibility(cells, far);
#ifdef MAPPED
    surface.rough = surface_roughness(map_roughness);
    surface.veil = surface_veil(map_roughness, map_metallic);
    surface.open *= map_open;
#else
    surface.rough = v_rough.xy;
    surface.veil = v_rough.z;
#endif
#if defined(NORMAL_MAP) || defined(LAMPS)
    // In the axes of the plane.
    vec3 normal = vec3(0.0, 0.0, 1.0);
    vec3 to_eye = vec3(-v_cell * here(v_along_u), -v_cell * here(v_along_v), fall) * per_length;
#endif
#ifdef NORMAL_MAP
    normal = map_normal;
    surface.n_v = dot(normal, to_eye);
    surface.n_l = dot(normal, vec3(v_frame.xy, v_facing.x));
    surface.up = dot(normal, vec3(v_frame.zw, v_facing.y));
#endif
    surface.sun = 1.0;
#ifdef SHADOWED
    surface.sun = sun_of_plane(far);
#endif
#if defined(ENVIRONMENT) || defined(BACKGROUND)
    vec3 ray = vec3(here(v_ray_x), here(v_rise), here(v_ray_z)) * per_length;
#endif
#ifdef ENVIRONMENT
    surface.around = v_around;
    surface.mirrored = v_around;
    if (surface.rough.x < 0.5 || max(surface.f0.r, max(surface.f0.g, surface.f0.b)) > 0.1)
        surface.mirrored = light_mirrored(ray + 2.0 * surface.n_v * v_normal, surface.rough.x);
    surface.sun_share = v_sun_share;
#endif
#ifdef BACKGROUND
    float share = haze_share(squared * far * far, v_facing.z);
    vec3 behind = background(ray, v_low, v_high);
#else
    float share = fog_share(squared * far * far, v_facing.z);
    vec3 behind = sky(-surface.eye_up, -surface.l_v);
#endif
#ifdef GROUND_SHADOW
    // The light of matte ground with its shadows over that without them.
    float around = 0.4, direct = 0.75 * max(surface.n_l, 0.0);
#ifdef ENVIRONMENT
    around = dot(v_around, vec3(1.0 / 3.0));
    direct *= dot(v_sun_share, vec3(1.0 / 3.0));
#endif
    float seen = direct * (1.0 - occlusion_of_sun + occlusion_of_sun * surface.open) * surface.sun + around * surface.open;
    float kept = mix(seen / (direct + around), 1.0, share);
#ifdef TRANSPARENT
    float alpha = 1.0 - sqrt(kept);     // of encoded colors
    pixel = TRANSPARENT == 1 ? vec4(vec3(alpha), 1.0) : vec4(vec3(0.0), alpha);
#else
    pixel = vec4(dithered(displayed(behind * kept)), v_facing.w);
#endif
#else
    vec3 shaded = shade(surface);
#ifdef LAMPS
    vec2 along = v_cell * far * vec2(here(v_along_u), here(v_along_v));
#ifdef LAMP_SHADOW
    lamp_seen = lamp_visible(v_lamp_map[0] + along.x * v_lamp_map[1] + along.y * v_lamp_map[2]);
#endif
    shaded += light_of_lamps(vec3(along, 0.0), normal, to_eye, surface);
#endif
#ifdef GLOWING
    shaded += v_glow.rgb;
#endif
    vec3 light = shaded * (1.0 - share) + share * behind;
    vec3 shown = displayed(light);
#ifdef REFLECTIVE
    vec4 mirrored = texelFetch(reflection_image, ivec2(int(v_reflection.y) - int(gl_FragCoord.x), int(gl_FragCoord.y)), 0);
    float grazing = 1.0 - surface.n_v, grazing2 = grazing * grazing;
    float strength = mix(v_reflection.x, 1.0, 0.5 * grazing2 * grazing2 * grazing);
    shown = mix(shown, mirrored.rgb, mirrored.a * strength * (1.0 - share));
#endif
    pixel = vec4(dithered(shown), v_facing.w);
#endif
}
