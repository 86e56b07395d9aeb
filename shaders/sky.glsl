// The backdrop: what a ray that meets nothing sees.

vec3 sky(vec3 direction) {
    float height = direction.y;
    float up = max(height, 0.0), down = max(-height, 0.0);
    float above = 1.0 - 1.0 / (1.0 + sky_haze * up * (1.0 + up));
    float below = 1.0 - 1.0 / (1.0 + sky_haze * down);
    float toward_sun = max(dot(direction, to_light.xyz), 0.0);
    toward_sun *= toward_sun;
    toward_sun *= toward_sun;
    return mix(mix(sky_horizon, sky_zenith, above), sky_nadir, below) + sun_glow * (toward_sun * toward_sun);
}

// What a surface of this roughness mirrors: the same, with the horizon's edge blurred away.
vec3 blurred_sky(vec3 direction, float roughness) {
    float height = direction.y;
    float spread = 0.15 + roughness;
    float above = clamp(0.5 + 0.5 * height / spread, 0.0, 1.0);
    above = above * above * (3.0 - 2.0 * above);
    vec3 upper = mix(sky_horizon, sky_zenith, max(height, 0.0) * (1.0 - 0.5 * roughness));
    return mix(sky_nadir * 0.6, upper, above);
}

// Distance haze: the share of light from `squared` (distance squared) that the air has replaced by the sky's.
float haze_share(float squared) {
    float relative = squared * haze.x;
    relative *= relative;   // the fourth power of the distance: what one looks at stays clear
    return relative / (1.0 + relative);
}
