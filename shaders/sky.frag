#version 410 core
#include "lighting.glsl"

flat in vec3 v_ray_x;           // coefficients of the view ray over the screen: 1, x, y in pixels
flat in vec3 v_ray_y;
flat in vec3 v_ray_z;
flat in vec3 v_to_light;
#ifdef BACKGROUND
flat in vec4 v_low, v_high;     // see background()
#endif

layout(location = 0) out vec4 pixel;

void main() {
    vec3 at = vec3(1.0, gl_FragCoord.xy);
    vec3 ray = vec3(dot(v_ray_x, at), dot(v_ray_y, at), dot(v_ray_z, at));
    ray *= inversesqrt(dot(ray, ray));
#ifdef BACKGROUND
    vec3 light = background(ray, v_low, v_high);
#else
    vec3 light = sky(ray.y, dot(ray, v_to_light));
#endif
    pixel = vec4(dithered(displayed(light)), 1.0);
}
