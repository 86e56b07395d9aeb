#version 410 core
// The part of the screen where no plane is, in clip space.
#include "frame.glsl"
#ifdef BACKGROUND
#include "environment_block.glsl"

flat out vec4 v_low, v_high;    // see background()
#endif

layout(location = 0) in vec3 clip_position;

flat out vec3 v_ray_x;          // see sky.frag
flat out vec3 v_ray_y;
flat out vec3 v_ray_z;
flat out vec3 v_to_light;

void main() {
    gl_Position = vec4(clip_position, 1.0);
    v_ray_x = vec3(ray_origin.x, ray_dx.x, ray_dy.x);
    v_ray_y = vec3(ray_origin.y, ray_dx.y, ray_dy.y);
    v_ray_z = vec3(ray_origin.z, ray_dx.z, ray_dy.z);
    v_to_light = to_light.xyz;
#ifdef BACKGROUND
    v_low = background_low;
    v_high = background_high;
#endif
}
