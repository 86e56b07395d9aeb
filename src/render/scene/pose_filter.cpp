#include "render/scene/pose_filter.h"

#include "core/check.h"
#include "render/shapes/drawn_shape.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace tumble {

PoseFilter::PoseFilter(const SceneDescription& scene)
    : followed_(followed_bodies(scene.camera)), waves_(scene.water && !scene.water->waves.empty()) {
    const auto add_view = [&](const CameraDescription& camera) {
        views_.push_back({CameraAnimation(camera), camera, Camera(camera, scene.output.width, scene.output.height)});
    };
    add_view(scene.camera);
    for (const CameraInset& inset : scene.camera.insets) add_view(inset.camera);
    for (std::size_t i = 0; i < scene.bodies.size(); ++i) {
        const BodyDescription& body = scene.bodies[i];
        const bool moves = body.appearance.visible || follows(i);  // a followed body moves everything that is drawn
        radii_.push_back(moves ? std::visit([](const auto& shape) { return reach(shape); }, body.shape) : 0.0);
    }
    for (const CordDescription& cord : scene.cords) {
        radii_[cord.body] = std::max(radii_[cord.body], cord.point.norm() + cord.radius);
        if (cord.anchor_body)
            radii_[*cord.anchor_body] = std::max(radii_[*cord.anchor_body], cord.anchor.norm() + cord.radius);
    }
}

bool PoseFilter::follows(std::size_t body) const { return std::ranges::binary_search(followed_, body); }

bool PoseFilter::may_stay(std::size_t body, const Pose& drawn, const BodyState& state) const {
    const double radius = radii_[body];
    if (radius == 0.0 || state.absent) return true;  // not drawn
    const double way = (state.origin - drawn.origin).norm();
    const double turn = std::min((state.orientation.coeffs() - drawn.orientation.coeffs()).norm(),
                                 (state.orientation.coeffs() + drawn.orientation.coeffs()).norm());
    if (way == 0.0 && turn == 0.0) return true;
    return std::ranges::all_of(views_, [&](const View& one) {
        const double nearest =
            one.view.relative(drawn.origin).norm() - radius;  // m, from the eye; of a plane: -infinity
        return way + 2.0 * radius * turn <= drawn_tolerance * one.view.pixel_size() * nearest;
    });
}

bool PoseFilter::settle(std::size_t body, BodyState& state) {
    Pose& drawn = drawn_[body];
    if (drawn.absent == state.absent && may_stay(body, drawn, state)) {
        state.origin = drawn.origin;
        state.orientation = drawn.orientation;
        state.center_of_mass = drawn.center_of_mass;
        return false;
    }
    drawn = {state.origin, state.orientation, state.center_of_mass, state.absent};
    return true;
}

bool PoseFilter::move_views(const Snapshot& snapshot) {
    bool moved = false;
    for (View& one : views_) {
        CameraDescription camera = one.path.at(snapshot);
        if (same_place(camera, one.camera)) continue;
        one.camera = std::move(camera);
        one.view = one.view.from(one.camera);
        moved = true;
    }
    return moved;
}

bool PoseFilter::follow(Snapshot& snapshot) {
    TUMBLE_CHECK_EQ(snapshot.bodies.size(), radii_.size());
    bool moved = std::exchange(first_, false);
    if (moved)
        for (const BodyState& state : snapshot.bodies)
            drawn_.push_back({state.origin, state.orientation, state.center_of_mass, state.absent});
    for (const std::size_t body : followed_)
        if (settle(body, snapshot.bodies[body])) moved = true;
    if (move_views(snapshot)) {
        for (std::size_t i = 0; i < drawn_.size(); ++i)
            if (!follows(i)) {
                const BodyState& state = snapshot.bodies[i];
                drawn_[i] = {state.origin, state.orientation, state.center_of_mass, state.absent};
            }
        return true;
    }
    for (std::size_t i = 0; i < drawn_.size(); ++i)
        if (settle(i, snapshot.bodies[i])) moved = true;
    return moved || waves_;
}

}  // namespace tumble
