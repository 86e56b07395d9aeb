#include "sim/broad_phase.h"

#include "sim/tuning.h"

#include <algorithm>
#include <cmath>

namespace tumble {
namespace {

double way_in_a_step(const Body& body, double h) {
    return body.moves() ? h * (body.velocity.norm() + body.angular_velocity.norm() * body.radius) : 0.0;
}

}  // namespace

double contact_margin(const Body& body, double h) {
    if (!body.moves()) return 0.0;
    return tuning::speculative * body.radius + way_in_a_step(body, h);
}

const std::vector<BroadPhase::Pair>& BroadPhase::update(const std::vector<Body>& bodies, double h) {
    bool escaped = !built_;
    for (std::size_t i = 0; i < moving_.size() && !escaped; ++i) {
        const Body& body = bodies[moving_[i]];
        if (body.asleep || body.flying) continue;
        const Bounds now = world_bounds(body.collider, body.pose()).grown(contact_margin(body, h));
        const Bounds& fat = moving_tree_.item(std::uint32_t(i));
        escaped = (now.min.array() < fat.min.array()).any() || (now.max.array() > fat.max.array()).any();
    }
    if (escaped) rebuild(bodies, h);
    return pairs_;
}

void BroadPhase::rebuild(const std::vector<Body>& bodies, double h) {
    if (!built_) {
        std::vector<Bounds> fixed_bounds;
        for (std::uint32_t i = 0; i < bodies.size(); ++i) {
            const Body& body = bodies[i];
            if (body.moves()) moving_.push_back(i);
            else if (std::holds_alternative<HalfSpace>(body.collider)) half_spaces_.push_back(i);
            else {
                fixed_.push_back(i);
                fixed_bounds.push_back(world_bounds(body.collider, body.pose()));
            }
        }
        fixed_tree_ = BoundsTree(std::move(fixed_bounds));
        built_ = true;
    }
    std::vector<Bounds> fat;
    for (const std::uint32_t i : moving_) {
        const Body& body = bodies[i];
        const double margin = contact_margin(body, h) + tuning::fat_bounds * body.radius +
                              tuning::fat_steps * way_in_a_step(body, h);
        fat.push_back(world_bounds(body.collider, body.pose()).grown(margin));
    }
    moving_tree_ = BoundsTree(std::move(fat));

    pairs_.clear();
    const auto add = [&](std::uint32_t i, std::uint32_t j) {
        if (bodies[i].dynamic() || bodies[j].dynamic()) pairs_.push_back({std::min(i, j), std::max(i, j)});
    };
    for (std::uint32_t k = 0; k < moving_.size(); ++k) {
        const std::uint32_t i = moving_[k];
        const Bounds& box = moving_tree_.item(k);
        moving_tree_.query(box, [&](std::uint32_t other) {
            if (other > k) add(i, moving_[other]);
        });
        if (!bodies[i].dynamic()) continue;
        fixed_tree_.query(box, [&](std::uint32_t other) { add(i, fixed_[other]); });
        for (const std::uint32_t plane : half_spaces_) {
            // The half-space reaches the box if the box's lowest corner is below its plane.
            const auto& space = std::get<HalfSpace>(bodies[plane].collider);
            const Vec3 normal = bodies[plane].rotation * space.normal;
            const double center = normal.dot(box.center() - bodies[plane].position) - space.offset;
            if (center <= normal.cwiseAbs().dot(0.5 * box.extent())) add(i, plane);
        }
    }
    std::sort(pairs_.begin(), pairs_.end());
}

}  // namespace tumble
