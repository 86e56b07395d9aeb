#include "render/camera/camera_animation.h"

#include "core/deterministic_math.h"

#include <algorithm>
#include <cmath>
#include <set>

namespace tumble {
namespace {

// Rodrigues' formula.
Vec3 turned(const Vec3& v, const Vec3& axis, double degrees) {
    const SinCos turn = sincos(degrees * pi / 180.0);
    const Vec3 along = axis * axis.dot(v);
    return along + turn.cos * (v - along) + turn.sin * axis.cross(v);
}

/// One without a lens has a closed one.
std::optional<DepthOfField> between(const std::optional<DepthOfField>& a, const std::optional<DepthOfField>& b,
                                    double part) {
    if (!a && !b) return std::nullopt;
    DepthOfField from = a ? *a : *b, to = b ? *b : *a;
    if (!a) from.aperture = 0.0;
    if (!b) to.aperture = 0.0;
    to.aperture = from.aperture + part * (to.aperture - from.aperture);
    to.focus = from.focus + part * (to.focus - from.focus);
    to.samples = std::max(from.samples, to.samples);
    return to;
}

}  // namespace

std::optional<CameraAnimation::Tracks> CameraAnimation::tracks_of(const CameraDescription& camera) {
    if (camera.keyframes.empty()) return std::nullopt;
    const auto track = [&](const auto& value_of) {
        std::vector<double> times;
        std::vector<Eigen::VectorXd> values;
        for (const CameraKeyframe& key : camera.keyframes) {
            times.push_back(key.time);
            values.push_back(value_of(key));
        }
        return KeyframeCurve(std::move(times), std::move(values), camera.interpolation == Interpolation::smooth);
    };
    return Tracks{track([](const CameraKeyframe& key) -> Eigen::VectorXd { return key.eye; }),
                  track([](const CameraKeyframe& key) -> Eigen::VectorXd { return key.target; }),
                  track([](const CameraKeyframe& key) -> Eigen::VectorXd {
                      return Eigen::VectorXd::Constant(1, key.vertical_fov);
                  })};
}

CameraAnimation::CameraAnimation(const CameraDescription& camera) : camera_(camera), tracks_(tracks_of(camera)) {
    for (const CameraShot& shot : camera.shots) shots_.emplace_back(shot.camera);
}

std::size_t CameraAnimation::shot_at(double time) const {
    std::size_t k = shots_.size();
    while (k > 0 && camera_.shots[k - 1].start > time) --k;
    return k > 0 && time < camera_.shots[k - 1].end ? k - 1 : shots_.size();
}

Vec3 CameraAnimation::up_at(double time) const {
    constexpr double parallel = 1e-9;  // rad: as for Camera
    constexpr double back = 1e-4;      // of the time since the last key: close, and far above rounding
    const Vec3& up = camera_.up;
    const auto view_at = [&](double t) -> Vec3 { return tracks_->target.at(t) - tracks_->eye.at(t); };
    const Vec3 view = view_at(time);
    if (view.cross(up).norm() > parallel * view.norm() * up.norm()) return up;
    // The scene reader ensures that no key is at this time, so there is an earlier one.
    double key = camera_.keyframes.front().time;
    for (const CameraKeyframe& k : camera_.keyframes)
        if (k.time < time) key = k.time;
    const Vec3 across = view_at(time - back * (time - key)).cross(up);  // to the right in the image just before
    const Vec3 in_passing = across.cross(view);
    return in_passing.norm() > 0.0 ? in_passing : up;
}

Vec3 CameraAnimation::carried(const Snapshot& snapshot) const {
    if (const std::size_t k = shot_at(snapshot.time); k < shots_.size()) return shots_[k].carried(snapshot);
    if (!camera_.follow) return Vec3::Zero();
    const BodyState& body = snapshot.bodies.at(*camera_.follow);
    // The scene has no center of mass. The body is rigid, so its center is constant in the body frame.
    const Vec3 center = body.orientation.conjugate() * (body.center_of_mass - body.origin);
    return body.center_of_mass - (camera_.follow_start + camera_.follow_start_rotation * center);
}

CameraDescription CameraAnimation::at(const Snapshot& snapshot) const {
    const std::size_t k = shot_at(snapshot.time);
    if (k == shots_.size()) return own_at(snapshot);
    const CameraShot& shot = camera_.shots[k];
    CameraDescription now = shots_[k].own_at(snapshot);
    if (snapshot.time >= shot.start + shot.move) return now;
    const bool joins = k > 0 && camera_.shots[k - 1].end >= shot.start;
    const CameraDescription before = joins ? shots_[k - 1].own_at(snapshot) : own_at(snapshot);
    const double part = (snapshot.time - shot.start) / shot.move, eased = part * part * (3.0 - 2.0 * part);
    now.eye = before.eye + eased * (now.eye - before.eye);
    now.target = before.target + eased * (now.target - before.target);
    now.vertical_fov = before.vertical_fov + eased * (now.vertical_fov - before.vertical_fov);
    const Vec3 up = (1.0 - eased) * before.up.normalized() + eased * now.up.normalized();
    if (up.cross(now.target - now.eye).norm() > 1e-6 * (now.target - now.eye).norm()) now.up = up;
    now.dof = between(before.dof, now.dof, eased);
    return now;
}

CameraDescription CameraAnimation::own_at(const Snapshot& snapshot) const {
    CameraDescription now;
    now.eye = camera_.eye;
    now.target = camera_.target;
    now.up = camera_.up;
    now.vertical_fov = camera_.vertical_fov;
    if (tracks_) {
        now.eye = tracks_->eye.at(snapshot.time);
        now.target = tracks_->target.at(snapshot.time);
        now.vertical_fov = tracks_->vertical_fov.at(snapshot.time)[0];
        now.up = up_at(snapshot.time);
    }
    // Whole turns are removed first, in degrees, where they are exact.
    const double angle = std::remainder(camera_.orbit * snapshot.time, 360.0);
    if (angle != 0.0) {
        const Vec3 axis = camera_.up.normalized();
        now.eye = now.target + turned(now.eye - now.target, axis, angle);
        if (now.up != camera_.up) now.up = turned(now.up, axis, angle);
    }
    if (camera_.follow) {
        const Vec3 way = carried(snapshot);
        now.eye += way;
        now.target += way;
    }
    now.dof = camera_.dof;
    if (now.dof && now.dof->body) {
        const Vec3 view = (now.target - now.eye).normalized();
        now.dof->focus = view.dot(snapshot.bodies.at(*now.dof->body).center_of_mass - now.eye);
        now.dof->focus = std::max(now.dof->focus, now.dof->aperture);  // it may be behind the eye
        now.dof->body.reset();
    }
    return now;
}

std::vector<std::size_t> followed_bodies(const CameraDescription& camera) {
    std::set<std::size_t> followed;
    for (const CameraDescription* one : camera.with_insets())
        if (one->follow) followed.insert(*one->follow);
    return {followed.begin(), followed.end()};
}

bool same_place(const CameraDescription& a, const CameraDescription& b) {
    return a.eye == b.eye && a.target == b.target && a.up == b.up && a.vertical_fov == b.vertical_fov;
}

}  // namespace tumble
