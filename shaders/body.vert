#version 410 core
// Compiled for each kind of body: BOX, BALL or MESH is defined.
#include "frame.glsl"
#include "instance.glsl"
#include "look.glsl"
#include "sky.glsl"
#include "shadow_place.glsl"

#ifdef MESH
uniform sampler2D occlusion_atlas;
#endif

out vec3 v_position;                // relative to the eye
#if !defined(BOX) || defined(PATTERNED)
out vec3 v_local;                   // body axes, from the body's origin, m
#endif
out vec4 v_haze;                    // light of the air before it; w: share of its own light that comes through
#ifndef AWAY_FROM_SUN
out vec4 v_shadow;                  // place in the shadow maps
#endif
#ifdef BOX
out vec2 v_on_face;                 // m, from the face's middle along its axes
flat out vec2 v_half;               // m, half the face's size
flat out vec3 v_normal;             // world axes: of the face, and its two own
flat out vec3 v_along_a;
flat out vec3 v_along_b;
flat out vec4 v_tile;               // place of the face's middle in the occlusion atlas, and of a metre along its axes
flat out vec2 v_groove;             // m: how far from the edge it is, and half its width
#endif
#ifdef BALL
flat out vec3 v_tile;               // corner and edge of its tile in the atlas
#endif
#ifdef MESH
out vec3 v_normal;                  // world axes
out float v_open;                   // share of the sky's light
#endif
flat out vec4 v_orientation;
flat out vec4 v_scale;              // w: pattern's cell
flat out vec4 v_color;              // w: roughness
flat out vec4 v_look;               // metallic, pattern, bevel, the surface's number as alpha

void main() {
#ifdef BOX
    // The square goes to one face of the cube; faces come in the order -x, +x, -y, ... and have u x v = outward.
    int face = int(instance_tile.y);
    float side = float(face % 2 * 2 - 1);
    vec2 corner = vec2(mesh_position.x, mesh_position.y * side);
    vec3 on_cube = face < 2 ? vec3(side, corner) : face < 4 ? vec3(corner.y, side, corner.x) : vec3(corner, side);
    vec3 outward = face < 2 ? vec3(side, 0.0, 0.0) : face < 4 ? vec3(0.0, side, 0.0) : vec3(0.0, 0.0, side);
#else
    vec3 on_cube = mesh_position;
#endif
    vec3 local = on_cube * instance_scale.xyz;
#if !defined(BOX) || defined(PATTERNED)
    v_local = local;
#endif
    v_position = placed(local);
    v_orientation = instance_orientation;
    v_scale = instance_scale;
    v_color = instance_color;
    // A bevel narrower than a pixel would glitter: it grows with the distance instead.
    float pixel = haze.y * length(instance_position.xyz);
    float thinnest = min(instance_scale.x, min(instance_scale.y, instance_scale.z));
    v_look = vec4(instance_look.xy, min(max(instance_position.w, pixel), 0.5 * thinnest), instance_tile.z);
    float squared = dot(v_position, v_position);
    float share = haze_share(squared);
    v_haze = vec4(share * sky(v_position * inversesqrt(max(squared, 1e-30))), 1.0 - share);
    gl_Position = clip_from_relative * vec4(v_position, 1.0);

#ifdef BOX
    // The face's axes a and b are the box's next two; a tile has a texel's centre at each corner of its face.
    int axis = face / 2, a = (axis + 1) % 3, b = (axis + 2) % 3;
    vec3 unit_a = vec3(a == 0, a == 1, a == 2), unit_b = vec3(b == 0, b == 1, b == 2);
    v_half = vec2(dot(instance_scale.xyz, unit_a), dot(instance_scale.xyz, unit_b));
    v_on_face = vec2(dot(local, unit_a), dot(local, unit_b));
    vec2 first = instance_look.zw + vec2(float(face) * instance_tile.x, 0.0) + 0.5;
    float span = max(instance_tile.x - 1.0, 0.0);
    vec2 middle = instance_tile.x > 0.0 ? first + 0.5 * span : vec2(0.5);
    v_tile = vec4(middle, 0.5 * span / v_half) * atlas.xyxy;
    v_groove = vec2(crate_frame, 0.5 * crate_groove) * (2.0 * thinnest);
    v_along_a = rotate(instance_orientation, unit_a);
    v_along_b = rotate(instance_orientation, unit_b);
    v_normal = rotate(instance_orientation, outward);
    vec3 lift = v_normal;
#endif
#ifdef BALL
    v_tile = vec3(instance_look.zw, instance_tile.x);
    vec3 lift = rotate(instance_orientation, mesh_normal);
#endif
#ifdef MESH
    int width = textureSize(occlusion_atlas, 0).x;
    int probe = int(instance_look.z) + int(mesh_probe);
    ivec2 texel = ivec2(probe % width, int(instance_look.w) + probe / width);
    v_open = texelFetch(occlusion_atlas, instance_tile.x > 0.0 ? texel : ivec2(0), 0).r;
    v_normal = rotate(instance_orientation, normalize(mesh_normal / instance_scale.xyz));
    vec3 lift = v_normal;
#endif
#ifndef AWAY_FROM_SUN
    v_shadow = shadow_place(v_position, lift, instance_tile.w > 0.0);
#endif
}
