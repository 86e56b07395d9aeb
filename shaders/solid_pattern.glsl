// Patterns of two colors, by the place p in cells: shares of the second color, averaged over the pixel. Stripes, dots,
// rings and veins are averaged in closed form; noise has only the octaves that are wider than the pixel (Norton,
// Rockwood and Skolmoski 1982, Clamping: A Method of Antialiasing Textured Surfaces by Bandwidth Limiting).

const float dot_radius = 0.3;                  // of a cell
const float ring_late = 0.86;                  // of a ring of wood: where late wood is darkest
const float ring_mean = 1.0 / 3.0, vein_mean = 1.0 / 9.0;

// Mean of a wave of period 1 that is 1 from 0 to `on` and 0 up to 1.
float band(float x, float width, float on) {
    width = pattern_blur * width + 1e-4;
    float a = x - 0.5 * width, b = x + 0.5 * width;
    return (on * (floor(b) - floor(a)) + min(fract(b), on) - min(fract(a), on)) / width;
}

float dots(vec2 p, vec2 width) {
    float footprint = pattern_blur * max(width.x, width.y) + 1e-4;
    float from_rim = dot_radius - length(fract(p) - 0.5);
    float sharp = clamp(from_rim / footprint + 0.5, 0.0, 1.0);
    return mix(sharp, 3.14159265 * dot_radius * dot_radius, clamp(2.0 * footprint - 0.5, 0.0, 1.0));
}

float random_at(ivec3 cell) {
    uvec3 c = uvec3(cell);
    uint h = c.x * 0x8da6b343u ^ c.y * 0xd8163841u ^ c.z * 0xcb1ab31fu;
    h = (h ^ h >> 15) * 0x2c1b3c6du;
    h = (h ^ h >> 12) * 0x297a2d39u;
    return float((h ^ h >> 15) >> 8) * (1.0 / 16777216.0);
}

// Perlin 2002, Improving Noise: values at the corners of cells, blended by a polynomial of degree 5. Mean 0.5.
float value_noise(vec3 p) {
    vec3 low = floor(p), f = p - low;
    ivec3 c = ivec3(low);
    f = f * f * f * (f * (f * 6.0 - 15.0) + 10.0);
    vec4 front = vec4(random_at(c), random_at(c + ivec3(1, 0, 0)), random_at(c + ivec3(0, 1, 0)), random_at(c + ivec3(1, 1, 0)));
    vec4 back = vec4(random_at(c + ivec3(0, 0, 1)), random_at(c + ivec3(1, 0, 1)), random_at(c + ivec3(0, 1, 1)),
                     random_at(c + ivec3(1, 1, 1)));
    vec4 along_z = mix(front, back, f.z);
    vec2 along_y = mix(along_z.xy, along_z.zw, f.y);
    return mix(along_y.x, along_y.y, f.x);
}

// Share of noise whose cells are so many pixels apart that it is drawn; the rest is its mean.
float distinct_noise(float width) { return clamp(1.5 - 2.0 * width, 0.0, 1.0); }

// Each octave has half the cells and 0.55 of the height of the one before. Mean 0.5, about 0.2 to 0.8.
float octaves(vec3 p, float width, int count) {
    float sum = 0.0, height = 0.5, all = 0.0;
    for (int i = 0; i < count; ++i) {
        float drawn = distinct_noise(width);
        if (drawn > 0.0) sum += height * drawn * (value_noise(p) - 0.5);
        all += height;
        height *= 0.55;
        width *= 2.0;
        p = 2.0 * p + vec3(17.3, 5.7, 11.1);
    }
    return 0.5 + sum / all;
}

// Integral of a ring's profile: early wood darkens slowly to late wood, which ends at once.
float ring_integral(float x) {
    float f = fract(x), rest = 1.0 - ring_late, up = min(f, ring_late), down = 1.0 - max(f, ring_late);
    float inside = up * up * up / (3.0 * ring_late * ring_late) + (rest * rest * rest - down * down * down) / (3.0 * rest * rest);
    return floor(x) * ring_mean + inside;
}

// Integral of |1 - 2 f|^8: thin veins at whole numbers.
float vein_integral(float x) {
    float s = 1.0 - 2.0 * fract(x), s2 = s * s, s4 = s2 * s2;
    return floor(x) * vein_mean + (1.0 - s4 * s4 * s) / 18.0;
}

float veins(float x, float width) {
    width = pattern_blur * width + 1e-3;
    return (vein_integral(x + 0.5 * width) - vein_integral(x - 0.5 * width)) / width;
}

// The trunk runs along x, beside the body, so that boards show arcs and not a target.
float wood(vec3 p, float width) {
    vec3 slow = p * vec3(0.12, 0.4, 0.4);
    vec2 bent = vec2(value_noise(slow), value_noise(slow + 31.7)) - 0.5;
    float growth = 0.5 * value_noise(vec3(0.25 * p.x, p.yz));
    float rings = 1.7 * (length(p.yz + vec2(1.3, 4.1) + 1.1 * bent) + growth);
    float wide = pattern_blur * min(1.9 * width, 4.0) + 1e-3;
    float ring = (ring_integral(rings + 0.5 * wide) - ring_integral(rings - 0.5 * wide)) / wide;
    float grain = value_noise(p * vec3(1.1, 21.0, 21.0)) + value_noise(p * vec3(0.6, 9.0, 9.0) + 3.1) - 1.0;
    return clamp(0.10 + 0.78 * ring + 0.16 * grain * distinct_noise(12.0 * width), 0.0, 1.0);
}

float marble(vec3 p, float width) {
    float turbulence = octaves(0.5 * p, 0.5 * width, 5), fine = octaves(p + 40.3, width, 4);
    float first = 0.3 * dot(p, vec3(0.72, 0.5, 0.48)) + 2.6 * (turbulence - 0.5);
    float second = 0.45 * dot(p, vec3(-0.5, 0.62, 0.6)) + 2.4 * (fine - 0.5);
    float steep = 1.5 * width;                 // noise makes veins steeper than the direction alone
    float clouds = clamp(2.2 * (turbulence - 0.38), 0.0, 1.0);
    return clamp(1.05 * veins(first, steep) + 0.6 * veins(second, steep) * clouds + 0.3 * clouds * clouds, 0.0, 1.0);
}

// Share of the second color in a pattern of this kind (Pattern of scene/description/description.h: 1 grid to 8 marble).
// `on_face`: the place on the flat or nearly flat surface around the pixel, for grids, checkers and dots; `band_at`: along
// the stripes' normal.
float second_share(int kind, vec3 p, vec3 width, vec2 on_face, vec2 face_width, float band_at, float band_width) {
    float widest = max(width.x, max(width.y, width.z));
    if (kind == 1) return grid(on_face, face_width, 2.0 * grid_line_width);
    if (kind == 2) return checker(on_face, face_width);
    if (kind == 4) return band(band_at + 0.25, band_width, 0.5);
    if (kind == 5) return dots(on_face + 0.5, face_width);
    if (kind == 6) return clamp(0.5 + 1.7 * (octaves(p, widest, 4) - 0.5), 0.0, 1.0);
    if (kind == 7) return wood(p, widest);
    return marble(p, widest);
}

// On a body. Stripes are bands around y, and across a flat top; wood grows along the longest axis of a box.
float body_share(int kind, vec3 p, vec3 width, vec3 normal, vec3 size) {
    vec3 a = abs(normal);
    bool along_x = a.x > a.y && a.x > a.z, along_y = a.y > a.z;
    vec2 on_face = along_x ? p.yz : along_y ? p.xz : p.xy;
    vec2 face_width = along_x ? width.yz : along_y ? width.xz : width.xy;
    bool top = a.y > 0.999 && fwidth(normal.x) + fwidth(normal.z) < 1e-6;
    float band_at = top ? p.x : p.y, band_width = top ? width.x : width.y;
    if (kind == 7 && size.y > size.x && size.y >= size.z) { p = p.yzx; width = width.yzx; }
    else if (kind == 7 && size.z > size.x && size.z > size.y) { p = p.zxy; width = width.zxy; }
    return second_share(kind, p, width, on_face, face_width, band_at, band_width);
}

// On a ball, whose dots lie on the six faces of a cube around it, and close there.
float ball_share(int kind, vec3 p, vec3 width, vec3 direction) {
    vec3 a = abs(direction);
    bool along_x = a.x > a.y && a.x > a.z, along_y = a.y > a.z;
    vec3 d = along_x ? direction.yzx : along_y ? direction.xzy : direction;
    float radius = length(p);
    float cells = max(1.0, floor(1.5707963 * radius + 0.5));          // across a face of the cube
    vec2 on_face = cells * (0.5 + 0.63661977 * atan(d.xy / d.z));
    float widest = max(width.x, max(width.y, width.z));
    if (kind == 5) on_face -= 0.5;                                    // second_share() centers a dot on 0
    return second_share(kind, p, width, on_face, vec2(widest), p.y, width.y);
}
