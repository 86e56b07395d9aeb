// Grid and checker patterns, averaged over the pixel in closed form: lines neither jagged nor flickering.

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

// Factor of a body's pattern of this kind (Instance::pattern: 1 grid, 2 checker) on its color.
float pattern_paint(float kind, vec2 p, vec2 width) {
    return kind > 1.5 ? 1.0 - 2.0 * ground_contrast * checker(p, width)
                      : 1.0 - grid_line_contrast * grid(p, width, 2.0 * grid_line_width);
}

float triplanar_paint(vec2 pattern, vec3 local, vec3 local_normal) {
    // On the two axes most nearly in the plane of its face, without blending.
    vec3 a = abs(local_normal);
    bool along_x = a.x > a.y && a.x > a.z, along_y = a.y > a.z;
    vec3 spread = fwidth(local);
    vec2 p = along_x ? local.yz : along_y ? local.xz : local.xy;
    vec2 width = along_x ? spread.yz : along_y ? spread.xz : spread.xy;
    return pattern_paint(pattern.x, p / pattern.y, width / pattern.y);
}
