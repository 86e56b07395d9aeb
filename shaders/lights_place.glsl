// Vertex counterpart of lights.glsl.
#include "lamps_block.glsl"
flat out vec3 v_sun;
#ifdef LAMPS
flat out vec3 v_lamp_place[LAMPS];
flat out vec3 v_lamp_light[LAMPS];
#ifdef SPOTS
flat out vec4 v_lamp_axis[LAMPS];
#endif
#endif
#ifdef LAMP_SHADOW
#include "lamp_shadow_place.glsl"
#endif

// `eye`: position of the eye in the axes of the surface; `rows`: these axes.
void place_lamps(vec3 eye, mat3 axes) {
    v_sun = sun_color.rgb;
#ifdef LAMPS
    for (int i = 0; i < LAMPS; ++i) {
        v_lamp_place[i] = lamp_place[i].xyz * axes + (lamp_place[i].w > 0.0 ? eye : vec3(0.0));
        v_lamp_light[i] = lamp_light[i].rgb;
#ifdef SPOTS
        v_lamp_axis[i] = vec4(lamp_axis[i].xyz * axes, lamp_axis[i].w);
#endif
    }
#endif
}
