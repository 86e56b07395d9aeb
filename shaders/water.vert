#version 410 core
// The surface of [water] as a grid that is fine near the eye; EYE_BELOW: the whole screen, seen from within the water.
#include "frame.glsl"
#include "light_constants.glsl"
#if defined(ENVIRONMENT) || defined(BACKGROUND)
#include "environment_block.glsl"
#include "environment.glsl"
#endif
#ifdef LAMP_LIGHT
#include "lamps_block.glsl"
flat out vec3 v_sun;
#endif

layout(location = 0) in vec3 corner;    // m, world axes, from the eye; EYE_BELOW: clip space

uniform vec4 water_color;               // linear; w: near distance of the camera, m
uniform vec4 water_place;               // height of the eye above the level, m; width, height of the image, pixels
#ifdef WAVES
uniform vec4 wave_phases[4];            // rad, at the eye
flat out vec4 v_phases[4];
#endif

flat out vec4 v_water;                  // color of deep water in light; near distance
flat out vec4 v_absorbed;               // share of light per meter, as exponent; height of the eye
flat out vec4 v_to_light;               // w: fog
#ifdef ENVIRONMENT
flat out vec3 v_sun_share;
#endif
#ifdef BACKGROUND
flat out vec4 v_low, v_high;            // see background()
#endif
#ifdef REFLECTIVE
flat out vec3 v_clip_x, v_clip_y, v_clip_w;     // direction -> clip space
#endif
out vec3 v_at;                          // m, from the eye

void main() {
#ifdef EYE_BELOW
    vec2 pixel = (0.5 + 0.5 * corner.xy) * water_place.yz;
    v_at = ray_origin.xyz + pixel.x * ray_dx.xyz + pixel.y * ray_dy.xyz;
    gl_Position = vec4(corner, 1.0);
#else
    v_at = corner;
    gl_Position = clip_from_relative * vec4(corner, 1.0);
#endif
    vec3 sun = sun_light;
#ifdef LAMP_LIGHT
    v_sun = sun_color.rgb;
    sun = v_sun;
#endif
    vec3 light = sky_light;
#ifdef ENVIRONMENT
    vec3 c[9];
    for (int i = 0; i < 9; ++i) c[i] = around[i].rgb;
    light = light_around(vec3(0.0, 1.0, 0.0), c);
    v_sun_share = sun_share.rgb;
    sun *= v_sun_share;
#endif
    v_water = vec4(water_color.rgb * (light + sun * max(to_light.y, 0.0)), water_color.w);
    v_absorbed = vec4(-log(max(water_color.rgb, 0.004)) / water_clear_way, water_place.x);
    v_to_light = vec4(to_light.xyz, fog_density);
#ifdef REFLECTIVE
    mat4 rows = transpose(clip_from_relative);
    v_clip_x = rows[0].xyz;
    v_clip_y = rows[1].xyz;
    v_clip_w = rows[3].xyz;
#endif
#ifdef WAVES
    v_phases = wave_phases;
#endif
#ifdef BACKGROUND
    v_low = background_low;
    v_high = background_high;
#endif
}
