// Programs of planes, and of the sky behind everything.
import { frame_glsl, light_glsl, maps_vertex_glsl } from "./shading_glsl.ts";

export const plane_vertex_glsl = /* glsl */ `
${frame_glsl}
uniform vec3 u_center;          // a point of the plane near the eye, m
uniform vec3 u_axis_u, u_axis_v;
uniform float u_reach;          // half of the drawn part, m
uniform vec4 u_material;        // roughness, metallic
${maps_vertex_glsl}
out vec3 v_world;
void main() {
  v_world = u_center + u_reach * (position.x * u_axis_u + position.y * u_axis_v);
#ifdef WITH_MAPS
  place_maps(u_material.x, u_material.y);
#endif
  gl_Position = projectionMatrix * viewMatrix * vec4(v_world, 1.0);
}
`;

export const plane_fragment_glsl = /* glsl */ `
${frame_glsl}
${light_glsl}
uniform vec3 u_axis_u, u_axis_v, u_normal, u_origin;
uniform vec3 u_color;           // linear
uniform vec4 u_material;        // roughness, metallic, pattern, cell of it in m
uniform vec3 u_second;          // second color of a pattern, linear
uniform sampler2D u_image;
uniform float u_dim;            // factor on its light: a dark page has a dark ground
in vec3 v_world;
layout(location = 0) out highp vec4 pixel;
void main() {
#ifdef LAMPS
  surface_place = v_world;
#endif
  vec3 from_origin = v_world - u_origin;
  vec2 cells = vec2(dot(from_origin, u_axis_u), dot(from_origin, u_axis_v)) / u_material.w;
  vec2 width = max(abs(dFdx(cells)), abs(dFdy(cells)));
  float distinct = clamp(2.0 - max(width.x, width.y), 0.0, 1.0);
  vec3 color = u_color;
  float paint = 1.0;
#if defined(TWO_COLORS)
  color = mix(color, u_second, second_share(TWO_COLORS, vec3(cells, 0.0), vec3(width, 0.0), cells, width, cells.y, width.y));
#elif defined(IMAGE)
  vec3 root = texture(u_image, vec2(cells.x, -cells.y)).rgb;
  color *= root * root;
#else
  if (u_material.z > 1.5 && u_material.z < 2.5) paint = 1.0 - 2.0 * ground_contrast * mix(0.5, checker(cells, width), distinct);
  else if (u_material.z > 0.5 && u_material.z < 1.5) paint = 1.0 - grid_line_contrast * mix(2.0 * grid_line_width, grid(cells, width, grid_line_width), distinct);
#endif
  vec3 to_eye = cameraPosition - v_world;
  float squared = dot(to_eye, to_eye);
  to_eye *= inversesqrt(squared);
  float sun = sun_visible(v_world, u_normal);
  vec3 normal = u_normal;
#ifdef WITH_MAPS
  read_maps(vec2(cells.x, -cells.y), dFdx(cells), dFdy(cells));
#ifdef NORMAL_MAP
  normal = bent_normal(u_axis_u, u_axis_v, u_normal);
#endif
  vec3 light = u_dim * shade(normal, to_eye, color * paint, map_roughness, map_metallic, map_open, sun);
#else
  vec3 light = u_dim * shade(normal, to_eye, color * paint, u_material.x, u_material.y, 1.0, sun);
#endif
#ifdef GLOWING
  light += u_glow;
#endif
  light = in_haze(light, to_eye, squared);
#ifdef WATER
  light = through_water(light, v_world);
#endif
  pixel = vec4(dithered(displayed(light)), 1.0);
}
`;

export const sky_vertex_glsl = /* glsl */ `
uniform vec3 u_ray_center, u_ray_right, u_ray_up;
out vec3 v_ray;
void main() {
  v_ray = u_ray_center + position.x * u_ray_right + position.y * u_ray_up;
  gl_Position = vec4(position.xy, 1.0, 1.0);
}
`;

export const sky_fragment_glsl = /* glsl */ `
${frame_glsl}
${light_glsl}
in vec3 v_ray;
layout(location = 0) out highp vec4 pixel;
void main() {
  vec3 ray = normalize(v_ray);
  vec3 light = behind(ray);
#ifdef WATER
  light = through_water(light, cameraPosition + 1e5 * ray);
  float away = (cameraPosition.y - u_water.w) / -ray.y;   // of the surface, which ends before the horizon
  if (ray.y < 0.0 && away > 0.0) light = in_haze(light, -ray, away * away);
#endif
  pixel = vec4(dithered(displayed(light)), 1.0);
}
`;
