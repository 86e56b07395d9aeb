#version 410 core
#define OPEN
#include "frame.glsl"
#include "lighting.glsl"

layout(location = 0) out vec4 pixel;

void main() {
    vec3 ray = ray_origin.xyz + gl_FragCoord.x * ray_dx.xyz + gl_FragCoord.y * ray_dy.xyz;
    pixel = vec4(displayed(sky(normalize(ray))), 1.0);
}
