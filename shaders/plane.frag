#version 410 core
// An infinite plane. Compiled with GRID, CHECKER or neither; OPEN where neither shadows nor bodies' darkening reach;
// OTHER_PLANES gives the number of those that it may meet.
#include "frame.glsl"
#include "lighting.glsl"
#include "pattern.glsl"

uniform vec4 plane_normal;      // unit; w: the eye's height above the plane
uniform vec4 plane_u;           // unit, in the plane, over the cell size; w: the eye's coordinate along it, in cells
uniform vec4 plane_v;
uniform vec4 plane_color;       // linear; w: roughness
uniform vec4 plane_look;        // metallic, the surface's number as alpha
#ifndef OPEN
uniform sampler2D occlusion_atlas;
uniform vec4 window_u;          // the same as plane_u, in texels of the plane's window in the occlusion atlas
uniform vec4 window_v;
uniform vec4 window_rim;        // its first and last texels, which are open
#endif
#ifdef OTHER_PLANES
uniform vec4 other_planes[OTHER_PLANES];   // unit normal and the eye's height above it
uniform float other_reach;                 // m
#endif

layout(location = 0) out vec4 pixel;

const float farthest = 1e6;     // in heights above the plane: keeps the numbers finite at the horizon

// What the bodies, and in a corner the other planes, leave of the sky's light.
float openness(vec3 position) {
    float open = 1.0;
#ifndef OPEN
    vec2 texel = vec2(dot(window_u.xyz, position), dot(window_v.xyz, position)) + vec2(window_u.w, window_v.w);
    open = textureLod(occlusion_atlas, (clamp(texel, window_rim.xy, window_rim.zw) + 0.5) * atlas.xy, 0.0).r;
#endif
#ifdef OTHER_PLANES
    for (int i = 0; i < OTHER_PLANES; ++i) {
        vec4 other = other_planes[i];
        float rise = dot(other.xyz, plane_normal.xyz);
        float height = (dot(other.xyz, position) + other.w) / other_reach;
        open *= 1.0 - corner_darkness * clamp(1.0 - height - rise, 0.0, 1.0);
    }
#endif
    return open;
}

void main() {
    vec3 ray = ray_origin.xyz + gl_FragCoord.x * ray_dx.xyz + gl_FragCoord.y * ray_dy.xyz;
    // Where the ray meets the plane: exact for every pixel, however far. The sample may lie past the pixel's centre.
    float slope = max(-dot(plane_normal.xyz, ray), 1.0 / farthest);
    vec3 position = ray * (plane_normal.w / slope);

    vec2 p = vec2(dot(plane_u.xyz, position), dot(plane_v.xyz, position)) + vec2(plane_u.w, plane_v.w);
    vec2 width = max(abs(dFdx(p)), abs(dFdy(p)));          // the pixel's footprint in cells
    vec3 albedo = plane_color.rgb;
    float distinct = clamp(2.0 - max(width.x, width.y), 0.0, 1.0);   // a box filter still ripples far out
#ifdef CHECKER
    albedo *= 1.0 - 2.0 * ground_contrast * mix(0.5, checker(p, width), distinct);
#endif
#ifdef GRID
    albedo *= 1.0 - grid_line_contrast * mix(2.0 * grid_line_width, grid(p, width, grid_line_width), distinct);
#endif

    Surface surface;
    surface.position = position;
    surface.to_eye = -normalize(ray);
    surface.normal = plane_normal.xyz;
#ifndef OPEN
    surface.shadow = shadow_place(position, plane_normal.xyz, in_near_map(position));
#endif
    surface.albedo = albedo;
    surface.roughness = plane_color.w;
    surface.metallic = plane_look.x;
    surface.open = openness(position);
    float share = haze_share(dot(position, position));
    surface.haze = vec4(share * sky(-surface.to_eye), 1.0 - share);
    pixel = vec4(shade(surface), plane_look.y);
}
