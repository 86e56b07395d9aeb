// The fragment's side of body.vert, shared by all kinds of bodies.
in vec3 v_position;
#if !defined(BOX) || defined(PATTERNED)
in vec3 v_local;
#endif
#ifndef AWAY_FROM_SUN
in vec4 v_shadow;
#endif
in vec4 v_haze;
flat in vec4 v_orientation;
flat in vec4 v_scale;
flat in vec4 v_color;
flat in vec4 v_look;

layout(location = 0) out vec4 pixel;

#include "rotate.glsl"
#include "lighting.glsl"
#include "pattern.glsl"

// The share of the sky's light at a place in the atlas, in texture coordinates.
uniform sampler2D occlusion_atlas;

Surface body_surface(vec3 normal, vec3 albedo, float open) {
    Surface surface;
    surface.position = v_position;
    surface.to_eye = -normalize(v_position);
    surface.normal = normal;
#ifndef AWAY_FROM_SUN
    surface.shadow = v_shadow;
#endif
    surface.albedo = albedo;
    surface.roughness = v_color.w;
    surface.metallic = v_look.x;
    surface.open = open;
    surface.haze = v_haze;
    return surface;
}
