#version 410 core
// The part of the screen that an infinite plane covers, as a polygon in clip space (render/plane_patch.h).
layout(location = 0) in vec3 clip_position;

void main() { gl_Position = vec4(clip_position, 1.0); }
