// The light of the program's own renderer (shaders/lighting.glsl and the files that it includes), in world axes: a page
// shows what a clip shows. Light is linear and relative: 1 on a white surface is paper white.

export const frame_glsl = /* glsl */ `
uniform vec3 u_to_light;        // unit
uniform vec3 u_sky_horizon, u_sky_zenith, u_sky_nadir;
uniform float u_sun_glow;       // factor on the glow of the sky around the sun
uniform float u_fog;            // 1 / squared distance at which fog is half of the light, 1/m^2
uniform float u_pixel_size;     // at distance 1
uniform mat4 u_shadow_matrix;   // world -> place in the shadow map, 0 to 1
uniform highp sampler2DShadow u_shadow_map;
uniform float u_shadow_size;    // texels
uniform float u_shadow_texel;   // m; 0 without shadows

vec3 rotate(vec4 q, vec3 v) {   // q: x, y, z, w
  vec3 t = 2.0 * cross(q.xyz, v);
  return v + q.w * t + cross(q.xyz, t);
}
`;

export const light_glsl = /* glsl */ `
const vec3 sun_light = vec3(0.80, 0.745, 0.655);
const vec3 sky_light = vec3(0.325, 0.365, 0.435);
const vec3 bounce_light = vec3(0.195, 0.185, 0.170);
const vec3 lit_horizon = vec3(0.80, 0.86, 0.92);   // mirrored by surfaces, in each theme
const vec3 lit_zenith = vec3(0.20, 0.38, 0.66);
const vec3 lit_nadir = vec3(0.33, 0.39, 0.48);
const vec3 sun_glow = vec3(0.30, 0.24, 0.14);

vec3 sky(float height, float toward_sun) {
  float up = max(height, 0.0), down = max(-height, 0.0);
  float above = 1.0 - 1.0 / (1.0 + 5.0 * up * (1.0 + up));
  float below = 1.0 - 1.0 / (1.0 + 5.0 * down);
  toward_sun = max(toward_sun, 0.0);
  toward_sun *= toward_sun;
  toward_sun *= toward_sun;
  return mix(mix(u_sky_horizon, u_sky_zenith, above), u_sky_nadir, below) + u_sun_glow * sun_glow * (toward_sun * toward_sun);
}

vec3 displayed(vec3 light) {
  vec3 s = sqrt(max(light, 0.0));
  vec3 rise = s * s * (21.217153 + s * (-35.617540 + s * 32.353397));
  return rise / (1.0 + s * (7.989843 + s * (8.709465 + s * (-30.195670 + s * 31.746583))));
}

// Jimenez 2014: noise that hides the bands of flat gradients, half a level up and down.
vec3 dithered(vec3 shown) {
  return shown + (fract(52.9829189 * fract(dot(gl_FragCoord.xy, vec2(0.06711056, 0.00583715)))) - 0.5) / 255.0;
}

float fog_share(float squared) {
  float relative = squared * u_fog;
  relative *= relative;
  return relative / (1.0 + relative);
}

vec3 in_fog(vec3 light, vec3 to_eye, float squared) {
  float share = fog_share(squared);
  return share < 1e-3 ? light : mix(light, sky(-to_eye.y, -dot(to_eye, u_to_light)), share);
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

vec3 blurred_sky(float height, float rough) {
  float above = clamp(0.5 + height * 0.5 / (0.15 + rough), 0.0, 1.0);
  above = above * above * (3.0 - 2.0 * above);
  vec3 upper = mix(lit_horizon, lit_zenith, max(height, 0.0) * (1.0 - 0.5 * rough));
  return mix(lit_nadir * 0.6, upper, above);
}

// Light that a surface sends to the eye. color: linear; open: share of the sky that is seen past other bodies.
vec3 shade(vec3 normal, vec3 to_eye, vec3 color, float paint, float roughness, float metallic, float open, float sun) {
  vec3 diffuse = color * (1.0 - metallic), f0 = mix(vec3(0.04), color, metallic);
  float rough = max(roughness, 0.06);
  float veil = mix(1.0, mix(0.2, 1.0, metallic), rough);
  float facing = dot(normal, to_eye), n_v = clamp(facing, 1e-3, 1.0), n_l = clamp(dot(normal, u_to_light), 0.0, 1.0);
  vec3 light = diffuse * (mix(bounce_light, sky_light, 0.5 + 0.5 * normal.y) * open);
  float l_v = dot(u_to_light, to_eye);
  float per_half = inversesqrt(max(2.0 + 2.0 * l_v, 1e-6));
  float n_h = clamp((dot(normal, u_to_light) + facing) * per_half, 0.0, 1.0);
  float grazing = 1.0 - clamp((1.0 + l_v) * per_half, 0.0, 1.0);
  float grazing2 = grazing * grazing;
  vec3 fresnel = f0 + (1.0 - f0) * (grazing2 * grazing2 * grazing);
  float a = rough * rough, a2 = a * a, d = n_h * n_h * (a2 - 1.0) + 1.0;
  float lobe = min(0.5 * a2 / (d * d * mix(2.0 * n_l * n_v, n_l + n_v, a)), 16.0);
  light += (diffuse + fresnel * lobe) * (sun_light * (n_l * (0.75 + 0.25 * open) * sun));
  vec4 r = rough * vec4(-1.0, -0.0275, -0.572, 0.022) + vec4(1.0, 0.0425, 1.04, -0.04);
  float e = min(r.x * r.x, exp2(-9.28 * n_v)) * r.x + r.y;
  vec2 environment = vec2(-1.04, 1.04) * e + r.zw;
  light += blurred_sky(2.0 * facing * normal.y - to_eye.y, rough) * (f0 * environment.x + environment.y) * (open * veil);
  return light * paint;
}
`;

export const pattern_glsl = /* glsl */ `
// Quilez 2017: box-filtered checkerboard and grid.
float checker(vec2 p, vec2 width) {
  width = 1.4 * width + 1e-4;
  vec2 i = 2.0 * (abs(fract((p - 0.5 * width) * 0.5) - 0.5) - abs(fract((p + 0.5 * width) * 0.5) - 0.5)) / width;
  return 0.5 - 0.5 * i.x * i.y;
}

float grid(vec2 p, vec2 width, float line) {
  width = 1.4 * width + 1e-4;
  p += 0.5 * line;
  vec2 a = p + 0.5 * width, b = p - 0.5 * width;
  vec2 i = (line * (floor(a) - floor(b)) + min(fract(a), line) - min(fract(b), line)) / width;
  return 1.0 - (1.0 - i.x) * (1.0 - i.y);
}

float pattern_paint(float kind, vec2 p, vec2 width) {
  return kind > 1.5 ? 1.0 - 0.26 * checker(p, width) : 1.0 - 0.30 * grid(p, width, 0.044);
}

float triplanar_paint(float kind, float cell, vec3 local, vec3 normal) {
  vec3 a = abs(normal);
  bool along_x = a.x > a.y && a.x > a.z, along_y = a.y > a.z;
  vec3 spread = fwidth(local);
  vec2 p = along_x ? local.yz : along_y ? local.xz : local.xy;
  vec2 width = along_x ? spread.yz : along_y ? spread.xz : spread.xy;
  return pattern_paint(kind, p / cell, width / cell);
}
`;
