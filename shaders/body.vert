#version 410 core
// Compiled for each kind of body: BOX, BALL or MESH is defined.
#include "frame.glsl"
#include "instance.glsl"
#include "look.glsl"
#include "sky.glsl"

#ifdef MESH
uniform sampler2D occlusion_atlas;
#endif

out vec3 v_position;                // relative to the eye
out vec3 v_local;                   // body axes, from the body's origin, m
out vec4 v_haze;                    // light of the air before it; w: share of its own light that comes through
#ifdef BOX
flat out vec3 v_normal;             // of the face, world axes
out vec2 v_atlas;                   // place in the occlusion atlas
flat out vec4 v_rim;                // first and last place of the face there
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
    v_local = on_cube * instance_scale.xyz;
    v_position = placed(v_local);
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
    // A tile has a texel's centre at each corner of its face.
    vec2 first = instance_look.zw + vec2(float(face) * instance_tile.x, 0.0) + 0.5;
    float span = instance_tile.x - 1.0;
    v_rim = (instance_tile.x > 0.0 ? vec4(first, first + span) : vec4(0.5)) * atlas.xyxy;
    v_atlas = mix(v_rim.xy, v_rim.zw, 0.5 + 0.5 * corner);
    v_normal = rotate(instance_orientation, outward);
#endif
#ifdef BALL
    v_tile = vec3(instance_look.zw, instance_tile.x);
#endif
#ifdef MESH
    int width = textureSize(occlusion_atlas, 0).x;
    int probe = int(instance_look.z) + int(mesh_probe);
    ivec2 texel = ivec2(probe % width, int(instance_look.w) + probe / width);
    v_open = texelFetch(occlusion_atlas, instance_tile.x > 0.0 ? texel : ivec2(0), 0).r;
    v_normal = rotate(instance_orientation, normalize(mesh_normal / instance_scale.xyz));
#endif
}
