// Light of LAMPS lights, one of which may have shadows, in addition to the sun of lighting.glsl. Positions and directions have the axes
// of the surface. LAMP_KINDS: two bits for each light, the first one lowest.
struct Lamp {
    vec3 place;     // of a point or spot from the point that its `from` is given from, m; of a sun the direction to it
    vec3 light;     // irradiance over pi of a sun; of the others at 1 m
    vec4 axis;      // of a spot: direction in which it shines; cosine of half its angle
};

const int sun_kind = 0, point_kind = 1, spot_kind = 2;

// `rest`: cosines of the surface to the eye and the like, already filled in.
vec3 light_of(Lamp lamp, int kind, vec3 from, vec3 normal, vec3 to_eye, Surface s) {
    vec3 way = kind == sun_kind ? lamp.place : lamp.place - from;
    float squared = max(dot(way, way), 1e-8);
    vec3 to_lamp = way * inversesqrt(squared);
    float strength = kind == sun_kind ? 1.0 : 1.0 / squared;
    if (kind == spot_kind) {
        const float rim = 0.15;     // of the cone's opening, soft
        float inside = (-dot(to_lamp, lamp.axis.xyz) - lamp.axis.w) / max(rim * (1.0 - lamp.axis.w), 1e-5);
        strength *= smoothstep(0.0, 1.0, inside);
    }
    float n_l = clamp(dot(normal, to_lamp), 0.0, 1.0), n_v = clamp(s.n_v, 1e-3, 1.0);
    vec3 middle = to_lamp + to_eye;
    middle *= inversesqrt(max(dot(middle, middle), 1e-6));
    float grazing = 1.0 - clamp(dot(middle, to_eye), 0.0, 1.0), grazing2 = grazing * grazing;
    vec3 fresnel = s.f0 + (1.0 - s.f0) * (grazing2 * grazing2 * grazing);
    float lobe = min(specular_lobe(s.rough.x, clamp(dot(normal, middle), 0.0, 1.0), n_l, n_v), brightest_highlight);
    float open = 1.0 - occlusion_of_sun + occlusion_of_sun * s.open;
    return (s.diffuse + fresnel * lobe) * lamp.light * (strength * n_l * open);
}

LAMP_VALUE vec3 v_lamp_place[LAMPS];
LAMP_VALUE vec3 v_lamp_light[LAMPS];
#ifdef SPOTS
LAMP_VALUE vec4 v_lamp_axis[LAMPS];
#endif

#ifdef LAMP_SHADOW
#include "lamp_shadow.glsl"
float lamp_seen = 1.0;          // see lamp_visible()
#endif

vec3 light_of_lamps(vec3 from, vec3 normal, vec3 to_eye, Surface s) {
    vec3 sum = vec3(0.0);
    for (int i = 0; i < LAMPS; ++i) {
#ifdef SPOTS
        Lamp lamp = Lamp(v_lamp_place[i], v_lamp_light[i], v_lamp_axis[i]);
#else
        Lamp lamp = Lamp(v_lamp_place[i], v_lamp_light[i], vec4(0.0));
#endif
        vec3 light = light_of(lamp, LAMP_KINDS >> (2 * i) & 3, from, normal, to_eye, s);
#ifdef LAMP_SHADOW
        if (i == LAMP_SHADOW) light *= lamp_seen;
#endif
        sum += light;
    }
    return sum;
}
