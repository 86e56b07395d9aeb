// The fragment's side of body.vert.
in vec3 v_position;
in vec3 v_local;
in vec3 v_normal;
flat in vec4 v_orientation;
flat in vec4 v_scale;
flat in vec4 v_color;
flat in vec4 v_look;

layout(location = 0) out vec4 pixel;
