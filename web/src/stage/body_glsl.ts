// Programs of bodies: boxes, balls and meshes with a pose and a material for each instance (see body_batch.ts).
import { style_glsl } from "./overlay_style.ts";
import { frame_glsl, light_glsl, maps_vertex_glsl } from "./shading_glsl.ts";

const instance_glsl = /* glsl */ `
in vec4 i_place;      // m; w: cell of the pattern, m
in vec4 i_rotation;   // x, y, z, w
in vec4 i_size;       // factors on the mesh; w: bevel, m
in vec4 i_color;      // linear; w: roughness
in vec4 i_material;   // metallic, pattern, opacity, 0
in vec4 i_tint;       // sRGB; w: share of it in the shown color
in vec4 i_second;     // second color of a pattern, linear; of an image how often it goes around and along a ball
`;

export const body_vertex_glsl = /* glsl */ `
${frame_glsl}
${instance_glsl}
${maps_vertex_glsl}
out vec3 v_local, v_world;
out vec3 v_normal;              // body frame
#ifdef PAINTED
in vec2 p_uv, p_surface;        // of the mesh's file: roughness and metallic, below 0 the body's
in vec3 p_color, p_emission;    // linear
out vec2 v_uv;
out vec3 v_paint, v_emission;
#endif
flat out vec4 v_rotation, v_size, v_color, v_material, v_tint;
flat out float v_cell;
#if defined(TWO_COLORS) || defined(IMAGE)
flat out vec3 v_second;
#endif
void main() {
  vec3 size = i_size.xyz;
  v_local = position * size;
  v_normal = normal / size;
  v_world = i_place.xyz + rotate(i_rotation, v_local);
  float pixel = u_pixel_size * distance(i_place.xyz, cameraPosition);
  float thinnest = min(size.x, min(size.y, size.z));
  // A bevel narrower than a pixel flickers; a box of a few pixels has none.
  float bevel = min(max(i_size.w, pixel), 0.5 * thinnest) * max(smoothstep(flat_box * pixel, round_box * pixel, thinnest), 1e-3);
  v_rotation = i_rotation;
  v_size = vec4(size, bevel);
  v_color = i_color;
  v_material = i_material;
  v_tint = i_tint;
  v_cell = i_place.w;
#if defined(TWO_COLORS) || defined(IMAGE)
  v_second = i_second.xyz;
#endif
#ifdef PAINTED
  v_uv = p_uv;
  v_paint = p_color;
  v_emission = p_emission;
  v_color.w = p_surface.x < 0.0 ? v_color.w : p_surface.x;
  v_material.x = p_surface.y < 0.0 ? v_material.x : p_surface.y;
#endif
#ifdef WITH_MAPS
  place_maps(v_color.w, v_material.x);
#endif
  gl_Position = projectionMatrix * viewMatrix * vec4(v_world, 1.0);
}
`;

export const body_fragment_glsl = /* glsl */ `
${frame_glsl}
${light_glsl}
${style_glsl}
in vec3 v_local, v_world;
in vec3 v_normal;
flat in vec4 v_rotation, v_size, v_color, v_material, v_tint;
flat in float v_cell;
#if defined(TWO_COLORS) || defined(IMAGE)
flat in vec3 v_second;
#endif
#ifdef IMAGE
uniform sampler2D u_image;      // square roots of linear light
uniform float u_image_scale;    // m that an image covers; 0: a face, or the way around
#endif
#ifdef PAINTED
uniform sampler2D u_image;      // square roots of linear light, and alpha
uniform float u_cutoff;
in vec2 v_uv;
in vec3 v_paint, v_emission;
#endif
layout(location = 0) out highp vec4 pixel;

// Grids and checkers of one color.
bool darkens() { return v_material.y > 0.5 && v_material.y < 2.5; }

void main() {
  vec3 color = v_color.rgb;
  float paint = 1.0;
#ifdef LAMPS
  surface_place = v_world;
#endif
#if defined(BOX)
  vec3 local = clamp(v_local, -v_size.xyz, v_size.xyz), inner = v_size.xyz - v_size.w;
  vec3 normal = normalize(local - clamp(local, -inner, inner));
#if defined(TWO_COLORS)
  color = mix(color, v_second, body_share(TWO_COLORS, local / v_cell, fwidth(v_local) / v_cell, normalize(v_normal), v_size.xyz));
#elif defined(IMAGE)
  vec2 images = images_on_face(v_size.xyz, v_normal, u_image_scale) / (2.0 * abs(seen_from_outside(v_size.xyz, v_normal)));
  vec2 place = 0.5 + seen_from_outside(local, v_normal) * images;
  vec3 root = texture(u_image, place).rgb;
  color *= root * root;
#ifdef WITH_MAPS
  vec2 smooth_place = seen_from_outside(v_local, v_normal) * images;
  read_maps(place, dFdx(smooth_place), dFdy(smooth_place));
#ifdef NORMAL_MAP
  normal = bent_normal(v_local, smooth_place, normal);
#endif
#endif
#else
  if (darkens()) {
    paint = triplanar_paint(vec2(v_material.y, v_cell), local, v_normal);
  } else if (v_material.y < 0.5) {
    // The groove between the frame and the panel of a face.
    vec3 to_edges = v_size.xyz - abs(local) + step(0.5, abs(normalize(v_normal))) * 1e9;
    float edge = min(to_edges.x, min(to_edges.y, to_edges.z)), shortest = 2.0 * min(v_size.x, min(v_size.y, v_size.z));
    float per_footprint = 1.0 / max(fwidth(edge), 1e-6), half_width = 0.5 * crate_groove * shortest;
    float off = abs(edge - crate_frame * shortest);
    float groove = clamp((half_width - off) * per_footprint + 0.5, 0.0, 1.0) * min(2.0 * half_width * per_footprint, 1.0);
    paint = 1.0 - crate_groove_depth * groove;
  }
#endif
#elif defined(BALL)
  vec3 normal = normalize(v_local);
#if defined(TWO_COLORS)
  color = mix(color, v_second, ball_share(TWO_COLORS, v_local / v_cell, fwidth(v_local) / v_cell, normal));
#elif defined(IMAGE)
  vec2 footprint = footprint_on_ball(normal, max(abs(dFdx(normal)), abs(dFdy(normal))), v_second.xy) * vec2(textureSize(u_image, 0));
  color *= texel_at(u_image, place_on_ball(normal, v_second.xy), log2(max(max(footprint.x, footprint.y), 1e-6)));
#ifdef WITH_MAPS
  footprint /= vec2(textureSize(u_image, 0));
  read_maps(place_on_ball(normal, v_second.xy), log2(max(max(footprint.x, footprint.y), 1e-9)));
#ifdef NORMAL_MAP
  vec3 right = vec3(normal.z, 0.0, -normal.x) * inversesqrt(max(dot(normal.xz, normal.xz), 1e-12));
  normal = bent_normal(right, cross(normal, right), normal);
#endif
#endif
#else
  if (darkens()) {
    paint = triplanar_paint(vec2(v_material.y, v_cell), v_local, normal);
  } else if (v_material.y < 0.5) {
    // Paler paint on every second octant shows the rotation; metal has none.
    vec3 side = clamp(normal / max(fwidth(normal), vec3(1e-6)), -1.0, 1.0);
    float octant = 0.5 + 0.5 * side.x * side.y * side.z, metallic = v_material.x;
    color += octant * ball_contrast * (1.0 - metallic) * (1.0 - color);
    paint = 1.0 - octant * ball_contrast * metallic;
  }
#endif
#else
#ifdef PAINTED
  vec4 texel = texture(u_image, v_uv);
#ifdef HOLES
  if (texel.a < u_cutoff) discard;
#endif
  color = v_paint * texel.rgb * texel.rgb;
#endif
  vec3 normal = normalize(v_normal);
  normal = gl_FrontFacing ? normal : -normal;
#if defined(PAINTED) && defined(WITH_MAPS)
  read_maps(v_uv, dFdx(v_uv), dFdy(v_uv));
#ifdef NORMAL_MAP
  normal = bent_normal(v_local, v_uv, normal);
#endif
#endif
#if defined(TWO_COLORS)
  color = mix(color, v_second, body_share(TWO_COLORS, v_local / v_cell, fwidth(v_local) / v_cell, normal, vec3(1.0)));
#else
  if (darkens()) paint = triplanar_paint(vec2(v_material.y, v_cell), v_local, normal);
#endif
#endif
  normal = rotate(v_rotation, normal);
  vec3 to_eye = cameraPosition - v_world;
  float squared = dot(to_eye, to_eye);
  to_eye *= inversesqrt(squared);
#ifdef GHOST
  // Lit from the eye and from above, as the program's ghosts are; the paint shows how it is turned.
  vec3 above = normalize(vec3(0.0, 1.0, 0.0) + ghost_light_from_eye * to_eye);
  vec3 shown = displayed(color) * mix(ghost_ambient, 1.0, max(dot(normal, above), 0.0)) * (0.5 + 0.5 * paint);
  shown = mix(shown, v_tint.rgb * (0.55 + 0.45 * max(dot(normal, above), 0.0)), v_tint.w);
  pixel = vec4(shown * v_material.z, v_material.z);
#else
  float sun = sun_visible(v_world, normal);
#ifdef WITH_MAPS
  vec3 light = paint * shade(normal, to_eye, color, map_roughness, map_metallic, map_open, sun);
#else
  vec3 light = paint * shade(normal, to_eye, color, v_color.w, v_material.x, 1.0, sun);
#endif
#ifdef PAINTED
#ifdef EMISSION_MAP
  light += v_emission * map_emission;
#else
  light += v_emission;
#endif
#endif
#ifdef GLOWING
  light += u_glow;
#endif
  light = in_fog(light, to_eye, squared);
#ifdef WATER
  light = through_water(light, v_world);
#endif
  pixel = vec4(mix(displayed(light), v_tint.rgb, v_tint.w), 1.0);
#ifdef TRANSLUCENT
  float share = u_opacity;
#if defined(PAINTED) && !defined(HOLES)
  share *= texel.a;
#endif
  pixel *= share;
#endif
#endif
}
`;

export const depth_vertex_glsl = /* glsl */ `
${frame_glsl}
in vec4 i_place, i_rotation, i_size, i_material;
flat out float v_shade;         // opacity
void main() {
  v_shade = i_material.z;
  vec3 world = i_place.xyz + rotate(i_rotation, position * i_size.xyz);
  gl_Position = projectionMatrix * viewMatrix * vec4(world, 1.0);
}
`;

// As shaders/shadow.frag: a part of the texels casts the shadow of a translucent body.
export const depth_fragment_glsl = /* glsl */ `
flat in float v_shade;
layout(location = 0) out highp vec4 pixel;
void main() {
  ivec2 at = ivec2(gl_FragCoord.xy) % 3;
  const int ranks[9] = int[9](0, 5, 7, 3, 8, 2, 6, 1, 4);
  if (float(ranks[at.y * 3 + at.x]) + 0.5 > v_shade * 9.0) discard;
  pixel = vec4(0.0);
}
`;

// The back of the body, moved outward by some pixels on the screen: what shows beside the body is its outline.
export const outline_vertex_glsl = /* glsl */ `
${frame_glsl}
in vec4 i_place, i_rotation, i_size;
uniform vec2 u_outline;         // of clip space, for the width of the outline
void main() {
  vec3 local = position * i_size.xyz;
#ifdef BOX
  vec3 out_of = sign(position);
#elif defined(BALL)
  vec3 out_of = position;
#else
  vec3 out_of = normal / i_size.xyz;
#endif
  mat4 clip = projectionMatrix * viewMatrix;
  gl_Position = clip * vec4(i_place.xyz + rotate(i_rotation, local), 1.0);
  vec2 way = (clip * vec4(rotate(i_rotation, out_of), 0.0)).xy / u_outline;
  gl_Position.xy += way / max(length(way), 1e-9) * u_outline * gl_Position.w;
}
`;

export const outline_fragment_glsl = /* glsl */ `
uniform vec3 u_outline_color;
layout(location = 0) out highp vec4 pixel;
void main() { pixel = vec4(u_outline_color, 1.0); }
`;
