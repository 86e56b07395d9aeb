#version 410 core
// The part of the screen that an infinite plane covers, as a polygon in clip space (render/scene/plane_patch.h), with
// the constants of the plane. Values that vary linearly or quadratically over the screen are given by their
// coefficients of (1, x, y in pixels). With six other planes these are 89 components: OpenGL guarantees 60, llvmpipe
// and GPU drivers offer 124 and more.
#include "frame.glsl"
#include "light_constants.glsl"
#include "material.glsl"
#if defined(ENVIRONMENT) || defined(BACKGROUND)
#include "environment_block.glsl"
#include "environment.glsl"

flat out vec3 v_ray_x;          // coefficients of the view ray over the screen
flat out vec3 v_ray_z;
#endif
#ifdef ENVIRONMENT
flat out vec3 v_normal;
flat out vec3 v_around;
flat out vec3 v_sun_share;
#endif
#ifdef BACKGROUND
flat out vec4 v_low, v_high;    // see background()
#endif

layout(location = 0) in vec3 clip_position;

uniform vec4 plane_normal;      // unit; w: the eye's height above the plane
uniform vec4 plane_u;           // unit, in the plane, over the cell size; w: the eye's coordinate along it, in cells
uniform vec4 plane_v;
uniform vec4 plane_color;       // linear; w: roughness
uniform vec4 plane_material;        // metallic, surface id as alpha, reflection, last column of the frame
uniform vec4 plane_paint;       // second color
#ifdef OCCLUDED
uniform vec4 tile_u;          // the same as plane_u, in texels of the plane's tile in the AO atlas
uniform vec4 tile_v;
uniform vec4 tile_rim;        // its first and last texels, which are unoccluded
#endif
#ifdef OTHER_PLANES
uniform vec4 other_planes[OTHER_PLANES];   // unit normal and the eye's height above it
uniform float other_ao_radius;                 // m
#endif

#ifdef LAMP_LIGHT
#include "lights_place.glsl"
#endif
#if defined(NORMAL_MAP) || defined(SURFACE_MAP)
#include "surface_maps_place.glsl"
#endif
#ifdef GLOWING
uniform vec4 plane_glow;        // linear
flat out vec4 v_glow;
#endif
#if defined(NORMAL_MAP) || defined(LAMPS)
flat out vec4 v_frame;          // the sun and up along the plane's axes
flat out float v_cell;          // m, of the plane's coordinates
#endif
#ifdef LAMP_SHADOW
flat out vec4 v_lamp_map[3];    // see lamp_shadow_place(): at the eye's foot, and for a meter along each axis
#endif
flat out vec3 v_fall;           // of the view ray, which is 1 along the camera's axis: slope towards the plane,
flat out vec3 v_along_u;        // displacement along the plane's axes,
flat out vec3 v_along_v;
flat out vec3 v_rise;           // upward,
flat out vec3 v_sunward;        // to the sun
flat out vec4 v_length_x;       // its squared length: 1, x, x^2; w: the eye's height above the plane
flat out vec4 v_length_y;       // y, y^2; z, w: pattern coordinates at the eye's foot
flat out vec4 v_facing;         // cosines of the plane to the sun and upward; fog; surface id
flat out vec3 v_diffuse;
flat out vec4 v_f0;             // w: metallic
flat out vec3 v_rough;          // surface_roughness(), surface_veil()
#ifdef REFLECTIVE
flat out vec2 v_reflection;     // see plane.frag
#endif
#ifdef PLAIN
flat out vec3 v_color;          // linear
flat out vec4 v_second;         // second color of a pattern; metallic
#endif
#ifdef IMAGE
uniform sampler2D mesh_texture;
flat out vec2 v_image;          // size of the texture, texels
#endif
#ifdef OCCLUDED
flat out vec3 v_tile;         // texels of the atlas per cell of the pattern, and at the eye's foot; see plane.frag
flat out vec4 v_rim;         // its first and last texels, which are unoccluded
flat out vec2 v_texel;        // size of a texel in texture coordinates
#endif
#ifdef SHADOWED
flat out vec3 v_shadow_x;       // of the view ray in the near shadow map
flat out vec3 v_shadow_y;
flat out vec3 v_shadow_z;
flat out vec3 v_shadow_eye;     // the eye in it, with the normal offset of the plane
#ifdef FAR_MAP
flat out vec4 v_far;            // the near map in the far one: scale, offset
flat out vec3 v_far_lift;       // additional normal offset, in the near map
#endif
#endif
#ifdef OTHER_PLANES
// over the AO radius: slope of the view ray, height of the eye less the height of the plane
flat out vec4 v_others[OTHER_PLANES];
#endif

vec3 over_screen(vec3 direction) {
    return vec3(dot(direction, ray_origin.xyz), dot(direction, ray_dx.xyz), dot(direction, ray_dy.xyz));
}

void main() {
    gl_Position = vec4(clip_position, 1.0);
    v_fall = over_screen(-plane_normal.xyz);
    v_along_u = over_screen(plane_u.xyz);
    v_along_v = over_screen(plane_v.xyz);
    v_rise = vec3(ray_origin.y, ray_dx.y, ray_dy.y);
    v_sunward = over_screen(to_light.xyz);
#if defined(ENVIRONMENT) || defined(BACKGROUND)
    v_ray_x = over_screen(vec3(1.0, 0.0, 0.0));
    v_ray_z = over_screen(vec3(0.0, 0.0, 1.0));
#endif
#ifdef ENVIRONMENT
    vec3 c[9];
    for (int i = 0; i < 9; ++i) c[i] = around[i].rgb;
    v_normal = plane_normal.xyz;
    v_around = light_around(plane_normal.xyz, c);
    v_sun_share = sun_share.rgb;
#endif
#ifdef BACKGROUND
    v_low = background_low;
    v_high = background_high;
#endif
    v_length_x = vec4(dot(ray_origin.xyz, ray_origin.xyz), 2.0 * dot(ray_origin.xyz, ray_dx.xyz),
                      dot(ray_dx.xyz, ray_dx.xyz), plane_normal.w);
    v_length_y = vec4(2.0 * dot(ray_origin.xyz, ray_dy.xyz), dot(ray_dy.xyz, ray_dy.xyz), plane_u.w, plane_v.w);
    v_facing = vec4(dot(plane_normal.xyz, to_light.xyz), plane_normal.y, fog_density, plane_material.y);
    v_diffuse = surface_diffuse(plane_color.rgb, plane_material.x);
#ifdef REFLECTIVE
    v_reflection = plane_material.zw;
#endif
    v_f0 = vec4(surface_f0(plane_color.rgb, plane_material.x), plane_material.x);
#ifdef PLAIN
    v_color = plane_color.rgb;
    v_second = vec4(plane_paint.rgb, plane_material.x);
#endif
#ifdef IMAGE
    v_image = vec2(textureSize(mesh_texture, 0));
#endif
#if defined(NORMAL_MAP) || defined(SURFACE_MAP)
    place_maps(plane_color.w, plane_material.x);
#endif
#ifdef GLOWING
    v_glow = plane_glow;
#endif
#if defined(NORMAL_MAP) || defined(LAMP_LIGHT)
    float per_cell = inversesqrt(dot(plane_u.xyz, plane_u.xyz));
    vec3 u = plane_u.xyz * per_cell, v = plane_v.xyz * per_cell;
#endif
#if defined(NORMAL_MAP) || defined(LAMPS)
    v_frame = vec4(dot(u, to_light.xyz), dot(v, to_light.xyz), u.y, v.y);
    v_cell = per_cell;
#endif
#ifdef LAMP_LIGHT
    place_lamps(vec3(0.0, 0.0, plane_normal.w), mat3(u, v, plane_normal.xyz));
#ifdef LAMP_SHADOW
    vec3 foot = -plane_normal.w * plane_normal.xyz;
    v_lamp_map[0] = lamp_shadow_place(foot, plane_normal.xyz);
    v_lamp_map[1] = lamp_shadow_place(foot + u, plane_normal.xyz) - v_lamp_map[0];
    v_lamp_map[2] = lamp_shadow_place(foot + v, plane_normal.xyz) - v_lamp_map[0];
#endif
#endif
    v_rough = vec3(surface_roughness(plane_color.w), surface_veil(plane_color.w, plane_material.x));
#ifdef OCCLUDED
    float texels = length(tile_u.xyz) / length(plane_u.xyz);
    v_tile = vec3(texels, vec2(tile_u.w, tile_v.w) - texels * vec2(plane_u.w, plane_v.w));
    v_rim = tile_rim;
    v_texel = atlas.xy;
#endif
#ifdef SHADOWED
    vec3 lift = plane_normal.xyz * shadow_texels.w;
    v_shadow_x = over_screen(shadow_x.xyz);
    v_shadow_y = over_screen(shadow_y.xyz);
    v_shadow_z = over_screen(shadow_z.xyz);
    // towards the sun too, as in shadow_place.glsl
    float toward = shadow_texels.z * length(shadow_z.xyz);
    vec3 lifted = vec3(dot(shadow_x.xyz, lift), dot(shadow_y.xyz, lift), dot(shadow_z.xyz, lift) - toward);
    v_shadow_eye = vec3(shadow_x.w, shadow_y.w, shadow_z.w) + lifted * shadow_texels.x;
#ifdef FAR_MAP
    v_far = shadow_far;
    v_far_lift = lifted * (shadow_texels.y - shadow_texels.x);
#endif
#endif
#ifdef OTHER_PLANES
    for (int i = 0; i < OTHER_PLANES; ++i) {
        vec4 other = other_planes[i];
        v_others[i] = vec4(over_screen(other.xyz) / other_ao_radius,
                           other.w / other_ao_radius + dot(other.xyz, plane_normal.xyz));
    }
#endif
}
