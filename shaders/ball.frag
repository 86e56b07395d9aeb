#version 410 core
#include "body.glsl"

in vec3 v_local;                    // m, from the ball's center
flat in vec4 v_tile;                // center of its tile in the AO atlas, and half of the tile's width and height
#if !defined(PATTERNED) && !defined(PLAIN)
flat in vec4 v_octants;             // on every second octant: added diffuse color; w: reduction of all light
#endif

// 1 on every second octant, 0 on the others, filtered over the pixel: shows the ball's rotation.
float octant(vec3 direction) {
    vec3 side = clamp(direction / max(fwidth(direction), vec3(1e-6)), -1.0, 1.0);
    return 0.5 + 0.5 * side.x * side.y * side.z;
}

vec2 octahedral(vec3 n) {
    // Meyer et al. 2010, On Floating-Point Normal Vectors: octahedral map
    vec2 p = n.xy / (abs(n.x) + abs(n.y) + abs(n.z));
    vec2 folded = (1.0 - abs(p.yx)) * vec2(p.x >= 0.0 ? 1.0 : -1.0, p.y >= 0.0 ? 1.0 : -1.0);
    return n.z >= 0.0 ? p : folded;
}

void main() {
    vec3 direction = normalize(v_local), normal = direction;
    float open = textureLod(occlusion_atlas, v_tile.xy + octahedral(direction) * v_tile.zw, 0.0).r;
    vec3 diffuse = v_diffuse;
#ifdef PATTERNED
    float paint = triplanar_paint(v_pattern, v_local, direction);
#elif defined(PLAIN)
    float paint = 1.0;
#else
    float octants = octant(direction);
    diffuse += octants * v_octants.rgb;
    float paint = 1.0 - octants * v_octants.w;
#endif
#ifdef TWO_COLORS
    diffuse = colored(mix(v_color, v_second.rgb, ball_share(TWO_COLORS, v_local / v_cells.w, fwidth(v_local) / v_cells.w, direction)));
#endif
#ifdef IMAGE
    vec2 footprint = footprint_on_ball(direction, max(abs(dFdx(direction)), abs(dFdy(direction))), v_second.xy) * v_image;
    vec3 texel = texel_at(mesh_texture, place_on_ball(direction, v_second.xy), log2(max(max(footprint.x, footprint.y), 1e-6)));
#ifdef WITH_MAPS
    vec2 images = footprint / v_image;
    read_maps(place_on_ball(direction, v_second.xy), log2(max(max(images.x, images.y), 1e-9)));
#ifdef NORMAL_MAP
    vec3 right = vec3(direction.z, 0.0, -direction.x) * inversesqrt(max(dot(direction.xz, direction.xz), 1e-12));
    normal = bent_normal(right, cross(direction, right), direction);
#endif
#endif
    diffuse = colored(v_color * texel);
#endif
    pixel = body_pixel(v_local, normal, diffuse, paint, open, vec2(0.0));
#ifdef TRANSLUCENT
    pixel_share = vec4(hidden_share(v_glow.w));
#endif
}
