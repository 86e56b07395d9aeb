#include "sim/forces.h"

#include <algorithm>
#include <limits>

namespace tumble {

ForceField::ForceField(const SceneDescription& scene, std::span<const std::uint32_t> order)
    : gravity_(scene.simulation.gravity), wind_(scene.wind), at_points_(scene.bodies.size()) {
    std::vector<std::size_t> places(scene.bodies.size());
    for (std::size_t i = 0; i < places.size(); ++i) places[order.empty() ? i : order[i]] = i;
    for (const ForceDescription& f : scene.forces) at_points_[places[f.body]].push_back(f);
    changes_ = !scene.forces.empty();
}

Wrench ForceField::at(std::size_t index, const Body& body, const Vec3& velocity, const Mat3& rotation,
                      double time) const {
    Wrench sum;
    sum.force = body.mass * gravity_;
    if (wind_) {
        // F = 1/2 rho C_d A |u| u with u the air's velocity past the body.
        const Vec3 u = wind_->velocity - velocity;
        sum.force += 0.5 * wind_->density * wind_->drag * body.drag_area * u.norm() * u;
    }
    for (const ForceDescription& f : at_points_[index]) {
        if (time < f.start || time >= f.end) continue;
        const Vec3 force = f.body_frame ? Vec3(rotation * f.force) : f.force;
        const Vec3 r = rotation * (f.point - body.center_of_mass);
        sum.force += force;
        sum.torque += r.cross(force);   // notes eq. 6
    }
    return sum;
}

bool ForceField::changes(std::size_t index, double from, double to) const {
    for (const ForceDescription& f : at_points_[index])
        if ((f.start >= from && f.start < to) || (f.end >= from && f.end < to)) return true;
    return false;
}

double ForceField::next_change(std::size_t index, double time) const {
    double next = std::numeric_limits<double>::infinity();
    for (const ForceDescription& f : at_points_[index])
        for (const double change : {f.start, f.end})
            if (change > time) next = std::min(next, change);
    return next;
}

bool ForceField::constant(std::size_t index, double from, double to) const {
    return !wind_ && std::none_of(at_points_[index].begin(), at_points_[index].end(),
                                  [&](const ForceDescription& f) { return f.start < to && f.end > from; });
}

bool ForceField::torque_free(std::size_t index, double time) const {
    return std::none_of(at_points_[index].begin(), at_points_[index].end(),
                        [&](const ForceDescription& f) { return time >= f.start && time < f.end; });
}

double ForceField::drag_rate(const Body& body) const {
    return wind_ ? wind_->density * wind_->drag * body.drag_area * body.inverse_mass : 0.0;
}

}  // namespace tumble
