#include "sim/forces.h"

namespace tumble {

ForceField::ForceField(const SceneDescription& scene)
    : gravity_(scene.simulation.gravity), wind_(scene.wind), at_points_(scene.bodies.size()) {
    for (const ForceDescription& f : scene.forces) at_points_[f.body].push_back(f);
}

Wrench ForceField::at(std::size_t index, const Body& body, double time) const {
    Wrench sum;
    sum.force = body.mass * gravity_;
    if (wind_) {
        // F = 1/2 rho C_d A |u| u with u the air's velocity past the body.
        const Vec3 u = wind_->velocity - body.velocity;
        sum.force += 0.5 * wind_->density * wind_->drag * body.drag_area * u.norm() * u;
    }
    for (const ForceDescription& f : at_points_[index]) {
        if (time < f.start || time >= f.end) continue;
        const Vec3 force = f.body_frame ? Vec3(body.rotation * f.force) : f.force;
        const Vec3 r = body.rotation * (f.point - body.center_of_mass);
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

}  // namespace tumble
