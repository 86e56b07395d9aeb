// Share of the light of number LAMP_SHADOW that is visible from a point.
uniform sampler2DShadow lamp_shadow_map;

// `place`: see lamp_shadow_place.glsl. Beyond the map, and behind a spot, nothing is in shadow.
float lamp_visible(vec4 place) {
    vec3 at = place.xyz / max(place.w, 1e-6) * 0.5 + 0.5;
    const float margin = 3.0 / LAMP_TEXELS;
    float outside = step(0.5 - margin, max(abs(at.x - 0.5), abs(at.y - 0.5))) + step(place.w, 0.0);
    float seen = kernel_shadow(lamp_shadow_map, vec2(1.0 / LAMP_TEXELS), vec3(at.xy * LAMP_TEXELS - 0.5, at.z));
    return mix(seen, 1.0, min(outside, 1.0));
}
