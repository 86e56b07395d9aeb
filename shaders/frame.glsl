// What is the same for a whole frame (render/frame_uniforms.h fills it in). Positions are world axes, relative to the
// eye: subtracted in double precision, so that a scene far from the origin stays steady.
layout(std140) uniform Frame {
    mat4 clip_from_relative;
    vec4 ray_origin;             // the view ray through pixel (x, y) is origin + x dx + y dy, 1 along the axis
    vec4 ray_dx;
    vec4 ray_dy;
    vec4 to_light;               // unit, or 0 where the sun is below the ground; w: 1 with shadows, else 0
    vec4 shadow_x;               // rows: relative position -> [0, 1] across the near shadow map, and depth in it
    vec4 shadow_y;
    vec4 shadow_z;
    vec4 shadow_far;             // near map -> far map: scale, offset x, offset y; w: 1 with a far map, else 0
    vec4 shadow_texels;          // a texel's size in m, near and far; z: texels across one map;
                                 // w: how many of them a point is moved along the normal before it looks
    vec4 haze;                   // x: 1 / distance^2 at which half the light is haze; y: a pixel's size at distance 1;
                                 // z: half the size of the widest rod there; w: of the thinnest; 0: none is widened
    vec4 atlas;                  // 1 / size of the occlusion atlas, in texels
};
