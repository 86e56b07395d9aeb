// Uniforms that are constant over a frame (filled in by render/passes/frame_uniforms.h). Positions have world axes
// relative to the eye, subtracted in double precision, so that a scene far from the origin does not jitter.
layout(std140) uniform Frame {
    mat4 clip_from_relative;
    vec4 ray_origin;             // the view ray through pixel (x, y) is origin + x dx + y dy, 1 along the axis
    vec4 ray_dx;
    vec4 ray_dy;
    vec4 to_light;               // unit, or 0 if the sun is below the ground; w: 1 with shadows, otherwise 0
    vec4 shadow_x;               // rows: relative position -> [0, 1] across the near shadow map, and depth in it
    vec4 shadow_y;
    vec4 shadow_z;
    vec4 shadow_far;             // near map -> far map: scale, offset x, offset y; w: 1 with a far map, otherwise 0
    vec4 shadow_texels;          // size of a texel, m, near and far; z, w: bias towards
                                 // the sun and along the normal, texels
    float fog_density;           // 1 / squared distance at which fog is half of the light, 1/m^2
    float pixel_size;            // at distance 1
    float widest_rod;            // half size at distance 1
    float thinnest_rod;          // the same; both are 0 if no rod is widened
    vec4 atlas;                  // 1 / size of the AO atlas, in texels; z: height below which CUT bodies are, m
};
