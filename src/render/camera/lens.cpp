#include "render/camera/lens.h"

#include "core/deterministic_math.h"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace tumble {
namespace {

constexpr double golden = 0.61803398874989485;

/// A step that visits all numbers below `count`, with neighbors far apart: early moments are then seen
/// from all over the lens.
int far_step(int count) {
    int step = std::max(1, int(golden * count));
    while (std::gcd(step, count) != 1) ++step;
    return step;
}

}  // namespace

std::vector<Eigen::Vector2d> lens_points(int samples, const FrameMoment& moment) {
    const int each = (samples + moment.count - 1) / moment.count, all = each * moment.count, step = far_step(all);
    std::vector<Eigen::Vector2d> points;
    for (int i = 0; i < each; ++i) {
        // Vogel 1979, A Better Way to Construct the Sunflower Head: points of equal area
        const int at = int(std::int64_t(moment.index + i * moment.count) * step % all);
        const SinCos turn = sincos(2.0 * pi * std::fmod(golden * at, 1.0));
        points.push_back(std::sqrt((at + 0.5) / all) * Eigen::Vector2d(turn.cos, turn.sin));
    }
    return points;
}

bool has_lens(const CameraDescription& camera) {
    return std::ranges::any_of(camera.all(), [](const CameraDescription* one) { return one->dof.has_value(); });
}

}  // namespace tumble
