// Ambient occlusion from the bodies themselves: each is a box, a ball or a plane, whose distance is known in closed form.
// No noise and no screen-space guesses, so nothing crawls; what is hidden occludes as well.
uniform samplerBuffer occluders;       // three texels each: centre and body number; orientation; half size and reach
uniform isamplerBuffer occluder_cells; // a table of list starts, then the lists of occluders, each ended by -1

// A closing gap at two probes along the normal: 0 open, 1 closed.
float closed(vec2 distances, vec2 probes) {
    vec2 c = clamp(1.0 - distances / probes, 0.0, 1.0);
    return 0.5 * (c.x + c.y);
}

float box_distance(vec3 p, vec3 half_size) {
    // Quilez 2008, Distance functions: exact outside, the nearest face inside
    vec3 q = abs(p) - half_size;
    return length(max(q, 0.0)) + min(max(q.x, max(q.y, q.z)), 0.0);
}

// The part of the sky's light that reaches a point past the bodies within reach.
float sky_open(vec3 position, vec3 normal, float reach, float body) {
    // Evans 2006, Fast Approximations for Global Illumination on Dynamic Scenes: occlusion from distances to surfaces
    float open = 1.0;
    for (int i = 0; i < int(occlusion_grid.z); ++i) {
        vec4 plane = occluding_planes[i];
        vec2 probes = reach * vec2(occlusion_near, 1.0);
        float height = dot(plane.xyz, position) + plane.w;
        open *= 1.0 - occlusion_strength * closed(height + dot(plane.xyz, normal) * probes, probes);
    }

    ivec3 cell = ivec3(floor(position * occlusion_grid.x));
    // Teschner et al. 2003, Optimized Spatial Hashing for Collision Detection of Deformable Objects
    uint hash = uint(cell.x) * 73856093u ^ uint(cell.y) * 19349663u ^ uint(cell.z) * 83492791u;
    int at = texelFetch(occluder_cells, int(hash & uint(occlusion_grid.y))).r;
    for (int i = texelFetch(occluder_cells, at).r; i >= 0; i = texelFetch(occluder_cells, ++at).r) {
        vec4 center = texelFetch(occluders, 3 * i);
        vec4 orientation = texelFetch(occluders, 3 * i + 1);
        vec4 size = texelFetch(occluders, 3 * i + 2);
        vec3 p = rotate_back(orientation, position - center.xyz);
        vec3 n = rotate_back(orientation, normal);
        vec2 probes = min(reach, size.w) * vec2(occlusion_near, 1.0);
        float radius = max(-size.x, 0.0);              // a ball is a box of no size, minus a radius
        vec3 half_size = max(size.xyz, 0.0);
        vec2 distances = vec2(box_distance(p + n * probes.x, half_size), box_distance(p + n * probes.y, half_size)) - radius;
        float share = center.w == body ? 0.0 : occlusion_strength;
        open *= 1.0 - share * closed(distances, probes);
    }
    return open;
}
