// Programs of arrows, lines and markers: their widths are pixels, whatever their distance. Each is a rectangle on the screen
// whose pixels know their distance from the outline, as in src/overlay/shape_raster.cpp.

import { style, style_glsl } from "./overlay_style.ts";

const screen_vertex_glsl = /* glsl */ `
${style_glsl}in vec4 a_from;   // m; w: width in units, or the time at the start of a piece of a trail, s
in vec4 a_to;     // m; w: number of heads, or the time at its end
in vec4 a_color;  // sRGB; w: opacity
in vec4 a_more;   // surfaces nearer by less do not hide it, m; 1: never hidden; form of a marker, or width of a trail
uniform vec2 u_view;      // pixels
uniform float u_unit;     // pixels of a unit of sizes on the screen
uniform float u_near;     // m
flat out vec4 v_color;

vec2 pixel_of(vec3 seen) {
  vec4 clip = projectionMatrix * vec4(seen, 1.0);
  return (0.5 * clip.xy / clip.w + 0.5) * u_view;
}

// Of clip space: the place of an overlay that lies in a surface is a little nearer than the surface.
float depth_of(vec3 seen) {
  if (a_more.y > 0.5) return -1.0;
  vec4 clip = projectionMatrix * vec4(0.0, 0.0, min(seen.z * 0.997 + a_more.x, -u_near), 1.0);
  return clip.z / clip.w;
}

// False: behind the eye.
bool cut(inout vec3 a, inout vec3 b) {
  if (a.z > -u_near && b.z > -u_near) return false;
  if (a.z > -u_near) a = mix(a, b, (a.z + u_near) / (a.z - b.z));
  if (b.z > -u_near) b = mix(b, a, (b.z + u_near) / (b.z - a.z));
  return true;
}

void nowhere() { gl_Position = vec4(2.0, 2.0, 2.0, 1.0); }
void put(vec2 pixel, float depth) { gl_Position = vec4(2.0 * pixel / u_view - 1.0, depth, 1.0); }
// Thin shapes have a thin outline, which is otherwise all that is seen of them.
float halo_of(float width) { return min(most_halo * max(u_unit, 1.0), halo_of_width * width); }
`;

const screen_fragment_glsl = /* glsl */ `
${style_glsl}uniform float u_opacity;
flat in vec4 v_color;
layout(location = 0) out highp vec4 pixel;
float coverage(float distance) { return clamp(0.5 - distance, 0.0, 1.0); }
// The shape over its dark outline, so that it is seen on bright and on dark ground.
void paint(float distance, float halo) {
  float share = v_color.w * u_opacity;
  float own = share * coverage(distance), dark = halo_opacity * share * coverage(distance - halo);
  dark *= 1.0 - own;
  if (own + dark <= 0.0) discard;
  pixel = vec4(v_color.rgb * own + halo_color * dark, own + dark);
}
`;

export const arrow_vertex_glsl = /* glsl */ `
${screen_vertex_glsl}
out vec2 v_at;                  // pixels from the foot, along and across
flat out vec4 v_arrow;          // half the width of the shaft, its end, length of a head, tip of the second
flat out vec4 v_head;           // slope of a head along and across, tip, outline
void main() {
  vec3 from = (viewMatrix * vec4(a_from.xyz, 1.0)).xyz, to = (viewMatrix * vec4(a_to.xyz, 1.0)).xyz;
  v_color = a_color;
  v_at = vec2(0.0);
  v_arrow = v_head = vec4(0.0);
  if (!cut(from, to)) { nowhere(); return; }
  vec2 foot = pixel_of(from), way = pixel_of(to) - foot;
  float size = length(way), width = a_from.w * u_unit;
  if (size < 1e-3) { nowhere(); return; }
  vec2 axis = way / size, side = vec2(-axis.y, axis.x);
  float more = second_head * (a_to.w - 1.0);
  float scale = min(1.0, size / (1.0 + more) / (head_length * width));
  float head = scale * head_length * width, half_base = max(scale * head_half_width * width, 0.5 * width), halo = halo_of(width);
  v_arrow = vec4(0.5 * width, max(0.0, size - (head_overlap + more) * head), head, size - more * head);
  v_head = vec4(vec2(half_base, head) / length(vec2(head, half_base)), size, halo);
  float reach = half_base + halo + 1.0, rear = 0.5 * width + halo + 1.0;
  v_at = vec2(mix(-rear, size + halo + 1.0, position.x), position.y * reach);
  float share = clamp(v_at.x / size, 0.0, 1.0);
  put(foot + axis * v_at.x + side * v_at.y, mix(depth_of(from), depth_of(to), share));
}
`;

export const arrow_fragment_glsl = /* glsl */ `
${screen_fragment_glsl}
in vec2 v_at;
flat in vec4 v_arrow, v_head;
float head(float tip, float along, float across) {
  return max(tip - v_arrow.z - along, (along - tip) * v_head.x + across * v_head.y);
}
void main() {
  float along = v_at.x, across = abs(v_at.y);
  float before = along - clamp(along, 0.0, v_arrow.y);
  float shaft = length(vec2(before, across)) - v_arrow.x;
  paint(min(shaft, min(head(v_head.z, along, across), head(v_arrow.w, along, across))), v_head.w);
}
`;

export const line_vertex_glsl = /* glsl */ `
${screen_vertex_glsl}
uniform vec2 u_times;           // s: pieces of trails are seen from the first to the second
out vec2 v_at;
flat out vec3 v_line;           // length, half of the width, outline
void main() {
  vec3 start = a_from.xyz, end = a_to.xyz;
  float width = a_from.w * u_unit;
  v_color = a_color;
  v_at = vec2(0.0);
  v_line = vec3(0.0);
#ifdef TRAIL
  width = a_more.z * u_unit;
  vec2 part = clamp((u_times - a_from.w) / max(a_to.w - a_from.w, 1e-9), 0.0, 1.0);
  if (part.x >= part.y) { nowhere(); return; }
  start = mix(a_from.xyz, a_to.xyz, part.x);
  end = mix(a_from.xyz, a_to.xyz, part.y);
#endif
  vec3 from = (viewMatrix * vec4(start, 1.0)).xyz, to = (viewMatrix * vec4(end, 1.0)).xyz;
  if (!cut(from, to)) { nowhere(); return; }
  vec2 foot = pixel_of(from), way = pixel_of(to) - foot;
  float size = length(way), halo = halo_of(width), reach = 0.5 * width + halo + 1.0;
  vec2 axis = size < 1e-3 ? vec2(1.0, 0.0) : way / size, side = vec2(-axis.y, axis.x);
  v_line = vec3(size, 0.5 * width, halo);
  // Round at the end alone: a piece leaves the end of the piece before it as it is, so that joints show no seam.
  v_at = vec2(mix(0.0, size + reach, position.x), position.y * reach);
  put(foot + axis * v_at.x + side * v_at.y, mix(depth_of(from), depth_of(to), clamp(v_at.x / max(size, 1e-3), 0.0, 1.0)));
}
`;

export const line_fragment_glsl = /* glsl */ `
${screen_fragment_glsl}
in vec2 v_at;
flat in vec3 v_line;
void main() {
  paint(length(vec2(max(v_at.x - v_line.x, 0.0), v_at.y)) - v_line.y, v_line.z);
}
`;

export const marker_vertex_glsl = /* glsl */ `
${screen_vertex_glsl}
out vec2 v_at;
flat out vec3 v_marker;         // radius, form, outline
void main() {
  vec3 seen = (viewMatrix * vec4(a_from.xyz, 1.0)).xyz;
  float radius = a_from.w * u_unit, halo = halo_of(radius), reach = 1.3 * radius + halo + 1.0;
  v_color = a_color;
  v_marker = vec3(radius, a_more.z, halo);
  v_at = vec2(2.0 * position.x - 1.0, position.y) * reach;
  if (seen.z > -u_near) { nowhere(); return; }
  put(pixel_of(seen) + v_at, depth_of(seen));
}
`;

/** Forms of markers, by the number that the program of markers takes. */
export type MarkerForm = "disc" | "ring" | "square" | "diamond" | "cross" | "center-of-mass";
export const marker_forms = style.markers as MarkerForm[];

export const marker_fragment_glsl = /* glsl */ `
${screen_fragment_glsl}
in vec2 v_at;
flat in vec3 v_marker;
float form(vec2 p, float radius) {
  int kind = int(v_marker.y + 0.5);
  if (kind == 1) return abs(length(p) - 0.8 * radius) - 0.3 * radius;
  if (kind == 2) return max(abs(p.x), abs(p.y)) - 0.85 * radius;
  if (kind == 3) return (abs(p.x) + abs(p.y) - 1.3 * radius) * 0.70710678;
  if (kind == 4) {
    float u = abs(p.x + p.y) * 0.70710678, v = abs(p.x - p.y) * 0.70710678, arm = 1.15 * radius, half_arm = 0.32 * radius;
    return min(max(u - arm, v - half_arm), max(v - arm, u - half_arm));
  }
  return length(p) - radius;
}
void main() {
  paint(form(v_at, v_marker.x), v_marker.z);
  // The sign of a center of mass: two dark quarters.
  if (v_marker.y > 4.5) {
    float edge = min(abs(v_at.x), abs(v_at.y)), quarters = max(length(v_at) - v_marker.x, v_at.x * v_at.y > 0.0 ? edge : -edge);
    pixel.rgb = mix(pixel.rgb, center_dark_color * pixel.a, coverage(quarters));
  }
}
`;
