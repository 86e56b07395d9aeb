#version 410 core
// Shadows of what light passes: holes of textures, and translucent bodies.
flat in float v_shade;              // opacity
#ifdef PAINTED
uniform sampler2D mesh_texture;
in vec2 v_uv;
flat in vec2 v_image;               // size of the texture, texels
flat in float v_hole;               // alpha below which is a hole; below 0: alpha multiplies the opacity
#endif

void main() {
    float shade = v_shade;
#ifdef PAINTED
    vec2 along_x = dFdx(v_uv) * v_image, along_y = dFdy(v_uv) * v_image;
    float level = 0.5 * log2(max(max(dot(along_x, along_x), dot(along_y, along_y)), 1e-12));
    float alpha = textureLod(mesh_texture, v_uv, level).a;
    if (alpha < v_hole) discard;
    if (v_hole < 0.0) shade *= alpha;
#endif
    // A part of the texels casts the shadow, in squares of three texels, which is the width of the filter of shadow.glsl.
    ivec2 at = ivec2(gl_FragCoord.xy) % 3;
    const int ranks[9] = int[9](0, 5, 7, 3, 8, 2, 6, 1, 4);
    if (float(ranks[at.y * 3 + at.x]) + 0.5 > shade * 9.0) discard;
}
