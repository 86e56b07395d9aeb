// Random numbers for scenes. The standard leaves the algorithms of distributions open; these are the same everywhere.
#pragma once

#include "scene/description/description.h"

#include <cstdint>
#include <random>

namespace tumble {

class Random {
public:
    explicit Random(unsigned seed) : engine_(seed) {}
    double between(double low, double high) { return low + (high - low) * (double(engine_()) / 4294967296.0); }
    bool chance(double share) { return between(0.0, 1.0) < share; }
    Vec3 vector(double x, double y, double z) {
        const double a = between(-x, x), b = between(-y, y);
        return {a, b, between(-z, z)};
    }
    Vec3 vector(double size) { return vector(size, size, size); }
    Quat turn(double least_real = -1.0) {
        const Vec3 v = vector(1.0);
        return Quat(between(least_real, 1.0), v.x(), v.y(), v.z()).normalized();
    }
    Color color() { return {channel(), channel(), channel()}; }

private:
    std::uint8_t channel() { return std::uint8_t(between(40.0, 250.0)); }
    std::mt19937 engine_;
};

}  // namespace tumble
