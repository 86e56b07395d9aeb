#version 410 core
#include "body.glsl"
#ifdef PAINTED

uniform sampler2D mesh_texture;
in vec3 v_paint;                    // color of the file, without its texture
in vec2 v_uv;
flat in vec2 v_image;               // size of the texture, texels
flat in vec3 v_emission;
flat in vec2 v_surface;             // metallic; least alpha
#ifdef TRANSLUCENT
flat in float v_opacity;
#endif

// The texture at the mip map whose texels have about the size of the pixel: linear light and alpha.
vec4 painted() {
    vec2 along_x = dFdx(v_uv) * v_image, along_y = dFdy(v_uv) * v_image;
    float level = 0.5 * log2(max(max(dot(along_x, along_x), dot(along_y, along_y)), 1e-12));
    vec4 texel = textureLod(mesh_texture, v_uv, level);
    return vec4(texel.rgb * texel.rgb, texel.a);   // its values are square roots
}
#endif

in vec3 v_local;                    // m
in vec3 v_normal;
#ifdef CHARTED
in vec2 v_texel;
#else
in float v_open;
#endif

void main() {
    vec3 normal = normalize(v_normal);
    normal = gl_FrontFacing ? normal : -normal;   // the inside of an open mesh is visible
    float paint = 1.0;
    vec3 diffuse = v_diffuse;
#ifdef PAINTED
    vec4 texel = painted();
    if (texel.a < v_surface.y) discard;
    vec3 color = v_paint * texel.rgb;
    float metallic = v_surface.x;
    paint_emission = v_emission;
#ifdef WITH_MAPS
    read_maps(v_uv, dFdx(v_uv), dFdy(v_uv));
    metallic = map_metallic;
#ifdef NORMAL_MAP
    normal = bent_normal(v_local, v_uv, normal);
#endif
#ifdef EMISSION_MAP
    paint_emission *= map_emission;
#endif
#endif
    diffuse = surface_diffuse(color, metallic);
    paint_f0 = surface_f0(color, metallic);
#endif
#ifdef TWO_COLORS
    float share = body_share(TWO_COLORS, v_local / v_cells.w, fwidth(v_local) / v_cells.w, normal, vec3(1.0));
#ifdef PAINTED
    diffuse = colored(mix(color, v_second.rgb, share));
#else
    diffuse = colored(mix(v_color, v_second.rgb, share));
#endif
#endif
#ifdef PATTERNED
    paint = triplanar_paint(v_pattern, v_local, normal);
#endif
#ifdef CHARTED
    float open = textureLod(occlusion_atlas, v_texel, 0.0).r;
#else
    float open = v_open;
#endif
    open = gl_FrontFacing ? open : 1.0;           // occluders near the outer side do not apply to the inner side
    pixel = body_pixel(v_local, normal, diffuse, paint, open, vec2(0.0));
#ifdef TRANSLUCENT
    float share = v_glow.w;
#ifdef PAINTED
    share *= v_opacity * (v_surface.y < 0.0 ? texel.a : 1.0);
    if (share < 0.004) discard;     // less than a level
#endif
    pixel_share = vec4(hidden_share(share));
#endif
}
