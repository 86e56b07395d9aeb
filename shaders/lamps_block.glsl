// Several lights. World axes, relative to the eye (render/passes/lamp_uniforms.h).
layout(std140) uniform Lamps {
    vec4 sun_color;             // irradiance over pi of the sun of lighting.glsl
    vec4 lamp_place[4];         // m, of a point or spot; of a sun the unit vector to it; w: its kind
    vec4 lamp_light[4];
    vec4 lamp_axis[4];          // of a spot: direction in which it shines; w: cosine of half its angle
    vec4 lamp_map[4];           // rows: relative position -> clip space of the shadow map of light LAMP_SHADOW
    vec4 lamp_bias;             // of it: shift along the normal, m at w = 1; shift of z towards the light
};
