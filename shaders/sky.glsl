// The background: radiance of the sky along a ray that hits no surface.

// `toward_sun`: cosine of the angle to the sun.
vec3 sky(float height, float toward_sun) {
    float up = max(height, 0.0), down = max(-height, 0.0);
    float above = 1.0 - 1.0 / (1.0 + horizon_falloff * up * (1.0 + up));
    float below = 1.0 - 1.0 / (1.0 + horizon_falloff * down);
    toward_sun = max(toward_sun, 0.0);
    toward_sun *= toward_sun;
    toward_sun *= toward_sun;
    return mix(mix(sky_horizon, sky_zenith, above), sky_nadir, below) + sun_glow * (toward_sun * toward_sun);
}

// The sky mirrored by a surface of this roughness: the same with a blurred horizon.
vec3 blurred_sky(float height, vec2 rough) {
    float above = clamp(0.5 + height * rough.y, 0.0, 1.0);
    above = above * above * (3.0 - 2.0 * above);
    vec3 upper = mix(sky_horizon, sky_zenith, max(height, 0.0) * (1.0 - 0.5 * rough.x));
    return mix(sky_nadir * 0.6, upper, above);
}

// Fog: the share of light from the squared distance `squared` that is replaced by that of the sky.
float fog_share(float squared, float per_half) {
    float relative = squared * per_half;
    relative *= relative;   // the fourth power of the distance keeps nearby bodies clear
    return relative / (1.0 + relative);
}
