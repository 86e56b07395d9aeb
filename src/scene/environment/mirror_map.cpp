#include "scene/environment/mirror_map.h"

#include "core/deterministic_math.h"

#include <algorithm>
#include <cmath>
#include <cstdint>

namespace tumble {
namespace {

using Radiance = Eigen::Array3f;
using FloatDirection = Eigen::Vector3f;

constexpr int source_side = 256, coarsest = 5;  // side and last of the maps that samples are taken from
constexpr int sample_count = 64;
constexpr float brightest = 500.0f;  // a sun in an image is brighter, and would be seen as single samples

/// A square octahedral map without a rim.
struct Octahedron {
    int side;
    std::vector<Radiance> texels;

    const Radiance& at(int x, int y) const {  // over an edge, the map continues on the other half of that edge
        if (x < 0 || x >= side) x = x < 0 ? -1 - x : 2 * side - 1 - x, y = side - 1 - y;
        if (y < 0 || y >= side) y = y < 0 ? -1 - y : 2 * side - 1 - y, x = side - 1 - x;
        return texels[std::size_t(y) * std::size_t(side) + std::size_t(x)];
    }
    Radiance between(const FloatDirection& d) const {
        const Eigen::Vector2f p = place(d) * float(side) - Eigen::Vector2f::Constant(0.5f);
        const float left = std::floor(p.x()), top = std::floor(p.y()), u = p.x() - left, v = p.y() - top;
        const int x = int(left), y = int(top);
        return (1.0f - v) * ((1.0f - u) * at(x, y) + u * at(x + 1, y)) +
               v * ((1.0f - u) * at(x, y + 1) + u * at(x + 1, y + 1));
    }

    /// Meyer et al. 2010, On Floating-Point Normal Vectors. 0 to 1, of a unit direction.
    static Eigen::Vector2f place(const FloatDirection& d) {
        const float scale = 1.0f / (std::abs(d.x()) + std::abs(d.y()) + std::abs(d.z()));
        float x = d.x() * scale, z = d.z() * scale;
        if (d.y() < 0.0f) {
            const float folded = (1.0f - std::abs(z)) * (x >= 0.0f ? 1.0f : -1.0f);
            z = (1.0f - std::abs(x)) * (z >= 0.0f ? 1.0f : -1.0f);
            x = folded;
        }
        return {0.5f + 0.5f * x, 0.5f + 0.5f * z};
    }
    static FloatDirection direction(float u, float v) {
        float x = 2.0f * u - 1.0f, z = 2.0f * v - 1.0f;
        const float y = 1.0f - std::abs(x) - std::abs(z);
        if (y < 0.0f) {
            const float folded = (1.0f - std::abs(z)) * (x >= 0.0f ? 1.0f : -1.0f);
            z = (1.0f - std::abs(x)) * (z >= 0.0f ? 1.0f : -1.0f);
            x = folded;
        }
        return FloatDirection(x, y, z).normalized();
    }
};

/// An equirectangular image, halved until its texels are about as large as those of the octahedral map.
class Panorama {
public:
    explicit Panorama(const EnvironmentDescription& environment)
        : width_(environment.image->width), height_(environment.image->height) {
        const float intensity = float(environment.intensity);
        texels_.reserve(environment.image->texels.size());
        for (const auto& t : environment.image->texels)
            texels_.push_back((intensity * Radiance(t[0], t[1], t[2])).min(brightest));
        while (width_ > 4 * source_side && height_ > 1) halve();
        const auto turned = sincos(environment.rotation * pi / 180.0);
        sine_ = float(turned.sin), cosine_ = float(turned.cos);
    }

    /// Interpolated; `direction`: unit, world frame.
    Radiance toward(const FloatDirection& d) const {
        const double x = cosine_ * d.x() - sine_ * d.z(), z = cosine_ * d.z() + sine_ * d.x();
        const double around = atan2_stable(z, x) / (2.0 * pi) + 0.5;
        const double polar = atan2_stable(std::sqrt(x * x + z * z), double(d.y())) / pi;
        const double across = around * width_ - 0.5, down = std::clamp(polar * height_ - 0.5, 0.0, double(height_ - 1));
        const double left = std::floor(across), top = std::floor(down);
        const float u = float(across - left), v = float(down - top);
        const int first = (int(left) + width_) % width_, second = (first + 1) % width_;
        const int upper = int(top), lower = std::min(upper + 1, height_ - 1);
        return (1.0f - v) * ((1.0f - u) * at(first, upper) + u * at(second, upper)) +
               v * ((1.0f - u) * at(first, lower) + u * at(second, lower));
    }

private:
    const Radiance& at(int x, int y) const { return texels_[std::size_t(y) * std::size_t(width_) + std::size_t(x)]; }
    void halve() {
        const int width = width_ / 2, height = height_ / 2;
        std::vector<Radiance> smaller;
        smaller.reserve(std::size_t(width) * std::size_t(height));
        for (int y = 0; y < height; ++y)
            for (int x = 0; x < width; ++x)
                smaller.push_back(0.25f * (at(2 * x, 2 * y) + at(2 * x + 1, 2 * y) + at(2 * x, 2 * y + 1) +
                                           at(2 * x + 1, 2 * y + 1)));
        texels_ = std::move(smaller);
        width_ = width, height_ = height;
    }

    int width_, height_;
    std::vector<Radiance> texels_;
    float sine_, cosine_;
};

template <class Visit>
Octahedron made_map(int side, const Visit& light_toward) {
    Octahedron map{side, {}};
    map.texels.reserve(std::size_t(side) * std::size_t(side));
    for (int y = 0; y < side; ++y)
        for (int x = 0; x < side; ++x)
            map.texels.push_back(
                light_toward(Octahedron::direction((float(x) + 0.5f) / float(side), (float(y) + 0.5f) / float(side))));
    return map;
}

/// The light of the image as maps, each of half the side of the one before.
std::vector<Octahedron> source_maps(const EnvironmentDescription& environment) {
    const Panorama panorama(environment);
    std::vector<Octahedron> maps{made_map(source_side, [&](const FloatDirection& d) { return panorama.toward(d); })};
    while (maps.size() <= coarsest) {
        const Octahedron& larger = maps.back();
        Octahedron half{larger.side / 2, {}};
        for (int y = 0; y < half.side; ++y)
            for (int x = 0; x < half.side; ++x)
                half.texels.push_back(0.25f * (larger.at(2 * x, 2 * y) + larger.at(2 * x + 1, 2 * y) +
                                               larger.at(2 * x, 2 * y + 1) + larger.at(2 * x + 1, 2 * y + 1)));
        maps.push_back(std::move(half));
    }
    return maps;
}

/// The reversed bits of n as a fraction: van der Corput's sequence.
float radical_inverse(std::uint32_t n) {
    std::uint32_t reversed = 0;
    for (int bit = 0; bit < 32; ++bit) reversed |= (n >> bit & 1u) << (31 - bit);
    return float(double(reversed) / 4294967296.0);
}

/// A direction of light that a surface mirrors towards its own normal, which is z.
struct Sample {
    FloatDirection direction;
    float share;        // of the light
    std::size_t level;  // of the maps: as wide as the samples are apart
};

/// Karis 2013, Real Shading in Unreal Engine 4: samples of the GGX lobe seen along the normal; Colbert and Krivanek
/// 2007, GPU-Based Importance Sampling: each is read from a map as coarse as its share is small
std::vector<Sample> lobe_samples(float roughness) {
    const float a = roughness * roughness, a2 = a * a;
    std::vector<Sample> samples;
    float sum = 0.0f;
    for (int i = 0; i < sample_count; ++i) {
        const float u = (float(i) + 0.5f) / float(sample_count);
        const auto [sine, cosine] = sincos(2.0 * pi * double(radical_inverse(std::uint32_t(i))));
        const float height2 = (1.0f - u) / (1.0f + (a2 - 1.0f) * u), height = std::sqrt(height2);
        const float across = std::sqrt(std::max(1.0f - height2, 0.0f));
        const FloatDirection half(across * float(cosine), across * float(sine), height);
        const FloatDirection light = 2.0f * height * half - FloatDirection::UnitZ();
        if (light.z() <= 0.0f) continue;
        const float d = height2 * (a2 - 1.0f) + 1.0f;
        const float density = a2 / (float(pi) * d * d) / 4.0f;
        const float solid_angle = 1.0f / (float(sample_count) * density);
        const float of_texel = 4.0f * float(pi) / float(source_side * source_side);
        constexpr double per_halving =
            0.72134752044448170;  // 1 / ln 4: a map of half the side has a quarter of the texels
        const double level =
            std::clamp(per_halving * logarithm(double(solid_angle / of_texel)) + 1.5, 0.0, double(coarsest));
        samples.push_back({light, light.z(), std::size_t(level)});
        sum += light.z();
    }
    for (Sample& sample : samples) sample.share /= sum;
    return samples;
}

Radiance mirrored(const std::vector<Octahedron>& maps, const std::vector<Sample>& samples,
                  const FloatDirection& normal) {
    // Duff et al. 2017, Building an Orthonormal Basis, Revisited
    const float sign = normal.z() >= 0.0f ? 1.0f : -1.0f, a = -1.0f / (sign + normal.z()),
                b = normal.x() * normal.y() * a;
    const FloatDirection first(1.0f + sign * normal.x() * normal.x() * a, sign * b, -sign * normal.x());
    const FloatDirection second(b, sign + normal.y() * normal.y() * a, -normal.y());
    Radiance sum = Radiance::Zero();
    for (const Sample& sample : samples) {
        const FloatDirection& s = sample.direction;
        sum += sample.share * maps[sample.level].between(s.x() * first + s.y() * second + s.z() * normal);
    }
    return sum;
}

void put_tile(const Octahedron& map, int left, int top, MirrorMap& target) {
    for (int y = -1; y <= map.side; ++y)
        for (int x = -1; x <= map.side; ++x) {
            const Radiance& light = map.at(x, y);
            target.texels[std::size_t(top + y + 1) * std::size_t(MirrorMap::width) + std::size_t(left + x + 1)] = {
                light[0], light[1], light[2], 1.0f};
        }
}

float roughness_of_tile(int tile) {
    const float root = float(tile) / float(MirrorMap::rough_count);
    return 0.06f + 0.94f * root * root;
}

}  // namespace

MirrorMap make_mirror_map(const EnvironmentDescription& environment) {
    const std::vector<Octahedron> maps = source_maps(environment);
    MirrorMap target;
    target.texels.resize(std::size_t(MirrorMap::width) * std::size_t(MirrorMap::height));
    put_tile(made_map(MirrorMap::sharp_side - 2, [&](const FloatDirection& d) { return maps[1].between(d); }), 0, 0,
             target);
    for (int tile = 1; tile <= MirrorMap::rough_count; ++tile) {
        const std::vector<Sample> samples = lobe_samples(roughness_of_tile(tile));
        put_tile(
            made_map(MirrorMap::rough_side - 2, [&](const FloatDirection& d) { return mirrored(maps, samples, d); }),
            MirrorMap::rough_side * ((tile - 1) % 2), MirrorMap::sharp_side + MirrorMap::rough_side * ((tile - 1) / 2),
            target);
    }
    return target;
}

EnvironmentImage blurred_background(const EnvironmentDescription& environment) {
    EnvironmentImage image = *environment.image;
    if (environment.blur == 0.0) {
        for (auto& texel : image.texels)
            for (float& channel : texel) channel *= float(environment.intensity);
        return image;
    }
    EnvironmentDescription unturned = environment;
    unturned.rotation = 0.0;
    const std::vector<Octahedron> maps = source_maps(unturned);
    const std::vector<Sample> samples = lobe_samples(float(environment.blur));
    const Octahedron blurred = made_map(64, [&](const FloatDirection& d) { return mirrored(maps, samples, d); });
    image = EnvironmentImage{256, 128, {}};
    for (int y = 0; y < image.height; ++y) {
        const auto [sine, cosine] = sincos(pi * (y + 0.5) / image.height);
        for (int x = 0; x < image.width; ++x) {
            const auto [across, along] = sincos(2.0 * pi * ((x + 0.5) / image.width - 0.5));
            const Radiance light = blurred.between(Vec3(sine * along, cosine, sine * across).cast<float>());
            image.texels.push_back({light[0], light[1], light[2]});
        }
    }
    return image;
}

}  // namespace tumble
