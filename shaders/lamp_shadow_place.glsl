// Vertex counterpart of lamp_shadow.glsl.

// The vector to the light from a point, of any length.
vec3 to_shadow_lamp(vec3 position) {
    return lamp_place[LAMP_SHADOW].xyz - (lamp_place[LAMP_SHADOW].w > 0.0 ? position : vec3(0.0));
}

vec4 on_lamp_map(vec4 point) {
    return vec4(dot(lamp_map[0], point), dot(lamp_map[1], point), dot(lamp_map[2], point), dot(lamp_map[3], point));
}

// Place of a point in the shadow map, clip space, with the shifts of shadow_place.glsl. It is linear in the position.
vec4 lamp_shadow_place(vec3 position, vec3 face_normal) {
    vec4 place = on_lamp_map(vec4(position, 1.0));
    return place + on_lamp_map(vec4(face_normal, 0.0)) * (lamp_bias.x * place.w) - vec4(0.0, 0.0, lamp_bias.y, 0.0);
}
