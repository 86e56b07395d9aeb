#include "core/keyframe_curve.h"

#include <algorithm>
#include <utility>

namespace tumble {

KeyframeCurve::KeyframeCurve(std::vector<double> times, std::vector<Eigen::VectorXd> values, bool smooth)
    : times_(std::move(times)), values_(std::move(values)), smooth_(smooth) {
    for (const Eigen::VectorXd& value : values_) slopes_.push_back(Eigen::VectorXd::Zero(value.size()));
    for (std::size_t i = 1; i + 1 < times_.size(); ++i) {
        const double before = times_[i] - times_[i - 1], after = times_[i + 1] - times_[i];
        slopes_[i] = smooth_slope<Eigen::VectorXd>((values_[i] - values_[i - 1]) / before,
                                                   (values_[i + 1] - values_[i]) / after, before, after);
    }
}

Eigen::VectorXd KeyframeCurve::at(double time) const {
    if (time <= times_.front()) return values_.front();
    if (time >= times_.back()) return values_.back();
    const auto next = std::size_t(std::upper_bound(times_.begin(), times_.end(), time) - times_.begin()), i = next - 1;
    const double span = times_[next] - times_[i], u = (time - times_[i]) / span;
    const Eigen::VectorXd way = values_[next] - values_[i];
    if (!smooth_) return values_[i] + u * way;
    return values_[i] + u * u * (3.0 - 2.0 * u) * way + u * (1.0 - u) * (1.0 - u) * span * slopes_[i] -
           u * u * (1.0 - u) * span * slopes_[next];
}

}  // namespace tumble
