#include "scene/description/description.h"

#include <algorithm>

#include "core/frame_rate.h"

#include <cmath>

namespace tumble {

std::int64_t FrameTiming::frame_count(double duration) const {
    return std::int64_t(std::floor(rounded_if_nearly_whole(duration * fps))) + 1;
}

bool CameraDescription::any_fits_motion() const {
    return std::ranges::any_of(with_insets(), [](const CameraDescription* camera) { return camera->fits_motion(); });
}

bool CameraDescription::any_lags() const {
    return std::ranges::any_of(with_insets(), [](const CameraDescription* camera) { return camera->lags(); });
}

std::vector<const CameraDescription*> CameraDescription::all() const {
    std::vector<const CameraDescription*> cameras{this};
    for (const CameraShot& shot : shots) cameras.push_back(&shot.camera);
    return cameras;
}

std::vector<const CameraDescription*> CameraDescription::with_insets() const {
    std::vector<const CameraDescription*> cameras = all();
    for (const CameraInset& inset : insets) cameras.push_back(&inset.camera);
    return cameras;
}

}  // namespace tumble
