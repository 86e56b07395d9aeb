// Vertex counterpart of surface_maps.glsl.
#ifdef NORMAL_MAP
uniform sampler2D normal_map;
#endif
#ifdef SURFACE_MAP
uniform sampler2D surface_map;
#endif
#ifdef EMISSION_MAP
uniform sampler2D emission_map;
#endif
flat out vec2 v_factors;            // roughness, metallic
flat out vec3 v_map_levels;         // binary logarithms of the sides of the maps, texels

float side_level(ivec2 size) { return log2(float(max(size.x, size.y))); }

void place_maps(float roughness, float metallic) {
    v_factors = vec2(roughness, metallic);
    v_map_levels = vec3(0.0);
#ifdef NORMAL_MAP
    v_map_levels.x = side_level(textureSize(normal_map, 0));
#endif
#ifdef SURFACE_MAP
    v_map_levels.y = side_level(textureSize(surface_map, 0));
#endif
#ifdef EMISSION_MAP
    v_map_levels.z = side_level(textureSize(emission_map, 0));
#endif
}
