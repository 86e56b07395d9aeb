#version 410 core
#include "lighting.glsl"

flat in vec3 v_ray_x;           // coefficients of the view ray over the screen: 1, x, y in pixels
flat in vec3 v_ray_y;
flat in vec3 v_ray_z;
flat in vec3 v_to_light;

layout(location = 0) out vec4 pixel;

void main() {
    vec3 at = vec3(1.0, gl_FragCoord.xy);
    vec3 ray = vec3(dot(v_ray_x, at), dot(v_ray_y, at), dot(v_ray_z, at));
    ray *= inversesqrt(dot(ray, ray));
    pixel = vec4(dithered(displayed(sky(ray.y, dot(ray, v_to_light)))), 1.0);
}
