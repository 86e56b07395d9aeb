// Grid and checker patterns, averaged over the pixel in closed form: no jagged and no crawling lines.

float checker(vec2 p, vec2 width) {
    // Quilez 2017, Box-filtered checkerboard: the product of two filtered square waves of period 2
    width = pattern_blur * width + 1e-4;
    vec2 i = 2.0 * (abs(fract((p - 0.5 * width) * 0.5) - 0.5) - abs(fract((p + 0.5 * width) * 0.5) - 0.5)) / width;
    return 0.5 - 0.5 * i.x * i.y;
}

float grid(vec2 p, vec2 width, float line) {
    // Quilez 2017, Box-filtered grid: the share of the pixel on a line of the given width around the integers
    width = pattern_blur * width + 1e-4;
    p += 0.5 * line;
    vec2 a = p + 0.5 * width, b = p - 0.5 * width;
    vec2 i = (line * (floor(a) - floor(b)) + min(fract(a), line) - min(fract(b), line)) / width;
    return 1.0 - (1.0 - i.x) * (1.0 - i.y);
}

vec3 patterned(vec3 albedo, float pattern, vec3 local, vec3 local_normal, float cell) {
    // A body's pattern on the two axes that its face is turned to least (triplanar, unblended).
    vec3 a = abs(local_normal);
    vec2 p = (a.x > a.y && a.x > a.z ? local.yz : (a.y > a.z ? local.xz : local.xy)) / cell;
    vec3 spread = fwidth(local) / cell;
    vec2 width = a.x > a.y && a.x > a.z ? spread.yz : (a.y > a.z ? spread.xz : spread.xy);
    if (pattern > 1.5) return albedo * (1.0 - 2.0 * ground_contrast * checker(p, width));
    return albedo * (1.0 - grid_line_contrast * grid(p, width, 2.0 * grid_line_width));
}
