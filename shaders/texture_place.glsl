// Places of textures on shapes, as scene/description/looks.cpp has them.

// Position on a face of a box from its center, seen from outside: rightward and downward.
vec2 seen_from_outside(vec3 position, vec3 normal) {
    vec3 a = abs(normal);
    if (a.x > a.y && a.x > a.z) return vec2(normal.x > 0.0 ? -position.z : position.z, -position.y);
    if (a.y > a.z) return vec2(position.x, normal.y > 0.0 ? position.z : -position.z);
    return vec2(normal.z > 0.0 ? position.x : -position.x, -position.y);
}

// Images across a face, by the half size of the box; scale: m that an image covers, 0: the face.
vec2 images_on_face(vec3 half_size, vec3 normal, float scale) {
    vec2 face = 2.0 * abs(seen_from_outside(half_size, normal));
    return scale > 0.0 ? face / scale : vec2(1.0);
}

// On a ball with so many images around and from pole to pole.
vec2 place_on_ball(vec3 direction, vec2 images) {
    float around = atan(direction.x, direction.z) * 0.15915494;
    float polar = atan(length(direction.xz), direction.y) * 0.31830989;
    return vec2(images.x * (0.5 + around), 0.5 + images.y * (polar - 0.5));
}

// Derivatives of that place are infinite at the poles and where the image closes, so its footprint follows from that
// of the direction: images per pixel. At a pole, a row of texels is averaged only in part.
vec2 footprint_on_ball(vec3 direction, vec3 width, vec2 images) {
    float angle = length(width);
    float ring = max(length(direction.xz), 0.15);
    return angle * vec2(images.x * 0.15915494 / ring, images.y * 0.31830989);
}

// The mip map whose texels have about the size of the pixel. `along_x`, `along_y`: steps between pixels, in texels.
float texture_level(vec2 along_x, vec2 along_y) {
    return 0.5 * log2(max(max(dot(along_x, along_x), dot(along_y, along_y)), 1e-12));
}

// Linear light; the values of the texture are square roots.
vec3 texel_at(sampler2D image, vec2 place, float level) {
    vec3 root = textureLod(image, place, level).rgb;
    return root * root;
}
