// The surface of water, as shaders/water.frag draws it. What lies behind it is tinted where it is drawn: see through_water().
import { frame_glsl, light_glsl, water_height_glsl } from "./shading_glsl.ts";

export const water_vertex_glsl = /* glsl */ `
${frame_glsl}
${water_height_glsl}
uniform vec2 u_foot;            // x, z below the eye, m
out vec3 v_world;
void main() {
  vec2 at = u_foot + position.xz;
  v_world = vec3(at.x, water_height(at), at.y);
  gl_Position = projectionMatrix * viewMatrix * vec4(v_world, 1.0);
}
`;

export const water_fragment_glsl = /* glsl */ `
${frame_glsl}
${light_glsl}
in vec3 v_world;
layout(location = 0) out highp vec4 pixel;
void main() {
  vec3 to_eye = cameraPosition - v_world, normal = vec3(0.0, 1.0, 0.0);
  float squared = dot(to_eye, to_eye), hidden = 0.0;    // mean square slope of waves narrower than the pixel
  to_eye *= inversesqrt(squared);
#ifdef WAVES
  vec2 dx = dFdx(v_world.xz), dy = dFdy(v_world.xz);
  for (int i = 0; i < WAVES; ++i) {
    vec2 k = u_waves[i].xy;
    float width = abs(dot(k, dx)) + abs(dot(k, dy)), slope = u_waves[i].z * length(k), left = exp2(-0.5 * width * width);
    normal.xz += u_waves[i].z * left * sin(dot(k, v_world.xz) + u_waves[i].w) * k;
    hidden += 0.5 * slope * slope * (1.0 - left * left);
  }
  normal = normalize(normal);
#endif
  if (!gl_FrontFacing) discard;                         // from within the water
  float n_v = dot(normal, to_eye);
  float grazing = 1.0 - min(sqrt(n_v * n_v + hidden), 1.0), grazing2 = grazing * grazing;
  float mirrors = water_reflectance + (1.0 - water_reflectance) * (grazing2 * grazing2 * grazing);
  vec3 mirrored = 2.0 * n_v * normal - to_eye;
  mirrored.y = abs(mirrored.y);                         // a ray into the next wave meets the sky after it
#ifdef ENVIRONMENT
  vec3 light = light_mirrored(mirrored, 0.0);
#else
  vec3 light = behind(mirrored);
#endif
  vec3 middle = normalize(u_to_light + to_eye);
  float n_l = clamp(dot(normal, u_to_light), 0.0, 1.0), edge = 1.0 - clamp(dot(middle, to_eye), 0.0, 1.0);
  float roughness = sqrt(sqrt(water_glint * water_glint + 2.0 * hidden)), edge2 = edge * edge;
  float lobe = min(specular_lobe(roughness, clamp(dot(normal, middle), 0.0, 1.0), max(n_l, 1e-3), max(n_v, 1e-3)), brightest_glint);
  vec3 glint = v_sun * (n_l * lobe * (water_reflectance + (1.0 - water_reflectance) * edge2 * edge2 * edge));
#ifdef ENVIRONMENT
  glint *= u_sun_share;
#endif
  // Shown colors are blended, not light: that of a layer with this opacity.
  float bright = min(max(glint.r, max(glint.g, glint.b)), 1.0), opacity = mirrors + (1.0 - mirrors) * bright;
  light = (mirrors * light + glint) / opacity;
#ifdef BACKGROUND
  float haze = haze_share(squared, u_fog);
#else
  float haze = fog_share(squared, u_fog);
#endif
  float all = 1.0 - (1.0 - opacity) * (1.0 - haze);
  light = mix(light, behind(-to_eye), haze / all);
  pixel = vec4(dithered(displayed(light)) * all, all);
}
`;
