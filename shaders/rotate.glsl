vec3 rotate(vec4 q, vec3 v) {
    // Hamilton 1844, q v q* with the products expanded: v + 2 w (u x v) + 2 u x (u x v)
    vec3 t = 2.0 * cross(q.xyz, v);
    return v + q.w * t + cross(q.xyz, t);
}

vec3 rotate_back(vec4 q, vec3 v) {
    vec3 t = 2.0 * cross(v, q.xyz);
    return v + q.w * t + cross(t, q.xyz);
}
