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
flat out vec3 v_look;               // metallic, pattern, bevel

void main() {
    v_local = mesh_position * instance_scale.xyz;
    v_position = placed(v_local);
    v_orientation = instance_orientation;
    v_scale = instance_scale;
    v_color = instance_color;
    // A bevel narrower than a pixel would glitter: it grows with the distance instead.
    float pixel = haze.y * length(instance_position.xyz);
    float thinnest = min(instance_scale.x, min(instance_scale.y, instance_scale.z));
    v_look = vec3(instance_look.xy, min(max(instance_position.w, pixel), 0.5 * thinnest));
    float squared = dot(v_position, v_position);
    float share = haze_share(squared);
    v_haze = vec4(share * sky(v_position * inversesqrt(max(squared, 1e-30))), 1.0 - share);
    gl_Position = clip_from_relative * vec4(v_position, 1.0);

#ifdef BOX
    // Faces come in the order -x, +x, -y, ... with four vertices each; a tile has a texel's centre at each corner.
    int face = gl_VertexID / 4;
    vec2 corner = face < 2 ? mesh_position.yz : face < 4 ? mesh_position.zx : mesh_position.xy;
    vec2 texel = instance_look.zw + vec2(float(face) * instance_tile, 0.0) +
                 (0.5 + 0.5 * corner) * max(instance_tile - 1.0, 0.0) + 0.5;
    v_atlas = (instance_tile > 0.0 ? texel : vec2(0.5)) * atlas.xy;
    v_normal = rotate(instance_orientation, mesh_normal);
#endif
#ifdef BALL
    v_tile = vec3(instance_look.zw, instance_tile);
#endif
#ifdef MESH
    int width = textureSize(occlusion_atlas, 0).x;
    int probe = int(instance_look.z) + int(mesh_probe);
    v_open = texelFetch(occlusion_atlas, instance_tile > 0.0 ? ivec2(probe % width, int(instance_look.w) + probe / width) : ivec2(0), 0).r;
    v_normal = rotate(instance_orientation, normalize(mesh_normal / instance_scale.xyz));
#endif
}
