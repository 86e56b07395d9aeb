// Programs of the darker ground below bodies, where they hide the sky: a rectangle of the plane for each body near it, which
// multiplies what is there.
import { frame_glsl, light_glsl } from "./shading_glsl.ts";

export const occlusion_vertex_glsl = /* glsl */ `
${frame_glsl}
in vec4 i_foot;       // m, below the middle of the body; w: height of its underside, or of the middle of a ball
in vec4 i_half;       // m, half of the rectangle that the body covers, along the axes; half of the drawn part
in vec3 i_along;      // unit, in the plane: the first axis
uniform vec3 u_normal;
out vec3 v_world;
out vec2 v_on_plane;
flat out vec3 v_cover;
void main() {
  v_on_plane = position.xy * i_half.zw;
  v_cover = vec3(i_half.xy, i_foot.w);
  v_world = i_foot.xyz + v_on_plane.x * i_along + v_on_plane.y * cross(u_normal, i_along);
  gl_Position = projectionMatrix * viewMatrix * vec4(v_world, 1.0);
}
`;

export const occlusion_fragment_glsl = /* glsl */ `
${frame_glsl}
${light_glsl}
uniform vec3 u_normal;
in vec3 v_world;
in vec2 v_on_plane;
flat in vec3 v_cover;
layout(location = 0) out highp vec4 pixel;

// Share of the sky that a quarter of a rectangle above hides, seen from below its corner (Howell's configuration factor B-4).
float corner(vec2 at, float height) {
  vec2 root = sqrt(at * at + height * height);
  return (at.x / root.x * atan(at.y / root.x) + at.y / root.y * atan(at.x / root.y)) / 6.2831853;
}

void main() {
  float hidden;
  if (v_cover.y == 0.0) {   // a ball: its radius, and the height of its middle
    float squared = dot(v_on_plane, v_on_plane) + v_cover.z * v_cover.z;
    hidden = v_cover.x * v_cover.x * v_cover.z * inversesqrt(squared) / squared;
  } else {
    vec2 far = v_cover.xy + v_on_plane, near = v_cover.xy - v_on_plane;
    hidden = corner(far, v_cover.z) + corner(near, v_cover.z) + corner(vec2(far.x, near.y), v_cover.z) + corner(vec2(near.x, far.y), v_cover.z);
  }
  // What is left at the border of the drawn part is taken off, so that none is seen.
  float open = 1.0 - 0.8 * clamp((hidden - 0.03) / 0.97, 0.0, 1.0);   // by eye, beside the program's own
  vec3 ambient = mix(bounce_light, sky_light, 0.5 + 0.5 * u_normal.y);
  vec3 direct = sun_light * max(dot(u_normal, u_to_light), 0.0) * sun_visible(v_world, u_normal);
  vec3 left = (ambient * open + direct * (1.0 - occlusion_of_sun + occlusion_of_sun * open)) / (ambient + direct);
  vec3 to_eye = cameraPosition - v_world;
  left = mix(left, vec3(1.0), fog_share(dot(to_eye, to_eye), u_fog));
  pixel = vec4(pow(left, vec3(1.0 / 2.2)), 1.0);
}
`;
