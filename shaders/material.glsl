// Material terms that the vertex shader computes once for lighting.glsl.

// 1: the effective roughness; 2: slope of the blurred horizon over the height.
vec2 surface_roughness(float roughness) {
    float r = max(roughness, 0.06);   // below it, the sun's highlight is smaller than a pixel and flickers
    return vec2(r, 0.5 / (0.15 + r));
}

// Share of the mirrored sky that is left.
float surface_veil(float roughness, float metallic) {
    return mix(1.0, mix(veil_of_rough, 1.0, metallic), max(roughness, 0.06));
}

vec3 surface_diffuse(vec3 color, float metallic) { return color * (1.0 - metallic); }
vec3 surface_f0(vec3 color, float metallic) { return mix(vec3(dielectric_reflectance), color, metallic); }
