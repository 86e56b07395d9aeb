#include "scene/description/water.h"

#include "core/deterministic_math.h"

#include <cmath>

namespace tumble {
namespace {

SinCos phase_at(const WaterSurface::Wave& wave, double x, double z, double time) {
    return sincos(wave.k.x() * x + wave.k.z() * z - wave.rate * time + wave.phase);
}

}  // namespace

WaterSurface::WaterSurface(const WaterDescription& water, double gravity, const Vec3& origin)
    : level_(water.level - origin.y()), current_(water.current) {
    for (const WaterWave& wave : water.waves) {
        const double number = 2.0 * pi / wave.length, omega = std::sqrt(gravity * number);
        const Vec3 k = number * wave.direction;
        waves_.push_back(
            {k, 0.5 * wave.height, omega + k.dot(current_), omega, wave.phase * (pi / 180.0) + k.dot(origin), number});
    }
}

double WaterSurface::height(double x, double z, double time) const {
    double sum = level_;
    for (const Wave& wave : waves_) sum += wave.amplitude * phase_at(wave, x, z, time).cos;
    return sum;
}

Vec3 WaterSurface::normal(double x, double z, double time) const {
    Vec3 sum{0.0, 1.0, 0.0};
    for (const Wave& wave : waves_) sum += wave.amplitude * phase_at(wave, x, z, time).sin * wave.k;
    return sum.normalized();
}

Vec3 WaterSurface::velocity(const Vec3& point, double time) const {
    Vec3 sum = current_;
    for (const Wave& wave : waves_) {
        const SinCos phase = phase_at(wave, point.x(), point.z(), time);
        const double speed = wave.amplitude * wave.omega * exponential(wave.decay * (point.y() - level_));
        sum += speed * (phase.cos / wave.decay * wave.k + Vec3(0.0, phase.sin, 0.0));
    }
    return sum;
}

Vec3 WaterSurface::acceleration(const Vec3& point, double time) const {
    Vec3 sum = Vec3::Zero();
    for (const Wave& wave : waves_) {
        const SinCos phase = phase_at(wave, point.x(), point.z(), time);
        const double size = wave.amplitude * wave.omega * wave.omega * exponential(wave.decay * (point.y() - level_));
        sum += size * (phase.sin / wave.decay * wave.k - Vec3(0.0, phase.cos, 0.0));
    }
    return sum;
}

}  // namespace tumble
