// Images beside that of the color, at the same places: normals, roughness with metallic and sky visibility, emission.
// Defines: NORMAL_MAP, SURFACE_MAP, EMISSION_MAP; one of the first two defines MAPPED.
flat in vec2 v_factors;             // roughness, metallic
flat in vec3 v_map_levels;          // binary logarithms of the sides of the maps, texels
#ifdef NORMAL_MAP
uniform sampler2D normal_map;
#endif
#ifdef SURFACE_MAP
uniform sampler2D surface_map;
#endif
#ifdef EMISSION_MAP
uniform sampler2D emission_map;
#endif

float map_roughness, map_metallic, map_open = 1.0;
#ifdef NORMAL_MAP
vec3 map_normal;                    // rightward, upward, outward
#endif
#ifdef EMISSION_MAP
vec3 map_emission;
#endif

// `footprint`: binary logarithm of the pixel's width, in images.
void read_maps(vec2 place, float footprint) {
    map_roughness = v_factors.x;
    map_metallic = v_factors.y;
#ifdef SURFACE_MAP
    vec3 surface = textureLod(surface_map, place, footprint + v_map_levels.y).rgb;
    map_open = surface.r;
    map_roughness *= surface.g;
    map_metallic *= surface.b;
#endif
#ifdef NORMAL_MAP
    map_normal = textureLod(normal_map, place, footprint + v_map_levels.x).rgb * (255.0 / 127.0) - 128.0 / 127.0;
    // Toksvig 2005, Mipmapping Normal Maps: the shorter the mean of normals, the wider they scatter. The rounding of
    // texels to bytes shortens by less than a hundredth.
    float length2 = dot(map_normal, map_normal);
    float per_length = inversesqrt(max(length2, 1e-6));
    float scatter = clamp(per_length - 1.01, 0.0, 1.0);
    map_normal *= per_length;
    float narrow = map_roughness * map_roughness;
    map_roughness = sqrt(sqrt(min(narrow * narrow + 2.0 * scatter, 1.0)));
#endif
#ifdef EMISSION_MAP
    map_emission = textureLod(emission_map, place, footprint + v_map_levels.z).rgb;
    map_emission *= map_emission;   // values are square roots
#endif
}

// By derivatives of the place, in images.
void read_maps(vec2 place, vec2 along_x, vec2 along_y) {
    read_maps(place, 0.5 * log2(max(max(dot(along_x, along_x), dot(along_y, along_y)), 1e-20)));
}

#ifdef NORMAL_MAP
// `right`, `up`: unit vectors along which the image runs, in the axes of the surface.
vec3 bent_normal(vec3 right, vec3 up, vec3 normal) {
    vec3 bent = right * map_normal.x + up * map_normal.y + normal * map_normal.z;
    return bent * inversesqrt(max(dot(bent, bent), 1e-12));
}

// Where the axes follow from the derivatives of position and place (Mikkelsen 2010, Bump Mapping Unparametrized
// Surfaces on the GPU).
vec3 bent_normal(vec3 position, vec2 place, vec3 normal) {
    vec3 x = dFdx(position), y = dFdy(position);
    vec2 along_x = dFdx(place), along_y = dFdy(place);
    vec3 to_x = cross(y, normal), to_y = cross(normal, x);
    float side = dot(cross(x, y), normal) < 0.0 ? -1.0 : 1.0;
    vec3 right = side * (to_x * along_x.x + to_y * along_y.x);
    vec3 down = side * (to_x * along_x.y + to_y * along_y.y);
    return bent_normal(right * inversesqrt(max(dot(right, right), 1e-30)),
                       -down * inversesqrt(max(dot(down, down), 1e-30)), normal);
}
#endif
