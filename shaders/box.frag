#version 410 core
#include "body.glsl"

in vec2 v_on_face;                  // m, from the center of the face along its axes
flat in vec4 v_face;                // m: half the size of the face; the same without the bevel's width
flat in vec4 v_tile;                // place of the face's center in the AO atlas, and the scale per meter along its axes
flat in vec3 v_edges;               // m: bevel, distance of the groove from the edge, half width of the groove

#ifdef IMAGE
flat in vec4 v_image_axes;          // images per meter along the axes of the face
#endif
#ifdef TWO_COLORS
in vec3 v_local;                    // m
flat in vec3 v_outward;
#endif

#if !defined(PATTERNED) && !defined(PLAIN)
// Share of the pixel in the groove between the frame and the panel of a box.
float groove(vec2 on_face) {
    vec2 to_edges = v_face.xy - abs(on_face);
    float edge = min(to_edges.x, to_edges.y);
    float per_footprint = 1.0 / max(fwidth(edge), 1e-6);
    float off = abs(edge - v_edges.y);
    return clamp((v_edges.z - off) * per_footprint + 0.5, 0.0, 1.0) * min(2.0 * v_edges.z * per_footprint, 1.0);
}
#endif

void main() {
    // OpenGL rounds corners to parts of a pixel, and with several samples the pixel center may be outside the face: for
    // a thin face by many times its width, on the tile of another face. Clamp to the box.
    vec2 on_face = clamp(v_on_face, -v_face.xy, v_face.xy);
    // Normal of a rounded box: direction away from the box that is smaller by the bevel.
    // It is the mean over one and a half pixels as far as they are on the face: at a low angle a bevel is narrower than a
    // pixel, and pixel centers would hit it in dashes.
    vec2 wide = max(0.75 * fwidth(v_on_face), 1e-4 * v_face.xy);
    vec2 low = max(on_face - wide, -v_face.xy), high = min(on_face + wide, v_face.xy);
    vec2 a = max(high - v_face.zw, 0.0), b = max(low - v_face.zw, 0.0);
    vec2 c = max(-low - v_face.zw, 0.0), d = max(-high - v_face.zw, 0.0);
    vec3 normal = vec3((a * a - b * b - c * c + d * d) / (2.0 * (high - low)), v_edges.x);
    vec2 spread = vec2(0.0);
#ifdef FILTERED
    // Variance of the normal's tilt over the pixel: the mean of the square less the square of the mean. GGX's squared
    // width is twice the variance of slopes.
    vec2 footprint = 0.5 * max(fwidth(v_on_face), 1e-4 * v_edges.xx), bent = abs(on_face) - v_face.zw;
    vec2 inner = max(bent - footprint, 0.0), outer = max(bent + footprint, 0.0);
    vec2 mean = (outer * outer - inner * inner) / (4.0 * footprint);
    vec2 squares = (outer * outer * outer - inner * inner * inner) / (6.0 * footprint);
    spread = bevel_blur * 2.0 * max(squares - mean * mean, 0.0) / dot(normal, normal);
#endif
    normal *= inversesqrt(dot(normal, normal));
#ifdef PATTERNED
    float paint = pattern_paint(v_pattern.x, on_face / v_pattern.y, fwidth(v_on_face) / v_pattern.y);
#elif defined(PLAIN)
    float paint = 1.0;
#else
    float paint = 1.0 - crate_groove_depth * groove(v_on_face);
#endif
    vec3 diffuse = v_diffuse;
#ifdef TWO_COLORS
    float share = body_share(TWO_COLORS, v_local / v_cells.w, fwidth(v_local) / v_cells.w, v_outward, v_cells.xyz);
    diffuse = colored(mix(v_color, v_second.rgb, share));
#endif
#ifdef IMAGE
    vec2 place = 0.5 + on_face.x * v_image_axes.xy + on_face.y * v_image_axes.zw;
    vec2 along_x = dFdx(v_on_face), along_y = dFdy(v_on_face);
    float level = texture_level((along_x.x * v_image_axes.xy + along_x.y * v_image_axes.zw) * v_image,
                                (along_y.x * v_image_axes.xy + along_y.y * v_image_axes.zw) * v_image);
#ifdef WITH_MAPS
    vec2 right = vec2(v_image_axes.x, v_image_axes.z), down = vec2(v_image_axes.y, v_image_axes.w);
    read_maps(place, vec2(dot(along_x, right), dot(along_x, down)), vec2(dot(along_y, right), dot(along_y, down)));
#ifdef NORMAL_MAP
    normal = bent_normal(vec3(normalize(right), 0.0), vec3(-normalize(down), 0.0), normal);
#endif
#endif
    diffuse = colored(v_color * texel_at(mesh_texture, place, level));
#endif
    float open = textureLod(occlusion_atlas, v_tile.xy + on_face * v_tile.zw, 0.0).r;
    pixel = body_pixel(vec3(on_face, 0.0), normal, diffuse, paint, open, spread);
#ifdef TRANSLUCENT
    pixel_share = vec4(hidden_share(v_glow.w));
#endif
}
