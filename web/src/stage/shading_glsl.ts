// The light of the program's own renderer, in world axes: the files of shaders/ are those that the program compiles, so a page
// shows what a clip shows. Light is linear and relative: 1 on a white surface is paper white.
import environment from "../../../shaders/environment.glsl";
import light_constants from "../../../shaders/light_constants.glsl";
import lighting from "../../../shaders/lighting.glsl";
import lights from "../../../shaders/lights.glsl";
import material from "../../../shaders/material.glsl";
import pattern from "../../../shaders/pattern.glsl";
import rotation from "../../../shaders/rotate.glsl";
import sky from "../../../shaders/sky.glsl";
import solid_pattern from "../../../shaders/solid_pattern.glsl";
import surface_maps from "../../../shaders/surface_maps.glsl";
import surface_maps_place from "../../../shaders/surface_maps_place.glsl";
import texture_place from "../../../shaders/texture_place.glsl";

export const frame_glsl = /* glsl */ `
uniform vec3 u_to_light;        // unit
uniform vec3 u_sky;             // factor on the light of the background: a dark page has a dark sky
#ifdef ENVIRONMENT
uniform vec3 u_around[9];       // see light_around()
uniform vec3 u_sun_share;
#endif
#ifdef BACKGROUND
uniform vec4 u_low, u_high;     // see background() of environment.glsl
#endif
uniform float u_fog;            // 1 / squared distance at which fog is half of the light, 1/m^2
uniform float u_pixel_size;     // at distance 1
uniform mat4 u_shadow_matrix;   // world -> place in the shadow map, 0 to 1
uniform highp sampler2DShadow u_shadow_map;
uniform float u_shadow_size;    // texels
uniform float u_shadow_texel;   // m; 0 without shadows

${rotation}
${light_constants}
`;

export const maps_vertex_glsl = /* glsl */ `
#if defined(NORMAL_MAP) || defined(SURFACE_MAP) || defined(EMISSION_MAP)
#define WITH_MAPS
${surface_maps_place}
#endif
`;

export const water_height_glsl = /* glsl */ `
uniform vec4 u_water;           // color, linear; m, level
#ifdef WAVES
uniform vec4 u_waves[WAVES];    // k, 1/m; amplitude, m; phase at the origin, rad
#endif

float water_height(vec2 at) {
  float height = u_water.w;
#ifdef WAVES
  for (int i = 0; i < WAVES; ++i) height += u_waves[i].z * cos(dot(u_waves[i].xy, at) + u_waves[i].w);
#endif
  return height;
}
`;

export const light_glsl = /* glsl */ `
#define SUNLIT
${sky}
${environment}
${material}
${lighting}
#ifdef LAMPS
uniform int u_lamp_kinds;
${lights}
vec3 surface_place;             // m, set by main()
#endif
${pattern}
#ifdef TWO_COLORS
${solid_pattern}
#endif
#ifdef IMAGE
${texture_place}
#endif
#if defined(NORMAL_MAP) || defined(SURFACE_MAP) || defined(EMISSION_MAP)
#define WITH_MAPS
${surface_maps}
#endif
#ifdef GLOWING
uniform vec3 u_glow;            // linear
#endif
#ifdef TRANSLUCENT
uniform float u_opacity;
#endif

vec3 behind(vec3 way) {
#ifdef BACKGROUND
  return background(way, u_low, u_high);
#else
  return u_sky * sky(way.y, dot(way, u_to_light));
#endif
}

#ifdef WATER
${water_height_glsl}
// Light of a place whose view may pass through water: tinted by its way through it (Beer's law).
vec3 through_water(vec3 light, vec3 world) {
  float high = world.y - water_height(world.xz), eye_high = cameraPosition.y - water_height(cameraPosition.xz);
  float way = distance(world, cameraPosition), wet = max(-high, 0.0) + max(-eye_high, 0.0);
  if (wet == 0.0) return light;
  if (high * eye_high < 0.0) way *= wet / (abs(high) + abs(eye_high));
#ifdef ENVIRONMENT
  vec3 sun = v_sun * u_sun_share, around = light_around(vec3(0.0, 1.0, 0.0), u_around);
#else
  vec3 sun = v_sun, around = sky_light;
#endif
  vec3 kept = exp(log(max(u_water.rgb, 0.004)) / water_clear_way * min(way, 1e6));
  return mix(u_water.rgb * (around + sun * max(u_to_light.y, 0.0)), light, kept);
}
#endif

vec3 in_fog(vec3 light, vec3 to_eye, float squared) {
  float share = fog_share(squared, u_fog);
  return share < 1e-3 ? light : mix(light, behind(-to_eye), share);
}

// The same on a plane.
vec3 in_haze(vec3 light, vec3 to_eye, float squared) {
#ifdef BACKGROUND
  return mix(light, behind(-to_eye), haze_share(squared, u_fog));
#else
  return in_fog(light, to_eye, squared);
#endif
}

// Castano 2013, Shadow Mapping Summary: a 3x3 filter by four comparisons that the hardware interpolates.
float sun_visible(vec3 world, vec3 normal) {
  if (u_shadow_texel == 0.0 || dot(normal, u_to_light) <= 0.0) return 1.0;
  vec3 place = (u_shadow_matrix * vec4(world + normal * (1.5 * u_shadow_texel), 1.0)).xyz;
  vec2 from_middle = abs(place.xy - 0.5);
  if (max(from_middle.x, from_middle.y) > 0.495 || place.z > 1.0) return 1.0;
  vec2 at = place.xy * u_shadow_size + 0.5;
  vec2 base = floor(at), f = at - base;
  vec2 w0 = 3.0 - 2.0 * f, w1 = 1.0 + 2.0 * f;
  vec2 o0 = (base - 1.5 + (2.0 - f) / w0) / u_shadow_size, o1 = (base + 0.5 + f / w1) / u_shadow_size;
  // Two opposite corners of the filter tell whether an edge is near: elsewhere the other two say the same.
  float low = texture(u_shadow_map, vec3(o0, place.z)), high = texture(u_shadow_map, vec3(o1, place.z));
  if (low == high && (low == 0.0 || low == 1.0)) return low;
  return (w0.x * w0.y * low + w1.x * w1.y * high +
          w1.x * w0.y * texture(u_shadow_map, vec3(o1.x, o0.y, place.z)) +
          w0.x * w1.y * texture(u_shadow_map, vec3(o0.x, o1.y, place.z))) / 16.0;
}

// Light that a surface sends to the eye. color: linear; open: share of the sky that is seen past other bodies.
vec3 shade(vec3 normal, vec3 to_eye, vec3 color, float roughness, float metallic, float open, float sun) {
  Surface surface;
  surface.n_v = dot(normal, to_eye);
  surface.n_l = dot(normal, u_to_light);
  surface.l_v = dot(u_to_light, to_eye);
  surface.up = normal.y;
  surface.eye_up = to_eye.y;
  surface.diffuse = surface_diffuse(color, metallic);
  surface.f0 = surface_f0(color, metallic);
  surface.rough = surface_roughness(roughness);
  surface.veil = surface_veil(roughness, metallic);
  surface.open = open;
  surface.sun = sun;
#ifdef ENVIRONMENT
  surface.around = light_around(normal, u_around);
  surface.mirrored = light_mirrored(2.0 * surface.n_v * normal - to_eye, surface.rough.x);
  surface.sun_share = u_sun_share;
#endif
#ifdef LAMPS
  return shade(surface) + light_of_lamps(surface_place, normal, to_eye, surface);
#else
  return shade(surface);
#endif
}
`;
