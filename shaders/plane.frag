#version 410 core
#include "frame.glsl"
#include "rotate.glsl"
#include "lighting.glsl"
#include "pattern.glsl"

uniform vec4 plane_normal;      // unit; w: the eye's height above the plane
uniform vec4 plane_u;           // unit, in the plane, over the cell size; w: the eye's coordinate along it, in cells
uniform vec4 plane_v;
uniform vec4 plane_color;       // linear; w: roughness
uniform vec4 plane_look;        // metallic, pattern

layout(location = 0) out vec4 pixel;

const float farthest = 1e6;     // in heights above the plane: keeps the numbers finite at the horizon
const float any_reach = 1e9;    // a plane has no size of its own: its occluders' reach counts

void main() {
    vec3 ray = ray_origin.xyz + gl_FragCoord.x * ray_dx.xyz + gl_FragCoord.y * ray_dy.xyz;
    // Where the ray meets the plane: exact for every pixel, however far. The sample may lie past the pixel's centre.
    float slope = max(-dot(plane_normal.xyz, ray), 1.0 / farthest);
    vec3 position = ray * (plane_normal.w / slope);

    vec2 p = vec2(dot(plane_u.xyz, position), dot(plane_v.xyz, position)) + vec2(plane_u.w, plane_v.w);
    // The pixel's footprint in cells, from the derivatives of ray / slope.
    vec3 dx = (ray_dx.xyz * slope + ray * dot(plane_normal.xyz, ray_dx.xyz)) * (plane_normal.w / (slope * slope));
    vec3 dy = (ray_dy.xyz * slope + ray * dot(plane_normal.xyz, ray_dy.xyz)) * (plane_normal.w / (slope * slope));
    vec2 width = max(abs(vec2(dot(plane_u.xyz, dx), dot(plane_v.xyz, dx))),
                     abs(vec2(dot(plane_u.xyz, dy), dot(plane_v.xyz, dy))));

    vec3 albedo = plane_color.rgb;
    if (plane_look.y > 1.5) {
        float distinct = clamp(2.0 - max(width.x, width.y), 0.0, 1.0);   // a box filter still ripples far out
        albedo *= 1.0 - 2.0 * ground_contrast * mix(0.5, checker(p, width), distinct);
    } else if (plane_look.y > 0.5) {
        vec2 share = clamp(2.0 - width, 0.0, 1.0);
        float mean = 2.0 * grid_line_width;
        albedo *= 1.0 - grid_line_contrast * mix(mean, grid(p, width, grid_line_width), min(share.x, share.y));
    }

    Surface surface;
    surface.position = position;
    surface.normal = plane_normal.xyz;
    surface.face_normal = plane_normal.xyz;
    surface.albedo = albedo;
    surface.roughness = plane_color.w;
    surface.metallic = plane_look.x;
    surface.reach = any_reach;
    surface.body = -1.0;
    pixel = vec4(shade(surface), 1.0);
}
