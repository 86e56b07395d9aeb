// Values of environment.glsl, for vertex shaders, which hand them on (filled in by render/environment).
layout(std140) uniform Environment {
    vec4 around[9];             // see light_around()
    vec4 background_low;        // see background()
    vec4 background_high;
    vec4 sun_share;             // factor on the light of the sun
};
