#version 410 core
#include "frame.glsl"
#include "instance.glsl"

out vec3 v_position;                // relative to the eye
out vec3 v_local;                   // body axes, from the body's origin, m
out vec3 v_normal;                  // the mesh's, world axes
flat out vec4 v_orientation;
flat out vec4 v_scale;              // w: occlusion reach
flat out vec4 v_color;              // w: roughness
flat out vec4 v_look;               // metallic, pattern, body number, bevel

void main() {
    v_local = mesh_position * instance_scale.xyz;
    v_position = placed(v_local);
    v_normal = rotate(instance_orientation, normalize(mesh_normal / instance_scale.xyz));
    v_orientation = instance_orientation;
    v_scale = instance_scale;
    v_color = instance_color;
    // A bevel narrower than a pixel would glitter: it grows with the distance instead.
    float pixel = haze.y * length(instance_position.xyz);
    float thinnest = min(instance_scale.x, min(instance_scale.y, instance_scale.z));
    v_look = vec4(instance_look.xyz, min(max(instance_position.w, pixel), 0.5 * thinnest));
    gl_Position = clip_from_relative * vec4(v_position, 1.0);
}
