#version 410 core
// Compiled for each kind of body. Defines: BOX, BALL or MESH; CHARTED for meshes with a lightmap; SUNLIT for surfaces
// that may face the sun; PLAIN for surfaces of one color, with TWO_COLORS of a pattern, with IMAGE of a texture; SHADOWED
// for surfaces that may receive shadows; SPANS_CASCADES for bodies that span cascades.
#include "frame.glsl"
#include "instance.glsl"
#include "light_constants.glsl"
#include "sky.glsl"
#include "material.glsl"
#if defined(ENVIRONMENT) || defined(BACKGROUND)
#include "environment_block.glsl"
#include "environment.glsl"
#endif
#include "shadow_place.glsl"

#if defined(MESH) && !defined(CHARTED)
uniform sampler2D occlusion_atlas;
#endif

#ifdef LAMP_LIGHT
#include "lights_place.glsl"
#endif
#if defined(NORMAL_MAP) || defined(SURFACE_MAP) || defined(EMISSION_MAP)
#define WITH_MAPS
#include "surface_maps_place.glsl"
#endif
#ifdef GLOWING
flat out vec4 v_glow;               // emission, linear; opacity
#endif

out vec3 v_air;                     // light of the sky behind the body
#ifdef SUNLIT
flat out vec3 v_to_light;
#endif
#ifdef SHADOWED
#ifdef SPANS_CASCADES
out vec3 v_in_near;                 // place in each shadow map
out vec3 v_in_far;
#else
out vec4 v_shadow;                  // place in the shadow maps
#endif
#endif
#ifdef LAMP_SHADOW
out vec4 v_lamp_shadow;             // see lamp_shadow_place()
#endif
flat out vec4 v_eye;                // see body.glsl
#ifdef ENVIRONMENT
flat out vec3 v_east, v_south;
flat out vec3 v_around[9];
flat out vec3 v_sun_share;
#endif
flat out vec3 v_up;
flat out vec3 v_diffuse;
flat out vec3 v_f0;
flat out vec4 v_rough;
#ifdef PATTERNED
flat out vec2 v_pattern;
#endif
#ifdef BOX
#ifdef IMAGE
flat out vec4 v_image_axes;         // images per meter along the axes of the face
#endif
out vec2 v_on_face;                 // m, from the center of the face along its axes
flat out vec4 v_face;               // m: half the size of the face; the same without the bevel's width
flat out vec4 v_tile;               // place of the face's center in the AO atlas, and the scale per meter along its axes
flat out vec3 v_edges;              // m: bevel, distance of the groove from the edge, half width of the groove
#ifdef TWO_COLORS
out vec3 v_local;                   // m, body axes
flat out vec3 v_outward;            // of the face, body axes
#endif
#else
out vec3 v_local;                   // m, body axes
#endif
#if defined(TWO_COLORS) || defined(IMAGE)
flat out vec3 v_color;              // linear
flat out vec4 v_second;             // second color, and metallic; of a texture: Instance::paint and metallic
#endif
#ifdef TWO_COLORS
flat out vec4 v_cells;              // half size of the body and size of a cell, m
#endif
#ifdef IMAGE
uniform sampler2D mesh_texture;
flat out vec2 v_image;              // size of the texture, texels
#include "texture_place.glsl"
#endif
#ifdef BALL
flat out vec4 v_tile;               // center of its tile in the AO atlas, and half of the tile's width and height
#if !defined(PATTERNED) && !defined(PLAIN)
flat out vec4 v_octants;            // on every second octant: added diffuse color; w: reduction of all light
#endif
#endif
#ifdef MESH
out vec3 v_normal;                  // body axes
#ifdef PAINTED
uniform sampler2D mesh_texture;
out vec3 v_paint;                   // color of the file, without its texture
out vec2 v_uv;
flat out vec2 v_image;              // size of the texture, texels
flat out vec3 v_emission;
flat out vec2 v_surface;            // metallic; least alpha
#ifdef TRANSLUCENT
flat out float v_opacity;
#endif
#endif
#ifdef CHARTED
out vec2 v_texel;                   // place in the AO atlas
#else
out float v_open;                   // sky visibility
#endif
#endif

void main() {
#ifdef BOX
    // The square is mapped to one face of the cube; faces are in the order -x, +x, -y, ... with u x v = outward.
    int face = int(instance_tile.y);
    float side = float(face % 2 * 2 - 1);
    vec2 corner = vec2(mesh_position.x, mesh_position.y * side);
    vec3 on_cube = face < 2 ? vec3(side, corner) : face < 4 ? vec3(corner.y, side, corner.x) : vec3(corner, side);
    // Its axes a and b are the next two of the box.
    int axis = face / 2, a = (axis + 1) % 3, b = (axis + 2) % 3;
    vec3 unit_a = vec3(a == 0, a == 1, a == 2), unit_b = vec3(b == 0, b == 1, b == 2);
    vec3 outward = side * vec3(axis == 0, axis == 1, axis == 2);
#else
    vec3 on_cube = mesh_position;
#endif
    vec3 size = instance_scale.xyz;
#ifdef BOX
    // Thinner than a pixel in two directions: see render/antialiasing/thin_geometry_aa.h.
    vec2 rod = vec2(widest_rod, thinnest_rod) * length(instance_position.xyz);
    float longest = max(max(size.x, size.y), size.z);
    if (max(min(size.x, size.y), min(max(size.x, size.y), size.z)) < rod.x && longest > 5.0 * rod.x) size = max(size, vec3(rod.y));
#endif
    vec3 local = on_cube * size;
    vec3 position = placed(local);
    gl_Position = clip_from_relative * vec4(position, 1.0);
#ifdef CUT
    gl_ClipDistance[0] = position.y - atlas.z + 2.0 * pixel_size * gl_Position.w;   // no gap at the water line
#endif

    float squared = dot(position, position);
    vec3 direction = position * inversesqrt(max(squared, 1e-30));
#ifdef BACKGROUND
    v_air = background(direction, background_low, background_high);
#else
    v_air = sky(direction.y, dot(direction, to_light.xyz));
#endif

    float roughness = instance_color.w, metallic = instance_material.x;
#ifdef PAINTED
    roughness = mesh_surface.x < 0.0 ? roughness : mesh_surface.x;
    metallic = mesh_surface.y < 0.0 ? metallic : mesh_surface.y;
    v_paint = mesh_color;
    v_uv = mesh_uv;
    v_image = vec2(textureSize(mesh_texture, 0));
    v_emission = mesh_emission;
    v_surface = vec2(metallic, mesh_surface.z);
#ifdef TRANSLUCENT
    v_opacity = mesh_surface.w;
#endif
#endif
#ifdef WITH_MAPS
    place_maps(roughness, metallic);
#endif
#ifdef GLOWING
    v_glow = instance_glow;
#endif
    v_diffuse = surface_diffuse(instance_color.rgb, metallic);
    v_f0 = surface_f0(instance_color.rgb, metallic);
    v_rough = vec4(surface_roughness(roughness), surface_veil(roughness, metallic), instance_tile.z);
#ifdef PATTERNED
    v_pattern = vec2(instance_material.y, instance_scale.w);
#endif

#if defined(TWO_COLORS) || defined(IMAGE)
    v_color = instance_color.rgb;
    v_second = vec4(instance_paint.rgb, metallic);
#endif
#ifdef TWO_COLORS
    v_cells = vec4(size, instance_scale.w);
#endif
#ifdef IMAGE
    v_image = vec2(textureSize(mesh_texture, 0));
#endif

    vec3 eye = rotate_back(instance_orientation, -instance_position.xyz);
    v_up = rotate_back(instance_orientation, vec3(0.0, 1.0, 0.0));
    vec3 light = rotate_back(instance_orientation, to_light.xyz);
#ifdef ENVIRONMENT
    v_east = rotate_back(instance_orientation, vec3(1.0, 0.0, 0.0));
    v_south = rotate_back(instance_orientation, vec3(0.0, 0.0, 1.0));
    for (int i = 0; i < 9; ++i) v_around[i] = around[i].rgb;
    v_sun_share = sun_share.rgb;
#ifdef BOX
    v_east = vec3(dot(v_east, unit_a), dot(v_east, unit_b), dot(v_east, outward));
    v_south = vec3(dot(v_south, unit_a), dot(v_south, unit_b), dot(v_south, outward));
#endif
#endif
#ifdef BOX
    eye -= outward * abs(dot(outward, size));   // from the center of the face
    eye = vec3(dot(eye, unit_a), dot(eye, unit_b), dot(eye, outward));
    v_up = vec3(dot(v_up, unit_a), dot(v_up, unit_b), dot(v_up, outward));
    light = vec3(dot(light, unit_a), dot(light, unit_b), dot(light, outward));
#ifdef LAMP_LIGHT
    place_lamps(eye, mat3(rotate(instance_orientation, unit_a), rotate(instance_orientation, unit_b),
                          rotate(instance_orientation, outward)));
#endif
    vec2 half_size = vec2(dot(size, unit_a), dot(size, unit_b));
    v_on_face = vec2(dot(local, unit_a), dot(local, unit_b));
    // A tile has the center of a texel at each corner of its face. It is a thousandth smaller, so that rounding never
    // reads the next tile.
    vec2 first = instance_material.zw + vec2(float(face) * instance_tile.x, 0.0) + 0.5;
    float span = max(instance_tile.x - 1.002, 0.0);
    vec2 middle = instance_tile.x > 0.0 ? first + 0.5 * (instance_tile.x - 1.0) : vec2(0.5);
    v_tile = vec4(middle, 0.5 * span / half_size) * atlas.xyxy;
    // A bevel narrower than a pixel would flicker, so it grows with the distance.
    float pixel = pixel_size * length(instance_position.xyz);
    float thinnest = min(size.x, min(size.y, size.z));
    float bevel = min(max(instance_position.w, pixel), 0.5 * thinnest);
    // A box of a few pixels would consist of bevels, hit irregularly by pixel centers. Its sides are flat instead.
    bevel *= max(smoothstep(flat_box * pixel, round_box * pixel, thinnest), 1e-3);
    v_face = vec4(half_size, half_size - bevel);
    v_edges = vec3(bevel, vec2(crate_frame, 0.5 * crate_groove) * (2.0 * thinnest));
#ifdef IMAGE
    vec2 images = images_on_face(size, outward, instance_paint.w) / (2.0 * abs(seen_from_outside(size, outward)));
    v_image_axes = vec4(seen_from_outside(unit_a, outward), seen_from_outside(unit_b, outward)) * images.xyxy;
#endif
#ifdef TWO_COLORS
    v_local = local;
    v_outward = outward;
#endif
    vec3 lift = rotate(instance_orientation, outward);
#else
    v_local = local;
#ifdef LAMP_LIGHT
    place_lamps(eye, mat3(rotate(instance_orientation, vec3(1.0, 0.0, 0.0)), rotate(instance_orientation, vec3(0.0, 1.0, 0.0)),
                          rotate(instance_orientation, vec3(0.0, 0.0, 1.0))));
#endif
#endif
#ifdef BALL
    float half_span = max(0.5 * instance_tile.x - 0.501, 0.0);   // a thousandth less, as for boxes
    v_tile = vec4(instance_tile.x > 0.0 ? instance_material.zw + 0.5 * instance_tile.x : vec2(0.5), vec2(half_span)) * atlas.xyxy;
#if !defined(PATTERNED) && !defined(PLAIN)
    // Paler paint; metal has none.
    v_octants = ball_contrast * vec4((1.0 - metallic) * (1.0 - metallic - v_diffuse), metallic);
#endif
    vec3 lift = rotate(instance_orientation, mesh_normal);
#endif
#ifdef CHARTED
    v_texel = ((instance_tile.x > 0.0 ? instance_material.zw + mesh_texel : vec2(0.0)) + 0.5) * atlas.xy;
#elif defined(MESH)
    int width = textureSize(occlusion_atlas, 0).x;
    int vertex_sample = int(instance_material.z) + int(mesh_sample);
    ivec2 texel = ivec2(vertex_sample % width, int(instance_material.w) + vertex_sample / width);
    v_open = texelFetch(occlusion_atlas, instance_tile.x > 0.0 ? texel : ivec2(0), 0).r;
#endif
#ifdef MESH
    v_normal = normalize(mesh_normal / instance_scale.xyz);
    vec3 lift = rotate(instance_orientation, v_normal);
#ifdef LAMP_SHADOW
    vec3 lamp_lift = instance_tile.y > 0.0 && dot(lift, to_shadow_lamp(position)) < 0.0 ? -lift : lift;
#endif
    // An open mesh is lit on both sides. The offset points to the sun's side, because otherwise a side would shadow
    // itself.
    if (instance_tile.y > 0.0 && dot(v_normal, light) < 0.0) lift = -lift;
#endif
    v_eye = vec4(eye, fog_density);
#ifdef SUNLIT
    v_to_light = light;
#endif
#ifdef SHADOWED
#ifdef SPANS_CASCADES
    v_in_near = place_in_map(position, lift, true);
    v_in_far = place_in_map(position, lift, false);
#else
    v_shadow = shadow_place(position, lift, instance_tile.w > 0.0);
#endif
#endif
#ifdef LAMP_SHADOW
#ifndef MESH
    vec3 lamp_lift = lift;
#endif
    v_lamp_shadow = lamp_shadow_place(position, lamp_lift);
#endif
}
